//! An ADC as the recording shows it: codes and the values they stand for.

use serde::Serialize;

/// Where the description of an ADC comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AdcSource {
    /// From the recording's own lines or the command line.
    Described,
    /// From the steps between the values, wholly or in part.
    Estimated,
    /// The values show no steps: an ADC fine enough was assumed.
    Assumed,
}

/// One channel's converter. Values are in the unit of the columns (volts or counts).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Adc {
    /// Number of bits, 2 to 32.
    pub bits: u32,
    /// Step from one code to the next, above 0.
    pub lsb: f64,
    /// Value of the code 0, the middle of the range.
    pub centre: f64,
    /// Where this description comes from.
    pub source: AdcSource,
}

impl Adc {
    /// The signed code about mid-scale for a value: the nearest one, clamped to
    /// −2^(bits−1) … 2^(bits−1) − 1.
    #[must_use]
    pub fn code(&self, value: f64) -> i64 {
        let (min, max) = self.codes();
        (self.position(value).round() as i64).clamp(min, max)
    }

    /// The value in the middle of a code's step.
    #[must_use]
    pub fn value(&self, code: i64) -> f64 {
        self.centre + code as f64 * self.lsb
    }

    /// The lowest and the highest code.
    #[must_use]
    pub fn codes(&self) -> (i64, i64) {
        let half = 1i64 << (self.bits.clamp(1, 62) - 1);
        (-half, half - 1)
    }

    /// Half the range: the ADC spans centre − full_scale … centre + full_scale.
    #[must_use]
    pub fn full_scale(&self) -> f64 {
        self.lsb * -(self.codes().0 as f64)
    }

    /// True where the value lies clearly beyond the first or last code's step, by more than the rounding of its text: that step is half a
    /// code wide on either side.
    #[must_use]
    pub fn clips(&self, value: f64) -> bool {
        let (min, max) = self.codes();
        let position = self.position(value);
        position < min as f64 - 0.75 || position > max as f64 + 0.75
    }

    fn position(&self, value: f64) -> f64 {
        (value - self.centre) / self.lsb
    }
}

/// The converters of the two channels. They have the same number of bits; their steps differ where
/// a recording was scaled per channel before it was written.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AdcPair {
    /// The converter of the cos channel.
    pub cos: Adc,
    /// The converter of the sin channel.
    pub sin: Adc,
}

impl AdcPair {
    /// True where both channels have the same codes, nowhere in the range off each other by more than a small part of one.
    #[must_use]
    pub fn is_one(&self) -> bool {
        /// Of a code: what the rounding of a text makes of one grid in two columns.
        const OFF: f64 = 0.01;
        let Self { cos, sin } = self;
        let at_the_ends = (cos.full_scale() - sin.full_scale()).abs();
        cos.bits == sin.bits && (cos.centre - sin.centre).abs() + at_the_ends < OFF * cos.lsb
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_and_values_are_inverse_and_clamped() {
        let adc = Adc {
            bits: 12,
            lsb: 0.25,
            centre: 3.0,
            source: AdcSource::Described,
        };
        for code in [-2048, -1, 0, 1, 2047] {
            assert_eq!(adc.code(adc.value(code)), code);
        }
        assert_eq!(adc.code(1e30), 2047);
        assert_eq!(adc.code(-1e30), -2048);
        assert_eq!(adc.full_scale(), 512.0);
        assert!(adc.clips(600.0) && !adc.clips(500.0));
    }
}
