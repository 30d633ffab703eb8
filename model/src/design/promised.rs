//! Pairs that Θ has corrected, of the sensors that a design promises: where corrections are settled by what they leave.

use std::f64::consts::TAU;

use crate::kernel::{Coefficients, Structure};
use crate::spec::Spec;

/// What is promised, at its ends and in between.
const ENDS: [f64; 3] = [-1.0, 0.0, 1.0];

/// A sensor of that promise, calibrated.
#[derive(Clone, Copy)]
pub(super) struct Promised {
    /// tan β.
    pub(super) tan: f64,
    /// θ1 and θ5 that correct it.
    pub(super) thetas: (f64, f64),
}

/// Phase errors, where they are calibrated, and amplitudes.
pub(super) fn promised(
    spec: &Spec,
    structure: &Structure,
    k: &Coefficients<f64>,
) -> impl Iterator<Item = Promised> {
    let beta_max = if structure.calibration.has_phase() {
        spec.sensor.phase_error_max_deg.to_radians()
    } else {
        0.0
    };
    let (nominal, tolerance) = (k.theta_1_nominal, spec.sensor.amplitude_tolerance);
    let bent = structure.calibration.has_bend();
    let pairs = ENDS
        .into_iter()
        .flat_map(|beta| ENDS.map(|gain| (beta, gain)));
    pairs.map(move |(beta, gain)| {
        let tan = (beta * beta_max).tan();
        let theta_1 = nominal / (1.0 + gain * tolerance);
        let theta_5 = if bent { tan } else { tan * theta_1 };
        Promised {
            tan,
            thetas: (theta_1, theta_5),
        }
    })
}

/// Largest error of cosine or sine and rms angle error (radians) of pairs over a period; `pair`: what is left of the pair at
/// this cosine and sine.
pub(super) fn errors(angles: u32, pair: impl Fn(f64, f64, f64) -> (f64, f64)) -> (f64, f64) {
    let (mut largest, mut sum) = (0.0f64, 0.0);
    for i in 0..angles {
        let alpha = TAU * f64::from(i) / f64::from(angles);
        let (sin, cos) = alpha.sin_cos();
        let (c, s) = pair(alpha, cos, sin);
        largest = largest.max((c - cos).abs()).max((s - sin).abs());
        sum += (s * cos - c * sin).atan2(c * cos + s * sin).powi(2);
    }
    (largest, (sum / f64::from(angles)).sqrt())
}
