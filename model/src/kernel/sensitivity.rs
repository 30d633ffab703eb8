//! ∇α̂: how the estimate follows when a parameter moves, one scalar for each direction.
//!
//! It is the loop once more, fed with w − ∇α̂ where the loop is fed with e = α − α̂; so it is written as the loop filter
//! is, in increments. Angles are radians here.

use super::{Coefficients, Method, Structure};
use crate::signal::{Formula, Signal, Wide};

static TYPE_2: Formula = Formula {
    title: "Sensitivity of the estimate",
    equation: "grad' = grad + rate', rate' = rate + a (e_v - e_v1) + (a + b) e_v1, e_v = w - grad",
    source: "paper equations (10) and (11), (10) as the difference it is",
};

static TYPE_1: Formula = Formula {
    equation: "grad' = grad + rate', rate' = p rate + a (e_v - e_v1) + (a + b) e_v1, e_v = w - grad",
    ..TYPE_2
};

static METHOD_2: Formula = Formula {
    equation: "grad' = grad + rate', rate' = p rate + a e_v, e_v = w - grad",
    source: "paper equations (10) and (11), (10) as the difference it is, with the filter of section 4.2",
    ..TYPE_2
};

/// One scalar of ∇α̂, its increment, and w − ∇α̂.
#[derive(Clone, Copy, Debug)]
pub struct Sensitivity<S> {
    /// ∇α̂, radians.
    pub gradient: S,
    /// Its increment per sample, radians.
    pub rate: S,
    /// w − ∇α̂.
    pub error: S,
}

/// The scalar after this sample; `before` holds the error of the sample before, the result that of this one. `name` is
/// that of w − ∇α̂.
pub fn advance<S: Signal>(
    w: S,
    before: Sensitivity<S>,
    name: &'static str,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Sensitivity<S> {
    w.begin(match (structure.method, structure.filter_type) {
        (Method::Two, _) => &METHOD_2,
        (_, 2) => &TYPE_2,
        _ => &TYPE_1,
    });
    let formats = &structure.formats;
    let to = &formats.alpha_gradient;
    let error = (w - before.gradient).quantise(&formats.signal).named(name);
    let kept = if structure.filter_type == 2 {
        before.rate
    } else {
        let short = before.rate.quantise(&formats.signal);
        before.rate - (k.loop_leak * short).quantise(to)
    };
    let rate = if structure.method == Method::Two {
        (kept + (k.loop_a_radians * error).quantise(to)).quantise(to)
    } else {
        let change = (error - before.error).quantise(&formats.signal);
        let kick = (k.loop_a_radians * change).quantise(to);
        let drift = (k.loop_ab_radians * before.error).quantise(to);
        (kept + drift + kick).quantise(to)
    };
    Sensitivity {
        gradient: (before.gradient + rate).quantise(to),
        rate,
        error,
    }
}
