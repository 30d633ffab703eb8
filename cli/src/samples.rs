//! What a simulated sensor says, as a recording to be read again.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use nonius_recording::Recording;

use crate::target::Target;

/// Writes a recording of one ADC, which is to be kept yet.
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
    writeln!(out, "# adc_min: {}", adc.centre - half)?;
    writeln!(out, "# adc_max: {}", adc.centre + half)?;
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
