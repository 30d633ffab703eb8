//! What the loop sees while it catches up with a stop or a start is no error of the sensor.
//!
//! Once γ has settled, a phase error larger than a calibrated sensor leaves in lock is motion. Such a sample counts for nothing: it
//! teaches nothing, and its residual (which holds e²/2 and more of the lag) neither holds nor recalls a parameter. It leaves a hole in its
//! period of travel. What the rest of that period teaches pulls to one side, so where parameters move at the end of a period this one is
//! dropped there: the search goes back to what is applied, and a batch is not acted upon.
//!
//! Before γ has settled, but not before the search has begun, one that is twice as large teaches nothing either: it is a channel that is
//! lost, whose residual is small at first where the signal passes zero. The residual counts: it holds the parameters where it is large.
//!
//! An axis catches up sooner or later. Where two periods of travel one after the other both have such a sample, it is something
//! else: a sensor that is worse than promised, or places of the period that do not show what is wrong. Then all samples count again, until a
//! period has none, and the completion learns from phase errors of twice that, too: third harmonics that the radius has doubled.

use super::calibration::Gate;
use super::detector::within;
use super::{Coefficients, State, Structure, gears, waits};
use crate::signal::{Formula, Logic, Signal};

static CATCHES_UP: Formula = Formula {
    title: "The loop catches up",
    equation: "once gamma has settled, a sample with a large |e| does not count, from the first quiet period on one with a larger |e| \
               teaches nothing, unless two periods of travel had one",
    source: "",
};

static DROPPED: Formula = Formula {
    title: "A period that is dropped",
    equation: "where a period ends in which the loop caught up, the search goes back to theta as it is applied",
    source: "",
};

static BATCH_DROPPED: Formula = Formula {
    equation: "where a period ends in which the loop caught up, what was gathered over it moves nothing",
    ..DROPPED
};

/// What a sample says about the loop.
#[derive(Clone, Copy, Debug)]
pub struct CatchUp<S: Signal> {
    /// |e| is no larger than a calibrated sensor leaves, or where that is known to be another one, than twice as much.
    pub of_sensor: S::Bool,
    /// It is behind, or before γ has settled far behind.
    large: S::Bool,
    /// It catches up: the sample does not count.
    pub now: S::Bool,
    /// Where that can be known before γ has settled: neither does it nor is it far behind, or both have been so for long.
    pub teaches: Option<S::Bool>,
}

/// Whether the loop catches up with motion in this sample; `None` where that is never known: before γ can settle, and with a loop of
/// type 1, which always lags.
#[inline(always)]
pub fn catch_up<S: Signal>(
    e: S,
    starting: Option<S::Bool>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Option<CatchUp<S>> {
    if !structure.catches_up() {
        return None;
    }
    e.begin(&CATCHES_UP);
    let small = within(e, k.small_error).named("e_small");
    let settled = gears::settled(state, k, structure);
    let behind = settled.and(small.not()).named("behind");
    // What is not calibrated yet leaves more.
    let near = within(e, k.far_error).named("e_near");
    let open = state.astray_long.not();
    let (large, teaches) = if structure.calibration.guards_early() {
        let begun = gears::begun(state, k);
        // A start needs all of its periods.
        let searching = starting.map_or(begun, |starting| {
            begun.and(starting.not()).named("searching")
        });
        let far = near.not().and(searching).named("far_behind");
        let large = far.or(behind).named("behind_or_far");
        (large, Some(large.and(open).not().named("teaches")))
    } else {
        (behind, None)
    };
    let bent = near.and(state.astray_long).named("e_of_bends");
    Some(CatchUp {
        of_sensor: small.or(bent).named("e_of_sensor"),
        large,
        now: behind.and(open).named("catches_up"),
        teaches,
    })
}

/// What the search goes on from: what it has found, or where a period is `dropped` what is applied. θ9 has its own end of one.
#[inline(always)]
pub fn searched<S: Signal>(
    dropped: Option<S::Bool>,
    state: &State<S>,
    structure: &Structure,
) -> [S; 9] {
    let mut theta = waits::searched(state, structure);
    // A batch goes on from what is applied, always.
    let Some(dropped) = dropped.filter(|_| structure.calibration.waits()) else {
        return theta;
    };
    state.gamma_gear.begin(&DROPPED);
    for (theta, applied) in theta.iter_mut().zip(waits::applied(state)).take(8) {
        *theta = S::select(dropped, applied, *theta);
    }
    theta
}

impl<S: Signal> CatchUp<S> {
    /// Whether a period ends (`clear`) in which the loop caught up; `None` where parameters do not move at the end of one.
    #[inline(always)]
    pub fn drops(self, clear: S::Bool, state: &State<S>, structure: &Structure) -> Option<S::Bool> {
        if !structure.calibration.drops_periods() {
            return None;
        }
        state.gamma_gear.begin(if structure.calibration.is_batch() {
            &BATCH_DROPPED
        } else {
            &DROPPED
        });
        let astray = state.astray.and(state.astray_long.not());
        let hole = astray.or(self.now).named("period_has_hole");
        Some(clear.and(hole).named("period_dropped"))
    }

    /// Whether the running period has had such a sample, the last one, and both of the two before that or more: the registers after
    /// this one. A period ends with a sample that is still of it.
    #[inline(always)]
    pub fn after(self, gate: Gate<S>, counting: S::Bool, state: &State<S>) -> [S::Bool; 3] {
        state.gamma_gear.begin(&CATCHES_UP);
        let seen = state.astray.or(self.large).named("astray_lately");
        let ends = gate.whole_period;
        let goes_on = ends.not().and(counting).named("astray_goes_on");
        let ended = ends.and(seen).named("astray_period_ends");
        let again = ended.and(state.astray_before).named("astray_again");
        [
            seen.and(goes_on),
            ended.or(state.astray_before.and(goes_on)),
            again.or(state.astray_long.and(goes_on)),
        ]
    }
}
