//! What delays and first-order low passes do to the channels, from the smooth motion. In one channel they see all of it: what is known to
//! be added to it in every period comes as late as its sine does. In both they see the pair.

use nonius_fourier::Complex;

use crate::shapes::block::Block;

/// What a first-order low pass of time constant `tau` does to a channel, over `tau`: its response at the speed of the
/// moment, and the next term, with the acceleration.
pub(super) fn low_pass(block: &Block, which: usize, tau: f64) -> Vec<f64> {
    through(block, which, |speed, acceleration| {
        let one = Complex::new(1.0, speed * tau);
        let turn = Complex::new(0.0, acceleration * tau * tau);
        (one.inv() - 1.0 + turn / (one * one * one)) / tau
    })
}

/// A channel `delay` seconds later less itself, over `delay`.
pub(super) fn later(block: &Block, which: usize, delay: f64) -> Vec<f64> {
    through(block, which, |speed, acceleration| {
        if delay == 0.0 {
            return Complex::new(0.0, speed);
        }
        let angle = speed * delay + 0.5 * acceleration * delay * delay;
        (Complex::from_polar(1.0, angle) - 1.0) / delay
    })
}

/// What changes waves adds to a channel: the factor by which it multiplies one, less one, by the wave's speed and acceleration, radians
/// per second.
fn through(block: &Block, which: usize, changed: impl Fn(f64, f64) -> Complex<f64>) -> Vec<f64> {
    let (u, slope) = (block.u[which], block.slope[which]);
    let times =
        |order: f64, k: usize| changed(order * block.speed[k], order * block.acceleration[k]);
    let mut sum: Vec<f64> = (0..block.len())
        .map(|k| {
            let by = times(1.0, k);
            by.re * u[k] + by.im * slope[k]
        })
        .collect();
    let periodic = &block.periodic[which];
    if periodic.is_constant() {
        return sum;
    }
    let waves = periodic.0.iter().enumerate().skip(1);
    for (k, sum) in sum.iter_mut().enumerate() {
        let one = Complex::new(block.cos[k], block.sin[k]);
        let mut wave = Complex::new(1.0, 0.0);
        for (order, [a, b]) in waves.clone() {
            wave *= one;
            // The real part of (a − j b) exp(j order α).
            *sum += (times(order as f64, k) * Complex::new(*a, -b) * wave).re;
        }
    }
    sum
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
