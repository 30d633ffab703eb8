//! What delays and first-order low passes do to the channels, from the smooth motion.

use nonius_fourier::Complex;

use crate::shapes::block::Block;

/// What a first-order low pass of time constant `tau` does to a channel, over `tau`: its response at the speed of the
/// moment, and the next term, with the acceleration.
pub(super) fn low_pass(block: &Block, which: usize, tau: f64) -> Vec<f64> {
    let (u, slope) = (block.u[which], block.slope[which]);
    (0..block.len())
        .map(|k| {
            let one = Complex::new(1.0, block.speed[k] * tau);
            let turn = Complex::new(0.0, block.acceleration[k] * tau * tau);
            let change = one.inv() - 1.0 + turn / (one * one * one);
            (change.re * u[k] + change.im * slope[k]) / tau
        })
        .collect()
}

/// A channel `delay` seconds later less itself, over `delay`.
pub(super) fn later(block: &Block, which: usize, delay: f64) -> Vec<f64> {
    let (u, slope) = (block.u[which], block.slope[which]);
    let pairs = block.speed.iter().zip(block.acceleration);
    pairs
        .enumerate()
        .map(|(k, (v, a))| {
            if delay == 0.0 {
                return v * slope[k];
            }
            let (sin, cos) = (v * delay + 0.5 * a * delay * delay).sin_cos();
            (u[k] * (cos - 1.0) + slope[k] * sin) / delay
        })
        .collect()
}

/// What a low pass in both channels takes from the radius, over the square of its time constant `tau2`: its response at
/// the speed that is seen, which is late too, and the next term, with the acceleration.
pub(super) fn falls(block: &Block, tau2: f64) -> Vec<f64> {
    let tau = tau2.max(0.0).sqrt();
    let pairs = block.speed.iter().zip(block.acceleration);
    pairs
        .map(|(v, a)| {
            let one = 1.0 + v * v * tau2.max(0.0);
            let root = one.sqrt();
            // Free of cancellation where little is lost.
            -v * v / (root * (1.0 + root)) + v * a * tau / (root * one * one)
        })
        .collect()
}

/// What the same low pass of time constant `tau` in both channels does against a reference, over `tau`: the radius falls,
/// and the angle is late.
pub(super) fn falls_behind(block: &Block, tau: f64, out: &mut [f64]) {
    let (radius, angle) = out.split_at_mut(block.len());
    for (k, v) in block.speed.iter().enumerate() {
        let x = v * tau;
        let root = (1.0 + x * x).sqrt();
        radius[k] = -v * x / (root * (1.0 + root));
        angle[k] = if x == 0.0 { -v } else { -x.atan() / tau };
    }
}
