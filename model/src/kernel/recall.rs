//! Recall: what the parameters were before the signal began to fade.
//!
//! A fade over some periods is a small change of the amplitude before it is a large one, and the parameters follow it until
//! they are held. So the chip remembers them as they were at the last two ends of `gear_periods` quiet periods of travel, and where they
//! begin to be held it goes back to the older of the two. Only in the last gear: before it they still improve. A signal that
//! comes back over some periods is nearly whole before it is whole: they stay held until as many quiet periods have passed.

use super::calibration::Update;
use super::gears::Gears;
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Logic, Signal};
use crate::spec::CalibrationMethod;

static RECALL: Formula = Formula {
    title: "Recall",
    equation: "held in the last gear: theta = proven; after gear_periods quiet periods: proven' = recent, recent' = theta",
    source: "",
};

/// What is remembered of θ1 … θ9.
pub struct Memory<S: Signal> {
    /// As at the last end of so many quiet periods.
    pub recent: [S; 9],
    /// As at the end before it.
    pub proven: [S; 9],
    /// Parameters were recalled, and the periods of a gear have not passed quietly since.
    pub returning: S::Bool,
}

/// Puts proven parameters in the place of the others where `recall` says so.
pub fn recall<S: Signal>(
    updated: &mut Update<S>,
    recall: S::Bool,
    gears: &Gears<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Memory<S> {
    state.gamma_gear.begin(&RECALL);
    let before = Memory::of(state);
    let passed = gears.passed;
    updated.theta = std::array::from_fn(|i| S::select(recall, before.proven[i], updated.theta[i]));
    if structure.calibration.method == CalibrationMethod::SumOfSquares {
        // A mean gradient of the way down would be the first to act on what was recalled.
        updated.gathered = updated.gathered.map(|sum| S::select(recall, k.zero, sum));
    }
    // Periods that pass in recall make the recent ones proven; what was recent is of the way down.
    let older = passed.and(recall.not()).named("remember");
    let recent = |i: usize| S::select(passed, updated.theta[i], before.recent[i]);
    Memory {
        recent: std::array::from_fn(recent),
        proven: std::array::from_fn(|i| S::select(older, before.recent[i], before.proven[i])),
        // What comes back over some periods is small again before it is whole.
        returning: recall.and(passed.or(gears.restart).not()),
    }
}

impl<S: Signal> Memory<S> {
    fn of(state: &State<S>) -> Self {
        Self {
            recent: [
                state.recent_1,
                state.recent_2,
                state.recent_3,
                state.recent_4,
                state.recent_5,
                state.recent_6,
                state.recent_7,
                state.recent_8,
                state.recent_9,
            ],
            proven: [
                state.proven_1,
                state.proven_2,
                state.proven_3,
                state.proven_4,
                state.proven_5,
                state.proven_6,
                state.proven_7,
                state.proven_8,
                state.proven_9,
            ],
            returning: state.returning,
        }
    }

    /// Into the registers.
    pub fn keep(self, next: &mut State<S>) {
        [
            next.recent_1,
            next.recent_2,
            next.recent_3,
            next.recent_4,
            next.recent_5,
            next.recent_6,
            next.recent_7,
            next.recent_8,
            next.recent_9,
        ] = self.recent;
        [
            next.proven_1,
            next.proven_2,
            next.proven_3,
            next.proven_4,
            next.proven_5,
            next.proven_6,
            next.proven_7,
            next.proven_8,
            next.proven_9,
        ] = self.proven;
        next.returning = self.returning;
    }
}
