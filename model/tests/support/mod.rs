//! Simulated encoders for the tests of the chip.
#![allow(dead_code, reason = "each test binary uses its own part")]

#[path = "../../../designs/shipped.rs"]
pub(crate) mod shipped;

#[allow(unused_imports, reason = "each test binary uses its own part")]
pub(crate) use shipped::optical;

use nonius_model::spec::Spec;

/// Equation (4), as fractions of the ADC's range, and the ADC.
pub(crate) struct Encoder {
    pub(crate) amplitude: [f64; 2],
    pub(crate) offset: [f64; 2],
    pub(crate) beta: f64,
    pub(crate) bits: u32,
}

impl Encoder {
    pub(crate) fn ideal(spec: &Spec) -> Self {
        let a = spec.sensor.amplitude / spec.adc.full_scale;
        Self {
            amplitude: [a, a],
            offset: [0.0, 0.0],
            beta: 0.0,
            bits: spec.adc.bits,
        }
    }

    pub(crate) fn miscalibrated(spec: &Spec) -> Self {
        let a = spec.sensor.amplitude / spec.adc.full_scale;
        Self {
            amplitude: [a * 1.08, a * 0.9],
            offset: [0.08 * a, -0.07 * a],
            beta: 4f64.to_radians(),
            bits: spec.adc.bits,
        }
    }

    pub(crate) fn volts(&self, turns: f64) -> [f64; 2] {
        let alpha = turns * std::f64::consts::TAU;
        [
            self.amplitude[0] * alpha.cos() + self.offset[0],
            self.amplitude[1] * (alpha - self.beta).sin() + self.offset[1],
        ]
    }

    pub(crate) fn codes(&self, turns: f64) -> [i64; 2] {
        let half = (1i64 << (self.bits - 1)) as f64;
        self.volts(turns)
            .map(|v| (v * half).round().clamp(-half, half - 1.0) as i64)
    }
}

/// Difference of two angles in turns, to the nearest turn.
pub(crate) fn wrapped(x: f64) -> f64 {
    x - x.round()
}
