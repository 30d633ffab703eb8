//! The closed loop in the frequency domain.

use std::f64::consts::{PI, TAU};

use nonius_model::design::Loop;

/// |H| of the closed loop, from the angle to its estimate one sample later, at a frequency in cycles per sample.
pub(crate) fn magnitude(tracking: &Loop, frequency: f64) -> f64 {
    let w = TAU * frequency;
    let (b1, b0) = (TAU * tracking.a, TAU * (tracking.ab - tracking.a));
    // (b1 z + b0) / (z² − sum z + product) on the unit circle.
    let numerator = (b1 * w.cos() + b0).hypot(b1 * w.sin());
    let (sum, product) = (tracking.pole_sum, tracking.pole_product);
    let real = (2.0 * w).cos() - sum * w.cos() + product;
    let imaginary = (2.0 * w).sin() - sum * w.sin();
    numerator / real.hypot(imaginary)
}

/// Frequency, in cycles per sample, above which the closed loop stays below −3 dB; ½ if it never does.
pub(crate) fn bandwidth(tracking: &Loop) -> f64 {
    let limit = 0.5f64.sqrt();
    let steps = 4000;
    let at = |i: usize| 0.5 * (10f64).powf(-4.0 * (1.0 - i as f64 / f64::from(steps)));
    let last = (0..=steps as usize)
        .rev()
        .find(|&i| magnitude(tracking, at(i)) >= limit);
    match last {
        Some(i) if i < steps as usize => at(i + 1),
        Some(_) => 0.5,
        None => 0.0,
    }
}

/// Largest magnification, as a factor.
pub(crate) fn peak(tracking: &Loop) -> f64 {
    (1..2000)
        .map(|i| magnitude(tracking, f64::from(i) / 4000.0 * tracking.omega / PI * 4.0))
        .fold(1.0, f64::max)
}
