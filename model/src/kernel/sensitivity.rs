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

/// What the parts of one sensitivity are called in waves and Verilog.
#[derive(Clone, Copy, Debug)]
pub struct Names {
    /// w − ∇α̂.
    pub error: &'static str,
    /// Its change in a sample.
    pub change: &'static str,
    /// What the change adds to the rate.
    pub kick: &'static str,
    /// What the error of the sample before adds to it.
    pub drift: &'static str,
    /// The rate with that.
    pub drifted: &'static str,
}

/// Names that begin with the word of `w`.
macro_rules! names {
    ($w:literal) => {
        &crate::kernel::sensitivity::Names {
            error: concat!($w, "_error"),
            change: concat!($w, "_error_change"),
            kick: concat!($w, "_kick"),
            drift: concat!($w, "_drift"),
            drifted: concat!($w, "_rate_drifted"),
        }
    };
}
pub(super) use names;

/// The scalar after this sample; `before` holds the error of the sample before, the result that of this one.
pub fn advance<S: Signal>(
    w: S,
    before: Sensitivity<S>,
    names: &Names,
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
    let error = (w - before.gradient)
        .quantise(&formats.signal)
        .named(names.error);
    let kept = if structure.filter_type == 2 {
        before.rate
    } else {
        let short = before.rate.quantise(&formats.signal);
        before.rate - (k.loop_leak * short).quantise(to)
    };
    let rate = if structure.method == Method::Two {
        (kept + (k.loop_a_radians * error).quantise(to)).quantise(to)
    } else {
        let change = (error - before.error)
            .quantise(&formats.signal)
            .named(names.change);
        let kick = (k.loop_a_radians * change).quantise(to).named(names.kick);
        let drift = (k.loop_ab_radians * before.error).quantise(to);
        let drift = drift.named(names.drift);
        ((kept + drift).named(names.drifted) + kick).quantise(to)
    };
    Sensitivity {
        gradient: (before.gradient + rate).quantise(to),
        rate,
        error,
    }
}
