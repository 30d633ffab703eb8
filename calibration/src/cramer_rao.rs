//! The Cramér–Rao bound: what no unbiased estimator can beat.
//!
//! The angles are unknown too, one per sample, so each sample tells of the parameters only what lies across the curve:
//! with n the normal in the metric of the noise, F = Σ (n·∂y/∂p)(n·∂y/∂p)ᵀ. The ADC's rounding counts as noise of
//! lsb/√12 of its own; that holds where the noise is above about a third of an LSB and is a guess below.

use nalgebra::{SMatrix, Vector2};
use nonius_recording::Ellipse;

use crate::curve::{Curve, Parameters, invert, theta_covariance};
use crate::set::Set;
use crate::set_bound::{Motion, SetBound, of_ellipse};

/// Bounds for given angles and noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// Covariance of a_c, b_c, a_s, b_s, β; units of the signals and radians.
    pub covariance: SMatrix<f64, 5, 5>,
    /// Covariance of θ1 … θ5 of section 5.3.
    pub theta: SMatrix<f64, 5, 5>,
    /// Error of the angle from the uncertain parameters alone, rms over the whole period, radians.
    pub angle_by_parameters: f64,
    /// Error of the angle of one sample from its own noise, rms over the whole period, radians.
    pub angle_by_noise: f64,
}

/// A recording that is planned: what a calibration from it can reach at best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The sensor.
    pub ellipse: Ellipse,
    /// White noise of cosine and sine before the ADC, rms, in the unit of the signals.
    pub noise: [f64; 2],
    /// One step of each channel's ADC in the unit of the signals; 0 for none.
    pub lsb: [f64; 2],
    /// Number of samples.
    pub samples: usize,
    /// Where the first sample lies, radians.
    pub start: f64,
    /// Arc that the samples are spread over evenly, in periods; above 1 it goes round again.
    pub periods: f64,
}

impl Plan {
    /// The bound; `None` where the arc or the noise does not determine it.
    #[must_use]
    pub fn bound(&self) -> Option<Bound> {
        let angles: Vec<f64> = self.angles().collect();
        bound(&self.ellipse, &angles, self.noise_with_adc())
    }

    /// That of any set, for a sensor without bends; the sets without phase take β as 0.
    #[must_use]
    pub fn bound_of(&self, set: Set, motion: Motion) -> Option<SetBound> {
        of_ellipse(
            set,
            &self.ellipse,
            self.angles(),
            self.noise_with_adc(),
            motion,
        )
    }

    fn angles(&self) -> impl Iterator<Item = f64> + use<> {
        let step = self.periods * std::f64::consts::TAU / self.samples as f64;
        let start = self.start;
        (0..self.samples).map(move |k| start + step * k as f64)
    }

    fn noise_with_adc(&self) -> [f64; 2] {
        [0, 1].map(|i| with_adc(self.noise[i], self.lsb[i]))
    }
}

/// Noise of a channel, rms: its own, and the ADC's rounding. `lsb` 0 is no ADC.
#[must_use]
pub fn with_adc(noise: f64, lsb: f64) -> f64 {
    (noise * noise + lsb * lsb / 12.0).sqrt()
}

/// The bound for samples at the angles `alpha` (radians) of an ellipse, with noise of rms `noise` in cosine and sine.
/// `None` where the angles do not determine it, or there is no noise.
#[must_use]
pub fn bound(ellipse: &Ellipse, alpha: &[f64], noise: [f64; 2]) -> Option<Bound> {
    if !(noise[0] > 0.0 && noise[1] > 0.0) {
        return None;
    }
    let mut information = SMatrix::<f64, 5, 5>::zeros();
    for a in alpha {
        let by = across(ellipse, *a, noise);
        information += by * by.transpose();
    }
    let covariance = invert(&information, ellipse)?;
    let [angle_by_parameters, angle_by_noise] = of_angle(ellipse, &covariance, noise);
    Some(Bound {
        theta: theta_covariance(ellipse, &covariance),
        covariance,
        angle_by_parameters,
        angle_by_noise,
    })
}

/// How far the curve moves across itself with each parameter, in units of the noise.
fn across(ellipse: &Ellipse, alpha: f64, noise: [f64; 2]) -> Parameters {
    let white = |v: Vector2<f64>| Vector2::new(v.x / noise[0], v.y / noise[1]);
    let along = white(ellipse.tangent(alpha));
    let normal = Vector2::new(along.y, -along.x) / along.norm();
    Parameters::from(ellipse.by_parameters(alpha).map(|v| normal.dot(&white(v))))
}

/// Error of the corrected angle by parameters and by noise, rms over the period. A change δy of the signals, at
/// constant Θ, turns the angle by (∂y/∂α × δy) over the area that ∂y/∂α sweeps: α̂ = atan2(s, c) of the corrected pair,
/// and to first order δα = cos α δs − sin α δc.
fn of_angle(ellipse: &Ellipse, covariance: &SMatrix<f64, 5, 5>, noise: [f64; 2]) -> [f64; 2] {
    const POINTS: u32 = 360;
    let (tan, cos_beta) = (ellipse.beta.tan(), ellipse.beta.cos());
    let mut sums = [0.0; 2];
    for k in 0..POINTS {
        let alpha = f64::from(k) * std::f64::consts::TAU / f64::from(POINTS);
        let (sin, cos) = alpha.sin_cos();
        // δc = δy_c / a_c, δs = δy_s / (a_s cos β) + δc tan β.
        let by = Vector2::new(
            (cos * tan - sin) / ellipse.a_c,
            cos / (ellipse.a_s * cos_beta),
        );
        // A wrong parameter acts as signals moved the other way.
        let gradient = Parameters::from(ellipse.by_parameters(alpha).map(|v| by.dot(&v)));
        sums[0] += (gradient.transpose() * covariance * gradient)[0];
        sums[1] += (by.x * noise[0]).powi(2) + (by.y * noise[1]).powi(2);
    }
    sums.map(|s| (s / f64::from(POINTS)).sqrt())
}
