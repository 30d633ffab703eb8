//! What jumps and delays of an angle are told by: curves through the samples on either side of a place, how large the noise is beside it,
//! and whether it is by a whole number of samples.

use std::ops::Range;

/// So many times the samples on a side, to either side, tell how large the noise is just there.
pub(crate) const AROUND: usize = 8;
/// A number of samples is so near a whole one, beside what noise makes of it.
const WHOLE: f64 = 0.15;

/// Samples on either side of the one at `k` of `n` that tell how large the noise is; a jump shows itself up to a side away from it.
pub(crate) fn beside(k: usize, side: usize, n: usize) -> [Range<usize>; 2] {
    let before = k.saturating_sub(AROUND * side)..k.saturating_sub(side);
    [before, (k + side).min(n)..(k + AROUND * side).min(n)]
}

/// A function of the place among so many samples, which are the places from −1 to 1.
pub(crate) fn column(samples: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let middle = (samples as f64 - 1.0) / 2.0;
    (0..samples)
        .map(|i| f((i as f64 - middle) / middle))
        .collect()
}

/// What a curve of that order through so many samples is made of.
pub(crate) fn powers(samples: usize, order: i32) -> Vec<Vec<f64>> {
    (0..=order)
        .map(|degree| column(samples, |x| x.powi(degree)))
        .collect()
}

/// Whether a number of samples is that whole one, as far as its standard deviation tells.
pub(crate) fn is_about(samples: f64, whole: f64, sigma: f64) -> bool {
    (samples - whole).abs() < WHOLE + 3.0 * sigma
}
