//! A recording played into a chip of a design.

use std::path::Path;

use anyhow::{Result, bail};
use nonius_model::physical::Converter;
use nonius_model::spec::Spec;
use nonius_recording::{Recording, Survey};
use nonius_testvectors::stimulus::{Sample, Stimulus};

/// Largest jump, in periods, from the end of a repeated recording to its beginning, beyond the usual step.
const JOINT: f64 = 0.1;

/// Says what the reader noticed and where recording and design do not fit each other.
///
/// # Errors
/// A recording to be repeated does not begin where it ends.
pub(crate) fn check(spec: &Spec, recording: &Recording, path: &Path, repeat: u32) -> Result<()> {
    for note in &recording.notes {
        eprintln!("note: {note}");
    }
    if repeat > 1 {
        joins(recording, path)?;
    }
    compare(spec, recording);
    Ok(())
}

/// What the pins see of a pair in the unit of the columns: calibration on, no preset.
pub(crate) fn sample(converter: &Converter, cos: f64, sin: f64) -> Sample {
    Sample {
        cos: converter.code(cos),
        sin: converter.code(sin),
        preset: false,
        calibrate: true,
    }
}

/// The recording, `repeat` times, as a stimulus of the testbench.
#[must_use]
pub fn stimulus(spec: &Spec, recording: &Recording, repeat: u32) -> Stimulus {
    let converter = Converter::of(spec);
    let once = || recording.cos.iter().zip(&recording.sin);
    let samples = (0..repeat).flat_map(|_| once().map(|(c, s)| sample(&converter, *c, *s)));
    Stimulus {
        name: "recording".into(),
        samples: samples.collect(),
    }
}

/// A recording that is to be repeated begins where it ends.
fn joins(recording: &Recording, path: &Path) -> Result<()> {
    let motion = Survey::of(recording).motion;
    let angle = &motion.angle_periods;
    let (Some(first), Some(last)) = (angle.first(), angle.last()) else {
        return Ok(());
    };
    let steps = angle.len().saturating_sub(1).max(1) as f64;
    let usual = (last - first) / steps;
    let jump = first - (last + usual);
    let jump = jump - jump.round();
    if jump.abs() > JOINT {
        bail!(
            "{}: --repeat needs a recording of whole turns; its end and its beginning are {:.3} of a scale period \
             apart. Cut it to whole scale periods, or play it once.",
            path.display(),
            jump.abs()
        );
    }
    Ok(())
}

/// Says where recording and design do not fit each other.
fn compare(spec: &Spec, recording: &Recording) {
    let (designed, recorded) = (spec.adc.sample_rate_hz, recording.metadata.sample_rate_hz);
    if (recorded / designed - 1.0).abs() > 0.01 {
        eprintln!(
            "note: the design samples at {designed} Hz, the recording at {recorded:.6} Hz; the chip counts samples, so \
             its bandwidth is {:.4} times the designed one here",
            recorded / designed
        );
    }
    let converter = Converter::of(spec);
    let pairs = recording.cos.iter().zip(&recording.sin);
    let clipped = pairs
        .filter(|(c, s)| converter.clips(**c) || converter.clips(**s))
        .count();
    if clipped > 0 {
        eprintln!(
            "note: {clipped} of {} samples lie outside the design's ADC range {} … {} and are held at its ends; \
             `nonius new NAME --from RECORDING.csv` fits a range",
            recording.samples(),
            spec.adc.middle - spec.adc.full_scale,
            spec.adc.middle + spec.adc.full_scale
        );
    }
}
