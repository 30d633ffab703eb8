//! What of the channels is slower than the spectrum of flicker noise that is looked at. Along the radius it shows about the angle and
//! not slowly, so that it is in every line of the spectrum.

use nalgebra::{DMatrix, DVector};

use crate::context::Context;
use crate::numerics::polynomial::{DEGREE, legendre};
use crate::numerics::solve::Normal;

/// A radial residual without offsets of the channels that are polynomials of time.
pub(super) fn without(context: &Context, radial: &[f64]) -> Vec<f64> {
    let last = (radial.len().max(2) - 1) as f64;
    let count = 2 * (DEGREE + 1);
    let row = |k: usize, out: &mut [f64]| {
        let time = 2.0 * k as f64 / last - 1.0;
        for (degree, pair) in out.chunks_mut(2).enumerate() {
            let by = legendre(degree, time);
            pair[0] = by * context.cos[k];
            pair[1] = by * context.sin[k];
        }
    };
    let (mut gram, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
    let mut own = vec![0.0; count];
    for (k, r) in radial.iter().enumerate() {
        row(k, &mut own);
        let weight = context.weight[k];
        for (i, a) in own.iter().enumerate() {
            right[i] += weight * a * r;
            for (j, b) in own[..=i].iter().enumerate() {
                gram[(i, j)] += weight * a * b;
            }
        }
    }
    gram.fill_upper_triangle_with_lower_triangle();
    let amounts = Normal::new(gram, right, 0.0).solve().x;
    let mut left = radial.to_vec();
    for (k, left) in left.iter_mut().enumerate() {
        row(k, &mut own);
        *left -= own.iter().zip(&amounts).map(|(o, x)| o * x).sum::<f64>();
    }
    left
}
