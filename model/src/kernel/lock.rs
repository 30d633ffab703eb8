//! Lock detection and acquisition.
//!
//! A level counts good samples up by one and bad ones down by eight. Full: the loop shifts to the next narrower
//! gear, or is locked in the last one. Empty: lock is lost and acquisition starts again in the widest gear, where
//! it was in a narrower one from anywhere in the lower half of the level: after the same number of samples each attempt would
//! come to a narrower gear at the same place of the period, and fail there again. (Without rounding that level is no whole number.) While it is not locked, an estimate that points
//! away from the signal is turned by half a period: the phase detector cannot tell α from α + ½.

use super::detector::within;
use super::{Coefficients, State, Structure};
use crate::format::{Format, Quantiser};
use crate::signal::{Formula, Logic, Signal};

static WINDOW: Formula = Formula {
    title: "Lock window",
    equation: "|e| and -rho below their limits, signal present",
    source: "calibration needs lock: the update would otherwise drive the gains to zero",
};

static WINDOW_OF_FIXED: Formula = Formula {
    source: "",
    ..WINDOW
};

static LEVEL: Formula = Formula {
    title: "Lock level",
    equation: "level' = level + 1 if good, else level - 8; full: locked, empty: lock is lost",
    source: "",
};

static LEVEL_AND_GEAR: Formula = Formula {
    title: "Lock level and loop gear",
    equation: "level' = level + 1 if good, else level - 8; full: narrower loop, in the last gear locked; empty: widest loop, lock is lost, and where an attempt failed level' = last bits of alpha_hat",
    source: "",
};

fn window_formula(structure: &Structure) -> &'static Formula {
    if structure.calibration.is_on() {
        &WINDOW
    } else {
        &WINDOW_OF_FIXED
    }
}

/// What the lock detector decides after a sample.
pub struct Lock<S: Signal> {
    /// Confidence.
    pub level: S,
    /// Loop gear.
    pub gear: S,
    /// The level is full: no sample was out of the window for some time.
    pub full: S::Bool,
    /// The loop follows.
    pub locked: S::Bool,
}

/// What a sample looks like.
#[derive(Clone, Copy, Debug)]
pub struct Window<S: Signal> {
    /// There is a signal, of a radius (as the estimate sees it: the loop is not a radian and more astray) that is not too small.
    pub present: S::Bool,
    /// And the loop follows it: as in lock.
    pub inside: S::Bool,
}

/// Whether this sample looks as in lock. A radius that is too large does not speak against it: parameters of a signal that had
/// faded make one, and only in lock do they find back.
#[inline(always)]
pub fn in_window<S: Signal>(
    e: S,
    rho: S,
    weak: S::Bool,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Window<S> {
    e.begin(window_formula(structure));
    let of_e = within(e, k.lock_error).named("e_in_window");
    let of_rho = rho.less_than(-k.lock_residual).not();
    let present = of_rho
        .named("rho_in_window")
        .and(weak.not().named("signal_present"))
        .named("radius_present");
    Window {
        present,
        inside: of_e.and(present),
    }
}

/// Whether there is a signal whose radius is not too small, however far astray the loop is: ρ tells that along the estimate, e across it.
#[inline(always)]
pub fn present_anywhere<S: Signal>(
    window: Window<S>,
    e: S,
    rho: S,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S::Bool {
    e.begin(window_formula(structure));
    let across = within(e, k.lock_radius).not().named("across_present");
    let opposite = rho.less_than(-k.lock_opposite).named("opposite_present");
    window
        .present
        .or(across.or(opposite).named("astray_present"))
        .named("present_anywhere")
}

/// Whether the estimate points away from the signal and may be turned round.
#[inline(always)]
pub fn flip<S: Signal>(rho: S, weak: S::Bool, state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    let may = state.locked.or(weak).not().named("may_flip");
    rho.less_than(-k.one).and(may)
}

/// Next level, gear and lock.
#[inline(always)]
pub fn update<S: Signal>(
    good: S::Bool,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Lock<S> {
    state.lock_level.begin(if structure.loop_gears == 0 {
        &LEVEL
    } else {
        &LEVEL_AND_GEAR
    });
    let formats = &structure.formats;
    let step = S::select(good, k.one, k.lock_down).named("level_step");
    let level = (state.lock_level + step)
        .quantise(&formats.level)
        .named("level_moved");
    let full = level.less_than(k.lock_full).not().named("level_full");
    let empty = level.less_than(k.one).named("level_empty");
    if structure.loop_gears == 0 {
        let locked = state.locked.or(full).and(empty.not());
        return Lock {
            level,
            gear: k.zero,
            full,
            locked,
        };
    }
    let last = state
        .loop_gear
        .less_than(k.loop_gear_last)
        .not()
        .named("last_gear");
    let narrower = full.and(last.not()).named("narrower");
    let up = S::select(narrower, k.one, k.zero).named("loop_gear_up");
    let gear = S::select(
        empty,
        k.zero,
        (state.loop_gear + up).quantise(&formats.loop_gear),
    );
    let level = S::select(narrower, k.lock_restart, level);
    let first = state.loop_gear.less_than(k.one).named("first_loop_gear");
    let fails = empty.and(first.not()).named("attempt_fails");
    let alpha = formats.alpha.format.fraction;
    let any = Quantiser::wrapping(Format::unsigned(formats.level.format.width - 1, alpha));
    let any = state.alpha_hat.quantise(&any).named("alpha_hat_last_bits");
    let level = S::select(fails, any.scale(alpha as i32), level).named("level_again");
    let full_in_last = full.and(last).named("full_in_last_gear");
    let locked = state.locked.or(full_in_last).and(empty.not());
    Lock {
        level: level.quantise(&formats.level),
        gear: gear.quantise(&formats.loop_gear),
        full,
        locked,
    }
}
