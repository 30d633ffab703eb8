//! A sensor that keeps what a design promises: amplitudes, offsets, phase and bends within it, with the promised noise.

use std::f64::consts::TAU;

use nonius_model::physical::Converter;
use nonius_model::spec::{Correction, Spec};

/// How much of each promised error there is, and which way: −1 … 1; cosine first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shares {
    pub(crate) gains: [f64; 2],
    pub(crate) offsets: [f64; 2],
    pub(crate) phase: f64,
    pub(crate) bends: [f64; 2],
}

/// The sensor and the ADC behind it.
pub(crate) struct Sensor {
    converter: Converter,
    amplitudes: [f64; 2],
    offsets: [f64; 2],
    beta: f64,
    /// Second harmonic, in amplitudes.
    bends: [f64; 2],
    /// The sine is sampled so many samples later.
    late: f64,
    /// What stands in the channels beside them, in amplitudes.
    correction: Correction,
    middle: f64,
    noise: f64,
    random: Noise,
}

/// A pair of codes.
pub(crate) struct Sample {
    pub(crate) cos: i64,
    pub(crate) sin: i64,
    /// Arctangent of the signals, turns.
    pub(crate) arctangent: f64,
}

impl Sensor {
    /// With so much of what is promised, `amplitude` in place of the nominal one (in the unit of the ADC's range); `seed` of the
    /// noise is not 0.
    pub(crate) fn of(spec: &Spec, shares: &Shares, amplitude: f64, seed: u64) -> Self {
        let s = &spec.sensor;
        Self {
            converter: Converter::of(spec),
            amplitudes: shares
                .gains
                .map(|share| amplitude * (1.0 + share * s.amplitude_tolerance)),
            offsets: shares.offsets.map(|share| share * s.offset_max * amplitude),
            beta: shares.phase * s.phase_error_max_deg.to_radians(),
            bends: shares.bends.map(|share| share * s.bend_max),
            late: spec.correction.channel_skew_s * spec.adc.sample_rate_hz,
            correction: spec.correction.clone(),
            middle: spec.adc.middle,
            noise: amplitude * s.noise_rms,
            random: Noise(seed),
        }
    }

    /// At `at` periods, moving by `speed` periods per sample.
    pub(crate) fn sample(&mut self, at: f64, speed: f64) -> Sample {
        let (alpha, alpha_of_sin) = (at * TAU, (at + self.late * speed) * TAU);
        let (more_cos, _) = self.correction.harmonics_at(0, alpha);
        let (more_sin, _) = self.correction.harmonics_at(1, alpha_of_sin);
        let (u, v) = (alpha.cos(), (alpha_of_sin - self.beta).sin());
        let bent = |u: f64, bend: f64| u + bend * (2.0 * u * u - 1.0);
        let cos = self.amplitudes[0] * (bent(u, self.bends[0]) + more_cos)
            + self.offsets[0]
            + self.noise * self.random.next();
        let sin = self.amplitudes[1] * (bent(v, self.bends[1]) + more_sin)
            + self.offsets[1]
            + self.noise * self.random.next();
        Sample {
            cos: self.converter.code(self.middle + cos),
            sin: self.converter.code(self.middle + sin),
            arctangent: sin.atan2(cos) / TAU,
        }
    }
}

/// Nearly Gaussian noise from a fixed seed: twelve uniform numbers less six.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut sum = -6.0;
        for _ in 0..12 {
            // xorshift64
            self.0 ^= self.0 << 13;
            self.0 ^= self.0 >> 7;
            self.0 ^= self.0 << 17;
            sum += (self.0 >> 11) as f64 / (1u64 << 53) as f64;
        }
        sum
    }
}
