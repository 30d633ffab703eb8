//! What a correction leaves of the radius, and whether it left anything to correct.

use crate::curve::Curve;
use crate::method::Method;
use crate::nothing::centred;
use crate::unbiased::Fit;

/// Rms of the corrected radius less one.
pub(crate) fn residual(method: Method, theta: &[f64], cos: &[f64], sin: &[f64]) -> f64 {
    let radius = |(y_c, y_s): (&f64, &f64)| {
        let (c, s) = method.set().correct(theta, *y_c, *y_s);
        (c.hypot(s) - 1.0).powi(2)
    };
    let sum: f64 = cos.iter().zip(sin).map(radius).sum();
    (sum / cos.len() as f64).sqrt()
}

/// The smaller channel's white noise, in amplitudes.
pub(crate) fn white(fit: &Fit) -> f64 {
    let [c, s] = fit.relative_noise();
    c.min(s)
}

/// Whether Θ draws the samples together: J is smallest where all of them are one point of the circle, and a cubic reaches
/// it on an arc, gains and offsets on a short one. The residual is then far below the noise, and the corrected pairs are far closer to each
/// other than the ellipse has them.
pub(crate) fn collapsed(
    method: Method,
    theta: &[f64],
    fit: &Fit,
    cos: &[f64],
    sin: &[f64],
) -> bool {
    /// Share of the noise.
    const FAR: f64 = 0.3;
    /// Of the distance of the pairs from each other.
    const CLOSE: f64 = 0.5;
    let spread = |method: Method, theta: &[f64]| {
        let pairs = cos.iter().zip(sin);
        let corrected = pairs.map(|(c, s)| method.set().correct(theta, *c, *s));
        let (c, s): (Vec<f64>, Vec<f64>) = corrected.unzip();
        centred(&c, &s)
            .iter()
            .map(|y| y.norm_squared())
            .sum::<f64>()
    };
    residual(method, theta, cos, sin) < FAR * white(fit)
        && spread(method, theta) < CLOSE * CLOSE * spread(Method::Unbiased, &fit.ellipse.theta())
}
