//! What the loop sees while it catches up with a stop or a start is no error of the sensor.
//!
//! Once γ has settled, a phase error larger than a calibrated sensor leaves in lock is motion. Such a sample counts for nothing: it
//! teaches nothing, and its residual (which holds e²/2 and more of the lag) neither holds nor recalls a parameter. It leaves a hole in its
//! period of travel. The bends' own parameters are pulled far by the rest of that period, so in the final form with them it is dropped
//! where it ends: the search goes back to what is applied.
//!
//! An axis catches up sooner or later. Where two periods of travel one after the other both have such a sample, it is something
//! else: a sensor that is worse than promised, or places of the period that do not show what is wrong. Then all samples count again, until a
//! period has none.

use super::calibration::Gate;
use super::detector::within;
use super::{Coefficients, State, Structure, gears, waits};
use crate::signal::{Formula, Logic, Signal};

static CATCHES_UP: Formula = Formula {
    title: "The loop catches up",
    equation: "once gamma has settled, a sample with a large |e| does not count, unless two periods of travel had one",
    source: "",
};

static DROPPED: Formula = Formula {
    title: "A period that is dropped",
    equation: "where a period ends in which the loop caught up, the search goes back to theta as it is applied",
    source: "",
};

/// What a sample says about the loop.
#[derive(Clone, Copy, Debug)]
pub struct CatchUp<S: Signal> {
    /// |e| is no larger than a calibrated sensor leaves.
    pub small: S::Bool,
    /// It is far behind.
    large: S::Bool,
    /// It catches up: the sample does not count.
    pub now: S::Bool,
}

/// Whether the loop catches up with motion in this sample; `None` where that is never known: before γ can settle, and with a loop of
/// type 1, which always lags.
#[inline(always)]
pub fn catch_up<S: Signal>(
    e: S,
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
    let large = settled.and(small.not()).named("far_behind");
    let now = large.and(state.astray_long.not()).named("catches_up");
    Some(CatchUp { small, large, now })
}

impl<S: Signal> CatchUp<S> {
    /// What the search has `found`, or where a period ends in which the loop caught up what is applied: with bends, where the search
    /// waits for the end of a period. θ9 has its own end of one.
    #[inline(always)]
    pub fn dropped(
        self,
        found: [S; 9],
        gate: Gate<S>,
        state: &State<S>,
        structure: &Structure,
    ) -> [S; 9] {
        let calibration = &structure.calibration;
        if !(calibration.has_bend() && calibration.waits()) {
            return found;
        }
        found[0].begin(&DROPPED);
        let astray = state.astray.and(state.astray_long.not());
        let hole = astray.or(self.now).named("period_has_hole");
        let dropped = gate.clear.and(hole).named("period_dropped");
        let mut theta = found;
        for (theta, applied) in theta.iter_mut().zip(waits::applied(state)).take(8) {
            *theta = S::select(dropped, applied, *theta);
        }
        theta
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
