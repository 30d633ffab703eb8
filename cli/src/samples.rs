//! What a simulated sensor says, as a recording to be read again.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use nonius_recording::Recording;

use crate::target::Target;

/// Writes a recording, which is to be kept yet, with its ADC where both channels have the same.
///
/// # Errors
/// There is no writing there.
pub(crate) fn write(path: &Path, recording: &Recording) -> Result<Target> {
    let target = Target::new(path)?;
    rows(recording, BufWriter::new(target.file()))
        .with_context(|| format!("cannot write {}", path.display()))?;
    Ok(target)
}

fn rows(recording: &Recording, mut out: impl Write) -> io::Result<()> {
    let about = &recording.metadata;
    let adc = about.adc.cos;
    let half = adc.full_scale();
    writeln!(out, "# sample_rate_hz: {}", about.sample_rate_hz)?;
    writeln!(out, "# adc_bits: {}", adc.bits)?;
    // A range is one of both channels: codes of two sizes are read off the values.
    if about.adc.is_one() {
        writeln!(out, "# adc_min: {}", adc.centre - half)?;
        writeln!(out, "# adc_max: {}", adc.centre + half)?;
    }
    if let Some(periods) = about.periods_per_revolution {
        writeln!(out, "# periods_per_revolution: {periods}")?;
    }
    writeln!(out, "time_s,cos,sin")?;
    for ((time, cos), sin) in recording
        .time_s
        .iter()
        .zip(&recording.cos)
        .zip(&recording.sin)
    {
        writeln!(out, "{time},{cos},{sin}")?;
    }
    out.flush()
}

#[cfg(test)]
mod tests {
    use nonius_recording::{Overrides, Recording};

    use super::rows;

    /// What is written is read with the codes that it was written with, be they those of both channels or of each.
    #[test]
    fn the_codes_of_either_channel_are_read_again() {
        for of_sin in [1.0, 0.73] {
            let code = |k: i32, by: f64| {
                by * f64::from((500.0 * (0.1 * f64::from(k)).cos()).round() as i32)
            };
            let time = (0..4000).map(|k| f64::from(k) * 1e-4).collect();
            let cos = (0..4000).map(|k| code(k, 0.01)).collect();
            let sin = (0..4000).map(|k| code(k + 16, 0.01 * of_sin)).collect();
            let overrides = Overrides {
                adc_bits: Some(10),
                ..Overrides::default()
            };
            let written = Recording::from_samples(time, cos, sin, &overrides).expect("a recording");
            let mut text = vec![];
            rows(&written, &mut text).expect("a text");
            let read = Recording::read_from(text.as_slice(), "again", &Overrides::default());
            let read = read.expect("a recording").metadata.adc;
            for (adc, lsb) in [(read.cos, 0.01), (read.sin, 0.01 * of_sin)] {
                assert_eq!(adc.bits, 10);
                assert!((adc.lsb / lsb - 1.0).abs() < 1e-6, "{adc:?}, {lsb}");
            }
        }
    }
}
