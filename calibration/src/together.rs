//! Noise that both channels have together: light that flickers behind both, a reference voltage, a ground.
//!
//! Across the curve a sample strays by n·ε, whose variance holds 2 n_c n_s cov(ε_c, ε_s) beside what each channel has of its own: with
//! the correlation the squared residuals swing as sin 2α.

use nalgebra::{Matrix3, Vector3};

use crate::noise::{Residual, is_coloured};

/// Standard errors from which on a correlation is said to be there.
const BEYOND: f64 = 5.0;
/// Least that is worth a word.
const LEAST: f64 = 0.1;

/// Correlation of the noise of both channels, −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Together {
    /// Its value.
    pub value: f64,
    /// And standard error.
    pub std_error: f64,
}

/// `None` where none is seen: then also where residuals resemble their neighbours, for what changes in time has an angle, too.
pub(crate) fn together(residuals: &[Residual]) -> Option<Together> {
    let n = residuals.len();
    if n < 100 || is_coloured(residuals) {
        return None;
    }
    let mean = residuals.iter().map(|r| r.white * r.white).sum::<f64>() / n as f64;
    // In the metric, mean and half the difference of both variances, and the covariance.
    let row = |r: &Residual| Vector3::new(1.0, 2.0 * r.white_cos - 1.0, r.by_both);
    let (mut gram, mut sum) = (Matrix3::zeros(), Vector3::zeros());
    for r in residuals {
        let row = row(r);
        gram += row * row.transpose();
        sum += row * (r.white * r.white / mean);
    }
    let inverse = gram.try_inverse()?;
    let found = inverse * sum;
    let mut scatter = Matrix3::zeros();
    for r in residuals {
        let row = row(r);
        let off = r.white * r.white / mean - row.dot(&found);
        scatter += row * row.transpose() * (off * off);
    }
    let covariance = inverse * scatter * inverse;
    let product = found[0] * found[0] - found[1] * found[1];
    if product.is_nan() || product <= 0.0 {
        return None;
    }
    let both = product.sqrt();
    let value = found[2] / both;
    let by = Vector3::new(
        -value * found[0] / product,
        value * found[1] / product,
        1.0 / both,
    );
    let std_error = by.dot(&(covariance * by)).sqrt();
    let there = value.abs() > BEYOND * std_error && value.abs() > LEAST;
    there.then_some(Together { value, std_error })
}
