//! Polynomials of the time, which a slow change is made of.

use nalgebra::{DMatrix, DVector};

use crate::numerics::polygon::sampled;

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

/// Log-likelihood that a polynomial of each channel explains, each number at its price but for `free` of them; from the sums that
/// [`crate::numerics::polygon::Polygon::new`] takes.
pub(crate) fn explained(
    gram: &DMatrix<f64>,
    right: &DVector<f64>,
    degree: usize,
    price: f64,
    free: usize,
) -> f64 {
    let functions: Vec<_> = (0..=degree).map(|n| move |x| legendre(n, x)).collect();
    let found = sampled(gram, right, &functions);
    found.gain() - price * (found.rank as f64 - free as f64)
}
