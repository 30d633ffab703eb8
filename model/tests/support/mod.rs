//! Simulated encoders for the tests of the chip.
#![allow(dead_code, reason = "each test binary uses its own part")]

#[path = "../../../designs/shipped.rs"]
pub(crate) mod shipped;

#[allow(unused_imports, reason = "each test binary uses its own part")]
pub(crate) use shipped::optical;

use nonius_model::spec::{Coding, Harmonic, Spec};

/// Equation (4), as fractions of the ADC's range, and the ADC.
pub(crate) struct Encoder {
    pub(crate) amplitude: [f64; 2],
    pub(crate) offset: [f64; 2],
    pub(crate) beta: f64,
    pub(crate) bits: u32,
    /// Those that the design knows of.
    pub(crate) harmonics: Vec<Harmonic>,
}

impl Encoder {
    pub(crate) fn ideal(spec: &Spec) -> Self {
        let a = spec.sensor.amplitude / spec.adc.full_scale;
        Self {
            amplitude: [a, a],
            offset: [0.0, 0.0],
            beta: 0.0,
            bits: spec.adc.bits,
            harmonics: spec.correction.harmonics.clone(),
        }
    }

    pub(crate) fn miscalibrated(spec: &Spec) -> Self {
        let a = spec.sensor.amplitude / spec.adc.full_scale;
        Self {
            amplitude: [a * 1.08, a * 0.9],
            offset: [0.08 * a, -0.07 * a],
            beta: 4f64.to_radians(),
            bits: spec.adc.bits,
            harmonics: spec.correction.harmonics.clone(),
        }
    }

    pub(crate) fn volts(&self, turns: f64) -> [f64; 2] {
        self.volts_of([turns; 2])
    }

    /// Each channel at an angle of its own, as where they are sampled one after the other.
    fn volts_of(&self, turns: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = turns.map(|turns| turns * std::f64::consts::TAU);
        let more = |which: usize, alpha: f64| -> f64 {
            self.harmonics.iter().map(|h| h.at(which, alpha).0).sum()
        };
        [
            self.amplitude[0] * (cos.cos() + more(0, cos)) + self.offset[0],
            self.amplitude[1] * ((sin - self.beta).sin() + more(1, sin)) + self.offset[1],
        ]
    }

    pub(crate) fn codes(&self, turns: f64) -> [i64; 2] {
        self.codes_of([turns; 2])
    }

    /// Each channel at an angle of its own.
    pub(crate) fn codes_of(&self, turns: [f64; 2]) -> [i64; 2] {
        let half = (1i64 << (self.bits - 1)) as f64;
        self.volts_of(turns)
            .map(|v| (v * half).round().clamp(-half, half - 1.0) as i64)
    }
}

/// Difference of two angles in turns, to the nearest turn.
pub(crate) fn wrapped(x: f64) -> f64 {
    x - x.round()
}

/// Codes of a slow sweep of the sensor that the design is for.
pub(crate) fn codes(spec: &Spec) -> impl Fn(u32) -> [i64; 2] {
    let encoder = Encoder::miscalibrated(spec);
    let middle = match spec.adc.coding {
        Coding::OffsetBinary => 1i64 << (spec.adc.bits - 1),
        Coding::TwosComplement => 0,
    };
    move |k| {
        encoder
            .codes(0.0173 * f64::from(k))
            .map(|code| code + middle)
    }
}
