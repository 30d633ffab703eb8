//! When what the search has found moves the correction.
//!
//! Once γ has settled, what a part of a period teaches is no help: distortion that is not calibrated makes the parameters go round
//! with the angle, and an axis that rests or shakes would leave them at one place of that round. All 64 sectors together pull from all
//! sides. So the search goes on from sector to sector, and the pair is corrected with what it had found where the last period of
//! travel ended: a period that is never ended moves nothing. Where the map of sectors is cleared because nothing counts any more (the pin
//! `calibrate`, or lock), what was found so far is applied too: the same arc would be taught again, and the search must see its work.

use super::calibration::Gate;
use super::{Coefficients, State, Structure, gears};
use crate::signal::{Formula, Logic, Signal};

static APPLY: Formula = Formula {
    title: "Parameters as they are applied",
    equation: "theta = what the search has found, once gamma has settled where a period of travel ends",
    source: "paper section 5.5: static measurements may bias the estimates",
};

/// Whether what a period of travel teaches waits for its end.
#[derive(Clone, Copy, Debug)]
pub enum Waits<S: Signal> {
    /// It never does: the mean with a forgetting factor, and designs whose γ never settles.
    Never,
    /// It does where γ has settled.
    Settled(S::Bool),
    /// It always does: batches.
    Always,
}

impl<S: Signal> Waits<S> {
    /// Of this design in this state.
    #[inline(always)]
    pub fn of(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> Self {
        let calibration = &structure.calibration;
        if calibration.is_batch() {
            Self::Always
        } else if calibration.waits() {
            Self::Settled(gears::settled(state, k, structure))
        } else {
            Self::Never
        }
    }
}

/// θ1 … θ9 less their nominal values, as the pair is corrected with.
#[inline(always)]
pub fn applied<S: Signal>(state: &State<S>) -> [S; 9] {
    [
        state.theta_1_deviation,
        state.theta_2_deviation,
        state.theta_3_deviation,
        state.theta_4_deviation,
        state.theta_5_deviation,
        state.theta_6_deviation,
        state.theta_7_deviation,
        state.theta_8_deviation,
        state.theta_9_deviation,
    ]
}

/// The same as the search has them.
#[inline(always)]
pub fn searched<S: Signal>(state: &State<S>, structure: &Structure) -> [S; 9] {
    if !structure.calibration.waits() {
        return applied(state);
    }
    [
        state.running_1,
        state.running_2,
        state.running_3,
        state.running_4,
        state.running_5,
        state.running_6,
        state.running_7,
        state.running_8,
        state.theta_9_deviation,
    ]
}

/// θ1 … θ9 less their nominal values after a sample.
pub struct Applied<S: Signal> {
    /// As the next pair is corrected with.
    theta: [S; 9],
    /// As the search has them, where that is something else.
    searched: Option<[S; 9]>,
}

/// What the search has `found` is applied where it is time, and what is `recalled` at once.
#[inline(always)]
pub fn apply<S: Signal>(
    found: [S; 9],
    waits: Waits<S>,
    gate: Gate<S>,
    recalled: Option<S::Bool>,
    state: &State<S>,
) -> Applied<S> {
    let Waits::Settled(settled) = waits else {
        return Applied {
            theta: found,
            searched: None,
        };
    };
    found[0].begin(&APPLY);
    let ends = gate.fresh.and(gate.whole_period).named("period_taught");
    // Where nothing counts the map is cleared: what was taught would be taught again.
    let stops = gate
        .clear
        .and(gate.whole_period.not())
        .named("period_breaks_off");
    let now = settled.not().or(ends.or(stops).named("travel_ends"));
    let now = now.named("search_ends");
    let now = recalled.map_or(now, |recalled| now.or(recalled).named("theta_applies"));
    let mut theta = found;
    // θ9 has its own end of a period.
    for (theta, before) in theta.iter_mut().zip(applied(state)).take(8) {
        *theta = S::select(now, *theta, before);
    }
    Applied {
        theta,
        searched: Some(found),
    }
}

impl<S: Signal> Applied<S> {
    /// Into the registers.
    #[inline(always)]
    pub fn keep(self, next: &mut State<S>) {
        [
            next.theta_1_deviation,
            next.theta_2_deviation,
            next.theta_3_deviation,
            next.theta_4_deviation,
            next.theta_5_deviation,
            next.theta_6_deviation,
            next.theta_7_deviation,
            next.theta_8_deviation,
            next.theta_9_deviation,
        ] = self.theta;
        if let Some(searched) = self.searched {
            [
                next.running_1,
                next.running_2,
                next.running_3,
                next.running_4,
                next.running_5,
                next.running_6,
                next.running_7,
                next.running_8,
                _,
            ] = searched;
        }
    }
}
