//! Calibration is driven by travelled angle, not by time.
//!
//! The period is divided into 64 sectors. Each contributes once until the position is a whole period away from where
//! the map of sectors was last cleared; then the map is cleared. Motion is continuous, so what has been seen is an
//! interval about that origin, never longer than a period: two numbers instead of 64 bits. To and fro over the same
//! arc adds nothing, standstill adds nothing, and a whole period of travel adds every sector exactly once, so the
//! parameters are pulled equally from all sides. What was used right before the map was cleared is not used again by
//! turning back there: a quarter of the period must be behind the turn first. So a vibration adds sectors on one side of
//! its place at most. Where all of a period moves the parameters at its end, a vibration moves nothing, and every sector counts.

use super::waits::Waits;
use super::{Coefficients, Input, State, Structure, gears};
use crate::format::{Format, Quantiser};
use crate::signal::{Formula, Logic, Signal};

/// Sectors of a period: 2^6.
pub const SECTOR_BITS: u32 = 6;
/// Sector numbers: position modulo four periods.
pub const SECTOR: Format = Format::signed(2 + SECTOR_BITS, SECTOR_BITS);

static TRAVEL: Formula = Formula {
    title: "Travel",
    equation: "a sector of the period is fresh until it was used once since the last whole period",
    source: "paper section 5.5: static measurements may bias the estimates",
};

/// How the start measures travel.
#[derive(Clone, Copy, Debug)]
pub struct Measure<S> {
    /// What the angle that crosses sectors is ahead of α̂, turns.
    pub ahead: S,
    /// Travel that is taken for a whole period.
    pub period: S,
}

/// Calibration is allowed, from outside and by the lock.
#[inline(always)]
pub fn counting<S: Signal>(input: &Input<S>, state: &State<S>) -> S::Bool {
    state.alpha_hat.begin(&TRAVEL);
    state.locked.and(input.calibrate).named("counting")
}

/// What the travel gate decides and remembers.
pub struct Travel<S: Signal> {
    /// This sample is in a sector not used yet.
    pub new_sector: S::Bool,
    /// The position is a whole period from the origin.
    pub whole_period: S::Bool,
    /// The map is cleared: a whole period is done, or nothing counts.
    pub clear: S::Bool,
    /// How far this sample is outside the sectors used; where it ends a period, how much of the period was not used.
    pub advance: S,
    /// Where the map was cleared.
    pub origin: S,
    /// Lowest sector used, relative to the origin.
    pub low: S,
    /// Highest sector used, relative to the origin.
    pub high: S,
    /// The sectors ahead of the origin were used before the map was cleared.
    pub ahead_used: S::Bool,
    /// The sectors behind it were.
    pub behind_used: S::Bool,
    /// Whole periods of the position, modulo four: −2 … 1.
    pub periods: S,
}

/// Whether this sample's sector is fresh, and the map after it. Not counting (`counting` false) clears the map. `measure`: where
/// travel is measured otherwise than in whole periods of α̂; `waits`: where what it teaches waits for the end of the period, which
/// must be whole then.
#[inline(always)]
pub fn travel<S: Signal>(
    counting: S::Bool,
    (measure, waits): (Option<Measure<S>>, Waits<S>),
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Travel<S> {
    state.alpha_hat.begin(&TRAVEL);
    let of_four = &structure.formats.count_of_four;
    let periods = state
        .count
        .quantise(of_four)
        .scale(of_four.format.fraction as i32)
        .named("periods_modulo_4");
    let sector = match measure {
        None => {
            let sector_grid = Quantiser::grid(Format::unsigned(SECTOR_BITS, SECTOR_BITS));
            periods + state.alpha_hat.quantise(&sector_grid)
        }
        Some(of) => (periods + state.alpha_hat + of.ahead).quantise(&Quantiser::grid(SECTOR)),
    }
    .named("sector");
    let relative = (sector - state.travel_origin)
        .quantise(&Quantiser::wrapping(SECTOR))
        .named("sector_relative");
    let period = measure.map_or(k.one, |of| of.period);
    let period_ahead = relative.less_than(period).not().named("period_ahead");
    let period_behind = (-period).less_than(relative).not().named("period_behind");
    let a_period_away = period_ahead.or(period_behind).named("a_period_away");
    let whole_period = a_period_away.and(counting);
    // Not used again.
    let other = |unseen: S::Bool, near: S::Bool, used: S::Bool, name: [&'static str; 3]| {
        let again = match waits {
            Waits::Never => near.and(used),
            Waits::Settled(settled) => near.and(used.and(settled.not()).named(name[0])),
            Waits::Always => return unseen,
        };
        unseen.and(again.not().named(name[1])).named(name[2])
    };
    let reach_ahead = (state.travel_low + k.one).named("reach_ahead");
    let reach_behind = (state.travel_high - k.one).named("reach_behind");
    let ahead = state
        .travel_high
        .less_than(relative)
        .and(relative.less_than(reach_ahead))
        .named("unseen_ahead");
    let ahead = other(
        ahead,
        relative.less_than(k.quarter),
        state.ahead_used,
        ["used_ahead_counts", "may_add_ahead", "sector_ahead"],
    );
    let behind = relative
        .less_than(state.travel_low)
        .and(reach_behind.less_than(relative))
        .named("unseen_behind");
    let behind = other(
        behind,
        relative.less_than(-k.quarter).not(),
        state.behind_used,
        ["used_behind_counts", "may_add_behind", "sector_behind"],
    );
    let clear = whole_period.or(counting.not()).named("travel_clear");
    // Once γ has settled what was near when lock was lost counts as used, too: an axis that rests where it comes back teaches nothing.
    let stops = matches!(waits, Waits::Never).then(|| {
        let settled = gears::settled(state, k, structure);
        state.locked.not().and(settled).named("stops_near")
    });
    // A side was used where a period on it ends, until a sector there is used or another period ends.
    let used = |ends: S::Bool, before: S::Bool, again: S::Bool, name: [&'static str; 2]| {
        let still = before.and(whole_period.or(again).not()).named(name[0]);
        let used = counting.and(ends.or(still).named(name[1]));
        stops.map_or(used, |stops| used.or(stops))
    };
    let keep = |x: S| x.quantise(&Quantiser::wrapping(SECTOR));
    Travel {
        new_sector: ahead
            .or(behind)
            .named("sector_added")
            .or(clear)
            .named("new_sector"),
        whole_period,
        clear,
        advance: S::select(
            whole_period,
            k.one - state.travel_high + state.travel_low,
            S::select(
                state.travel_high.less_than(relative),
                relative - state.travel_high,
                state.travel_low - relative,
            ),
        ),
        origin: keep(S::select(clear, sector, state.travel_origin)),
        low: keep(S::select(
            clear,
            k.zero,
            S::select(behind, relative, state.travel_low),
        )),
        high: keep(S::select(
            clear,
            k.zero,
            S::select(ahead, relative, state.travel_high),
        )),
        ahead_used: used(
            period_behind,
            state.ahead_used,
            ahead,
            ["still_used_ahead", "used_up_ahead"],
        ),
        behind_used: used(
            period_ahead,
            state.behind_used,
            behind,
            ["still_used_behind", "used_up_behind"],
        ),
        periods,
    }
}
