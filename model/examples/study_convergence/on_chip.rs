//! The bit-true chips of the comparison.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::physical::{self, Converter};
use nonius_model::reference::{Parameters, Theta};
use nonius_model::spec::Spec;

use super::method::Said;
use super::shipped::variants::{radius_alone_of, searches_of};

/// The bit-true chip of a design.
pub(crate) struct OnChip {
    pub(crate) design: Design,
    chip: Chip<Bits>,
    converter: Converter,
}

/// Every calibration that a chip of this design can be built with.
pub(crate) fn all(base: &Spec) -> impl Iterator<Item = (String, OnChip)> {
    let chips = [searches_of(base), radius_alone_of(base)].into_iter();
    chips.flatten().map(|variant| {
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
            set: if bent {
                Parameters::SplitNine
            } else {
                Parameters::Five
            },
            theta,
        };
        let [cos, sin] = y.map(|y| self.converter.code(middle + amplitude * y));
        self.chip.step_codes(cos, sin, false, true);
        said
    }
}
