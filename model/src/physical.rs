//! The edge of the chip: volts, metres and the paper's parameters, where inside there are codes, turns and fractions.

use std::f64::consts::TAU;

use crate::spec::{Coding, Spec};

/// The design's ADC: values in the unit of its range become codes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Converter {
    half: f64,
    full_scale: f64,
    middle: f64,
    first: i64,
}

impl Converter {
    /// The ADC of a design.
    #[must_use]
    pub fn of(spec: &Spec) -> Self {
        let half = 2f64.powi(spec.adc.bits as i32 - 1);
        Self {
            half,
            full_scale: spec.adc.full_scale,
            middle: spec.adc.middle,
            first: match spec.adc.coding {
                Coding::TwosComplement => -(half as i64),
                Coding::OffsetBinary => 0,
            },
        }
    }

    /// The code of a value in the unit of `adc.full_scale`: rounded to the nearest, held at the ends of the range.
    #[must_use]
    pub fn code(&self, value: f64) -> i64 {
        let steps = ((value - self.middle) / self.full_scale * self.half).round();
        let held = steps.clamp(-self.half, self.half - 1.0) as i64;
        held + self.half as i64 + self.first
    }

    /// Whether the value is beyond the range by more than half a step.
    #[must_use]
    pub fn clips(&self, value: f64) -> bool {
        let steps = ((value - self.middle) / self.full_scale * self.half).round();
        !(-self.half..self.half).contains(&steps)
    }
}

/// The chip's parameters as those of section 5.3, for signals in the unit of `adc.full_scale`:
/// cos α = θ1 y_c + θ2, sin α = θ3 y_s + θ4 + θ5 y_c. Gains in 1/unit, offsets without unit. With 8 and 9 parameters θ5
/// acts on the corrected cosine and θ6 … θ9 are bends (see the kernel `bend`), all without unit.
#[must_use]
pub fn theta(spec: &Spec, normalised: [f64; 9]) -> [f64; 9] {
    let power = 2f64.powi(crate::design::normalisation(spec).1 as i32);
    // y = (value − middle) · scale is what the chip multiplies.
    let scale = power / spec.adc.full_scale;
    let middle = spec.adc.middle;
    let [one, two, three, four, five, bends @ ..] = normalised;
    let (gain_c, gain_s) = (one * scale, three * scale);
    // With bends the phase acts on the corrected cosine, which has no unit.
    let bent = spec.calibration.has_bend();
    let (cross, shift) = if bent {
        (five, gain_s)
    } else {
        (five * scale, gain_s + five * scale)
    };
    let [six, seven, eight, nine] = bends;
    [
        gain_c,
        two - gain_c * middle,
        gain_s,
        four - shift * middle,
        cross,
        six,
        seven,
        eight,
        nine,
    ]
}

/// Equation (1): displacement in metres of an angle in scale periods, where the design says how long one is.
#[must_use]
pub fn metres(spec: &Spec, periods: f64) -> Option<f64> {
    spec.sensor.scale_period_m.map(|length| periods * length)
}

/// Angle of the revolution in radians of an angle in scale periods, where the design says how many make a turn.
#[must_use]
pub fn radians_of_revolution(spec: &Spec, periods: f64) -> Option<f64> {
    let per_revolution = spec.sensor.periods_per_revolution;
    per_revolution.map(|n| periods * TAU / n)
}
