//! The Cramér–Rao bound: what no unbiased estimator can beat.

use nalgebra::{SMatrix, Vector2};

use crate::ellipse::{Ellipse, Parameters};
use crate::unbiased::distance;

/// Bounds for given angles and noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// Covariance of a_c, b_c, a_s, b_s, β.
    pub covariance: SMatrix<f64, 5, 5>,
    /// Standard deviation of θ1 … θ5.
    pub theta: [f64; 5],
    /// Angle error from the uncertain parameters alone, rms over the angles, radians.
    pub angle_by_parameters: f64,
    /// Angle error of one sample from its own noise, rms over the angles, radians.
    pub angle_by_noise: f64,
}

/// Noise of a channel: its own, and the ADC's rounding, rms in the unit of the signals. `lsb` 0 is no ADC.
#[must_use]
pub fn with_adc(noise: f64, lsb: f64) -> f64 {
    (noise * noise + lsb * lsb / 12.0).sqrt()
}

/// The bound for samples at `alpha` (radians) of an ellipse, with noise of rms `noise` in cosine and sine. The angles
/// are unknown, so each sample tells only what lies across the curve. `None` where the angles do not determine it.
#[must_use]
pub fn bound(ellipse: &Ellipse, alpha: &[f64], noise: [f64; 2]) -> Option<Bound> {
    let ratio = noise[1] / noise[0];
    let mut information = SMatrix::<f64, 5, 5>::zeros();
    for a in alpha {
        let (_, by, _, _) = distance(ellipse, ellipse.point(*a), ratio);
        information += by * by.transpose() / (noise[0] * noise[0]);
    }
    let covariance = information.try_inverse()?;
    let mut by_parameters = 0.0;
    let mut by_noise = 0.0;
    for a in alpha {
        let point = ellipse.point(*a);
        let slope = |f: &dyn Fn(f64) -> f64, h: f64| (f(h) - f(-h)) / (2.0 * h);
        let angle = |e: &Ellipse, y: Vector2<f64>| {
            let (c, s) = e.corrected(y.x, y.y);
            let (sin, cos) = a.sin_cos();
            (s * cos - c * sin).atan2(c * cos + s * sin)
        };
        let h = 1e-6 * ellipse.amplitude();
        let gradient = Parameters::from_fn(|i, _| {
            let h = if i == 4 { 1e-6 } else { h };
            let moved = |d: f64| {
                let mut p = ellipse.parameters();
                p[i] += d;
                angle(&Ellipse::of(&p), point)
            };
            slope(&moved, h)
        });
        by_parameters += (gradient.transpose() * covariance * gradient)[0];
        for (axis, sigma) in noise.iter().enumerate() {
            let moved = |d: f64| {
                let mut y = point;
                y[axis] += d;
                angle(ellipse, y)
            };
            by_noise += (slope(&moved, h) * sigma).powi(2);
        }
    }
    let n = alpha.len() as f64;
    Some(Bound {
        theta: theta_errors(ellipse, &covariance),
        covariance,
        angle_by_parameters: (by_parameters / n).sqrt(),
        angle_by_noise: (by_noise / n).sqrt(),
    })
}

/// Standard deviations of θ1 … θ5 from the covariance of the physical parameters.
#[must_use]
pub fn theta_errors(ellipse: &Ellipse, covariance: &SMatrix<f64, 5, 5>) -> [f64; 5] {
    let a = ellipse.amplitude();
    let mut jacobian = SMatrix::<f64, 5, 5>::zeros();
    for i in 0..5 {
        let h = if i == 4 { 1e-6 } else { 1e-6 * a };
        let at = |d: f64| {
            let mut p = ellipse.parameters();
            p[i] += d;
            Ellipse::of(&p).theta()
        };
        let (up, down) = (at(h), at(-h));
        for k in 0..5 {
            jacobian[(k, i)] = (up[k] - down[k]) / (2.0 * h);
        }
    }
    let theta = jacobian * covariance * jacobian.transpose();
    std::array::from_fn(|i| theta[(i, i)].max(0.0).sqrt())
}
