//! The sum-of-squares gradient: ε = (c² + s² − 1)/2 in place of the radial residual, the corrected pair in place of
//! (cos α̂, sin α̂). It knows no angle and needs no loop; travel still decides which samples count.
//!
//! A gradient of many samples makes each step: the mean with a forgetting factor λ = 1 − 2^-m, or the sum over a period
//! of travel.

use super::{State, Structure};
use crate::signal::{Formula, Logic, Signal, Wide};
use crate::spec::CalibrationMethod;

static RADIUS: Formula = Formula {
    title: "Squared radius",
    equation: "epsilon = (c^2 + s^2 - 1)/2",
    source: "paper section 5.2",
};

static GATHER: Formula = Formula {
    title: "Gathered gradient",
    equation: "forgetting: sum' = sum + (gradient - sum)/2^m; batch: sum' = sum + gradient, 0 after a whole period",
    source: "paper sections 5.2 and 5.3: forgetting factor, or the gradient over a number of steps",
};

/// ε, half the error of the squared radius; ρ where the radius is near 1.
pub fn half_square<S: Signal>(c: S, s: S, half: S, structure: &Structure) -> S {
    c.begin(&RADIUS);
    ((c * c + s * s).scale(-1) - half.widen())
        .named("epsilon_exact")
        .quantise(&structure.formats.signal)
        .named("epsilon")
}

/// What one parameter's step is made of, and what stays gathered.
pub struct Gathered<S: Signal> {
    /// The gradient that moves the parameter now, where it may move.
    pub gradient: S,
    /// The gathered gradient after this sample.
    pub next: S,
}

/// Takes one component of a sample's gradient. `fresh`: this sample counts; `whole`: it begins a new period of travel.
pub fn gather<S: Signal>(
    gradient: S::Wide,
    before: S,
    fresh: S::Bool,
    whole: S::Bool,
    zero: S,
    structure: &Structure,
) -> Gathered<S> {
    before.begin(&GATHER);
    let to = &structure.formats.gathered;
    if structure.gradient == CalibrationMethod::Batch {
        let sum = (before.widen() + gradient).quantise(to);
        let kept = S::select(fresh, sum, before);
        return Gathered {
            // The whole period acts at once, so by a quarter.
            gradient: before.scale(-2),
            next: S::select(whole.and(fresh), zero, kept).quantise(to),
        };
    }
    let difference = gradient - before.widen();
    let mean = (before.widen() + difference.scale(-(structure.forgetting as i32))).quantise(to);
    Gathered {
        gradient: mean,
        next: S::select(fresh, mean, before).quantise(to),
    }
}

/// The gathered gradients as they stand.
pub fn gathered<S: Signal>(state: &State<S>) -> [S; 5] {
    [
        state.gathered_1,
        state.gathered_2,
        state.gathered_3,
        state.gathered_4,
        state.gathered_5,
    ]
}
