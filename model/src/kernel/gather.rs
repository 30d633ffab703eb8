//! Gradients gathered over samples before they move a parameter: the mean with a forgetting factor λ = 1 − 2^-m, or the
//! sum over a period of travel, in which each of the 64 sectors counts at most once.

use super::calibration::Gate;
use super::{State, Structure};
use crate::signal::{Formula, Signal, Wide};
use crate::spec::CalibrationMethod;

static FORGETTING: Formula = Formula {
    title: "Gathered gradient",
    equation: "sum' = sum + (gradient - sum)/2^m",
    source: "paper sections 5.2 and 5.3: forgetting factor",
};

static PERIOD: Formula = Formula {
    title: "Gathered gradient",
    equation: "sum' = sum + gradient, 0 after a whole period",
    source: "paper sections 5.2 and 5.3: the gradient over a number of steps",
};

/// What one parameter's step is made of, and what stays gathered.
pub struct Gathered<S: Signal> {
    /// The gradient that moves the parameter now, where it may move.
    pub gradient: S,
    /// The gathered gradient after this sample.
    pub next: S,
}

/// The gathered gradients by θ1 … θ8 as they stand.
pub fn gathered<S: Signal>(state: &State<S>) -> [S; 8] {
    [
        state.gathered_1,
        state.gathered_2,
        state.gathered_3,
        state.gathered_4,
        state.gathered_5,
        state.gathered_6,
        state.gathered_7,
        state.gathered_8,
    ]
}

/// Takes one component of a sample's gradient as the sum of squares gathers it.
pub fn squares<S: Signal>(
    gradient: S::Wide,
    before: S,
    gate: Gate<S>,
    zero: S,
    structure: &Structure,
) -> Gathered<S> {
    if structure.calibration.method == CalibrationMethod::Batch {
        return over_a_period(gradient, before, gate, zero, structure);
    }
    before.begin(&FORGETTING);
    let to = &structure.formats.gathered;
    let difference = gradient - before.widen();
    let mean = (before.widen() + difference.scale(-(structure.calibration.forgetting as i32)))
        .quantise(to);
    Gathered {
        gradient: mean,
        next: S::select(gate.fresh, mean, before).quantise(to),
    }
}

/// The sum over a period of travel, the sample that ends it included: then all 64 sectors are in it. Where counting
/// stops, what was gathered is dropped with the map of sectors.
pub fn over_a_period<S: Signal>(
    gradient: S::Wide,
    before: S,
    gate: Gate<S>,
    zero: S,
    structure: &Structure,
) -> Gathered<S> {
    before.begin(&PERIOD);
    let to = &structure.formats.gathered;
    let sum = (before.widen() + gradient).quantise(to);
    let kept = S::select(gate.fresh, sum, before);
    Gathered {
        gradient: sum,
        next: S::select(gate.clear, zero, kept).quantise(to),
    }
}
