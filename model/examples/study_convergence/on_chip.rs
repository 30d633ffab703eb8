//! The bit-true chips of the comparison.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::physical::{self, Converter};
use nonius_model::reference::{Parameters, Sensor, Theta};
use nonius_model::spec::Spec;

use super::method::{Correction, Said};
use super::shipped::variants::searches_of;

/// The bit-true chip of a design.
pub(crate) struct OnChip {
    pub(crate) design: Design,
    chip: Chip<Bits>,
    converter: Converter,
}

/// Every calibration that a chip of this design can be built with.
pub(crate) fn all(base: &Spec) -> impl Iterator<Item = (String, OnChip)> {
    searches_of(base).into_iter().map(|variant| {
        let set = match variant.spec.calibration.parameters {
            4 => "four",
            5 => "five",
            8 => "eight",
            _ => "nine",
        };
        let chip = OnChip::of(variant.design());
        (format!("chip, {}, {set}", variant.what), chip)
    })
}

impl OnChip {
    pub(crate) fn of(design: Design) -> Self {
        Self {
            chip: Chip::bit_true(&design),
            converter: Converter::of(&design.spec),
            design,
        }
    }

    /// Takes one sample; the amplitude of y is 1.
    pub(crate) fn step(&mut self, y: [f64; 2]) -> Said {
        let spec = &self.design.spec;
        let (middle, amplitude) = (spec.adc.middle, spec.sensor.amplitude);
        let bent = spec.calibration.has_bend();
        // For signals of amplitude 1 about 0, from those in volts.
        let [one, two, three, four, five, bends @ ..] = physical::theta(spec, self.chip.theta());
        let (cross, shift) = if bent {
            (five, three)
        } else {
            (five * amplitude, three + five)
        };
        let linear = [
            one * amplitude,
            two + one * middle,
            three * amplitude,
            four + shift * middle,
            cross,
        ];
        let mut theta = Theta::zeros();
        for (to, from) in theta.iter_mut().zip(linear.into_iter().chain(bends)) {
            *to = from;
        }
        let said = Said {
            alpha_hat: self.chip.position() * TAU,
            correction: if bent {
                Correction::Bent
            } else {
                Correction::Paper(Parameters::Five)
            },
            theta,
        };
        let [cos, sin] = y.map(|y| self.converter.code(middle + amplitude * y));
        self.chip.step_codes(cos, sin, false, true);
        said
    }
}

/// The chip's nine parameters for a sensor without bends: gain and offset of each channel, then s = s' + tan β c.
pub(crate) fn bent_theta(sensor: &Sensor) -> Theta {
    let (gain_c, gain_s) = (1.0 / sensor.a_c, 1.0 / (sensor.a_s * sensor.beta.cos()));
    let linear = [
        gain_c,
        -gain_c * sensor.b_c,
        gain_s,
        -gain_s * sensor.b_s,
        sensor.beta.tan(),
    ];
    Theta::from_fn(|i, _| linear.get(i).copied().unwrap_or(0.0))
}

/// The chip's correction with bends, in plain `f64` (see docs/on-line-calibration.md).
pub(crate) fn bent(theta: &Theta, [y_c, y_s]: [f64; 2]) -> [f64; 2] {
    let (u, v) = (theta[0] * y_c + theta[1], theta[2] * y_s + theta[3]);
    let second = |u: f64| 2.0 * u * u - 1.0;
    let third = |u: f64| 4.0 * u * u * u - 3.0 * u;
    let c = u + theta[5] * second(u) + theta[7] * third(u) + theta[8] * (third(u) - u);
    let s = v + theta[6] * second(v) + theta[7] * third(v) - theta[8] * (third(v) - v);
    [c, s + theta[4] * c]
}
