//! The extremes of the two signals: the baseline that the paper's introduction argues against.

use crate::ellipse::Ellipse;

/// Half the difference and half the sum of the extremes; β = 0. `None` where a channel does not move.
#[must_use]
pub fn extremes(cos: &[f64], sin: &[f64]) -> Option<Ellipse> {
    let ends = |v: &[f64]| {
        v.iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
                (low.min(*x), high.max(*x))
            })
    };
    let ((c0, c1), (s0, s1)) = (ends(cos), ends(sin));
    let ellipse = Ellipse {
        a_c: (c1 - c0) / 2.0,
        b_c: (c1 + c0) / 2.0,
        a_s: (s1 - s0) / 2.0,
        b_s: (s1 + s0) / 2.0,
        beta: 0.0,
    };
    ellipse.is_sound().then_some(ellipse)
}
