//! What `nonius simulate` steps through a recording: the bit-true chip, or the paper.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use anyhow::Result;
use nonius_model::bits::Bits;
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::physical::{Converter, theta};
use nonius_testvectors::waves::Waves;

use crate::paper::Paper;
use crate::play;
use crate::target::Target;

/// What a simulated interpolator says before it sees a sample.
pub(crate) struct Estimate {
    /// Whole periods and fraction, written with every bit.
    pub(crate) position: String,
    pub(crate) speed_per_sample: f64,
    pub(crate) locked: bool,
    pub(crate) theta: Vec<f64>,
}

/// A bit-true chip, or the paper.
pub(crate) trait Interpolator {
    fn estimate(&self) -> Estimate;
    fn step(&mut self, cos: f64, sin: f64) -> Result<()>;
    fn finish(self: Box<Self>) -> Result<()>;
}

/// The chip, and where its waves go.
pub(crate) struct BitTrue<'a> {
    waves: Option<(Waves<BufWriter<File>>, Target)>,
    design: &'a Design,
    chip: Chip<Bits>,
    converter: Converter,
    speed: f64,
}

impl<'a> BitTrue<'a> {
    /// After reset; its waves go into the file `vcd`.
    pub(crate) fn of(design: &'a Design, vcd: Option<&Path>) -> Result<Self> {
        Ok(Self {
            waves: vcd.map(|path| waves(design, path)).transpose()?,
            design,
            chip: Chip::bit_true(design),
            converter: Converter::of(&design.spec),
            speed: 0.0,
        })
    }
}

impl Interpolator for BitTrue<'_> {
    fn estimate(&self) -> Estimate {
        Estimate {
            position: exact(
                self.chip.position_raw(),
                self.design.structure.formats.alpha.format.fraction,
            ),
            speed_per_sample: self.speed,
            locked: self.chip.state.locked,
            theta: {
                let all = theta(&self.design.spec, self.chip.theta());
                let numbers = self.design.spec.calibration.thetas();
                numbers.iter().map(|i| all[i - 1]).collect()
            },
        }
    }

    fn step(&mut self, cos: f64, sin: f64) -> Result<()> {
        let sample = play::sample(&self.converter, cos, sin);
        let probes = self
            .chip
            .step_codes(sample.cos, sample.sin, sample.preset, sample.calibrate);
        self.speed = probes.speed.to_f64();
        if let Some((waves, _)) = &mut self.waves {
            waves.sample(&sample, &probes, &self.chip)?;
        }
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<()> {
        let Some((waves, target)) = self.waves else {
            return Ok(());
        };
        waves.finish()?;
        target.keep()
    }
}

/// The paper in `f64`.
pub(crate) struct InFloatingPoint {
    paper: Paper,
    parameters: usize,
}

impl InFloatingPoint {
    /// After reset.
    pub(crate) fn of(design: &Design) -> Result<Self> {
        Ok(Self {
            paper: Paper::of(design)?,
            parameters: design.spec.calibration.thetas().len(),
        })
    }
}

impl Interpolator for InFloatingPoint {
    fn estimate(&self) -> Estimate {
        let (known, step) = self.paper.expected();
        Estimate {
            position: format!("{}", known.periods()),
            speed_per_sample: step / std::f64::consts::TAU,
            locked: known.locked,
            theta: self.paper.theta(self.parameters),
        }
    }

    fn step(&mut self, cos: f64, sin: f64) -> Result<()> {
        self.paper.step(cos, sin);
        Ok(())
    }

    fn finish(self: Box<Self>) -> Result<()> {
        Ok(())
    }
}

/// An integer in units of 2^-`fraction`, as a decimal number with every digit it has.
fn exact(raw: i128, fraction: u32) -> String {
    let magnitude = raw.unsigned_abs();
    let below = magnitude & ((1u128 << fraction) - 1);
    // Fraction bits fit an f64, and a binary fraction of n bits has n decimals.
    let digits = format!(
        "{:.*}",
        fraction as usize,
        below as f64 / 2f64.powi(fraction as i32)
    );
    let decimals = digits.trim_start_matches('0').trim_end_matches('0');
    let sign = if raw < 0 { "-" } else { "" };
    let decimals = if decimals == "." { ".0" } else { decimals };
    format!("{sign}{}{decimals}", magnitude >> fraction)
}

/// Waves of the chip into a file.
fn waves(design: &Design, path: &Path) -> Result<(Waves<BufWriter<File>>, Target)> {
    let target = Target::new(path)?;
    let file = target.file().try_clone()?;
    let chip = nonius_codegen::generate(design, &nonius_codegen::hash(design), &[])?;
    let waves = Waves::new(BufWriter::new(file), design, &chip.columns, chip.clocks)?;
    Ok((waves, target))
}

#[cfg(test)]
mod tests {
    use super::exact;

    #[test]
    fn positions_are_written_with_every_bit() {
        assert_eq!(exact(0, 4), "0.0");
        assert_eq!(exact(1, 4), "0.0625");
        assert_eq!(exact(-1, 4), "-0.0625");
        assert_eq!(exact(16 * 7 + 8, 4), "7.5");
        assert_eq!(exact(-(16 * 7 + 8), 4), "-7.5");
        assert_eq!(exact(-16, 4), "-1.0");
    }

    proptest::proptest! {
        #[test]
        fn written_positions_are_exact(raw in -(1i128 << 52)..(1i128 << 52), fraction in 0u32..44) {
            let written: f64 = exact(raw, fraction).parse().expect("a number");
            proptest::prop_assert_eq!(written, raw as f64 / 2f64.powi(fraction as i32));
        }
    }
}
