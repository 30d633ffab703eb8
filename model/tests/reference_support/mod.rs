//! What the tests of the reference share.
#![allow(dead_code, reason = "each test binary uses its own part")]

use std::f64::consts::TAU;

use nonius_model::reference::loops::{FilterType, LoopConfig, Method};
use nonius_model::reference::poles::Poles;
use nonius_model::reference::{Parameters, Sensor, Theta};
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

/// Sample time of the tests, seconds.
pub(crate) const TS: f64 = 1e-5;

/// A loop of this ω0 ts with damping 1/√2.
pub(crate) fn type_2(omega_ts: f64) -> LoopConfig {
    let poles = Poles::new(omega_ts / TS, std::f64::consts::FRAC_1_SQRT_2, TS)
        .expect("poles inside the unit circle");
    LoopConfig::new(Method::Three(FilterType::Two), &poles, TS).expect("the paper builds it")
}

/// Miscalibrated by everything that equation (4) knows: offsets 10 %, gain ratio 1.2, β 5°.
pub(crate) const MISCALIBRATED: Sensor = Sensor {
    a_c: 1.1,
    b_c: 0.11,
    a_s: 0.9167,
    b_s: -0.09,
    beta: 0.0873,
};

/// Gaussian noise from a seed (Box and Muller).
pub(crate) struct Noise {
    random: StdRng,
    sigma: f64,
}

impl Noise {
    pub(crate) fn new(seed: u64, sigma: f64) -> Self {
        Self {
            random: StdRng::seed_from_u64(seed),
            sigma,
        }
    }

    pub(crate) fn pair(&mut self) -> [f64; 2] {
        let radius = (-2.0 * (1.0 - self.random.random::<f64>()).ln()).sqrt() * self.sigma;
        let (sin, cos) = (TAU * self.random.random::<f64>()).sin_cos();
        [radius * cos, radius * sin]
    }
}

/// To the nearest whole turn, radians.
pub(crate) fn wrapped(x: f64) -> f64 {
    x - (x / TAU).round() * TAU
}

/// Miscalibration: the angle of the noise-free corrected pair minus the true angle, over a period; (rms, largest) in
/// radians. A constant part is none: it moves the origin of the scale alone.
pub(crate) fn miscalibration(
    parameters: Parameters,
    theta: &Theta,
    signals: impl Fn(f64) -> [f64; 2],
) -> (f64, f64) {
    const N: usize = 720;
    let errors: Vec<f64> = (0..N)
        .map(|k| {
            let alpha = TAU * k as f64 / N as f64;
            let [c, s] = parameters.corrected(theta, signals(alpha));
            wrapped(s.atan2(c) - alpha)
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / N as f64;
    let square = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / N as f64;
    let largest = errors.iter().fold(0.0f64, |m, e| m.max((e - mean).abs()));
    (square.sqrt(), largest)
}

/// Amplitude of the miscalibration's harmonic of this order, radians.
pub(crate) fn order(
    parameters: Parameters,
    theta: &Theta,
    signals: impl Fn(f64) -> [f64; 2],
    order: u32,
) -> f64 {
    const N: usize = 720;
    let (mut re, mut im) = (0.0, 0.0);
    for k in 0..N {
        let alpha = TAU * k as f64 / N as f64;
        let [c, s] = parameters.corrected(theta, signals(alpha));
        let error = wrapped(s.atan2(c) - alpha);
        let (sin, cos) = (f64::from(order) * alpha).sin_cos();
        re += error * cos;
        im += error * sin;
    }
    re.hypot(im) * 2.0 / N as f64
}
