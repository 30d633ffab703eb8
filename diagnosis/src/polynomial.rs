//! Polynomials of the time, which a slow change is made of.

use nalgebra::{DMatrix, DVector};

use crate::polygon::{CHANNELS, PIECES};
use crate::solve::Normal;

/// Highest degree of a polynomial of the time.
pub(crate) const DEGREE: usize = 6;

/// Legendre polynomial of a time from −1 to 1.
pub(crate) fn legendre(degree: usize, x: f64) -> f64 {
    let (mut before, mut now) = (0.0, 1.0);
    for n in 0..degree {
        let m = n as f64;
        (before, now) = (now, ((2.0 * m + 1.0) * x * now - m * before) / (m + 1.0));
    }
    now
}

/// Log-likelihood that a polynomial of each channel explains, sampled at the knots, each number at its price but for `free` of them; from the
/// sums that [`crate::polygon::Polygon::new`] takes.
pub(crate) fn explained(
    gram: &DMatrix<f64>,
    right: &DVector<f64>,
    degree: usize,
    price: f64,
    free: usize,
) -> f64 {
    let columns = CHANNELS * (degree + 1);
    let at = |i: usize, j: usize| {
        if i % CHANNELS == j % CHANNELS {
            legendre(
                j / CHANNELS,
                2.0 * (i / CHANNELS) as f64 / PIECES as f64 - 1.0,
            )
        } else {
            0.0
        }
    };
    let values = DMatrix::from_fn(CHANNELS * (PIECES + 1), columns, at);
    let products = values.tr_mul(gram) * &values;
    let found = Normal::new(products, values.tr_mul(right), 0.0).solve();
    found.gain() - price * (found.rank as f64 - free as f64)
}
