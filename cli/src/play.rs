//! A recording, measured or simulated, played into a chip of a design.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use nonius_model::physical::Converter;
use nonius_model::spec::Spec;
use nonius_recording::{Adc, AdcPair, AdcSource, Overrides, Recording, Survey};
use nonius_sensor::{Grid, Motion, Sensor};
use nonius_testvectors::stimulus::{Sample, Stimulus};

/// Largest jump, in periods, from the end of a repeated recording to its beginning, beyond the usual step.
const JOINT: f64 = 0.1;

/// Noise of a simulated sensor: always the same, so that a build is.
const SEED: u64 = 1;

/// The recording in a file, or what the sensor in another shows when it is moved as that one says; and the name of the file.
///
/// # Errors
/// Neither is given, or the file is not what it should be.
pub(crate) fn source(
    recording: Option<&Path>,
    sensor: Option<&Path>,
    overrides: &Overrides,
) -> Result<(Recording, PathBuf)> {
    match (recording, sensor) {
        (Some(path), _) => Ok((Recording::read(path, overrides)?, path.into())),
        (None, Some(path)) => Ok((simulated(path)?, path.into())),
        (None, None) => bail!("give a recording (CSV), or a sensor with --sensor SENSOR.toml"),
    }
}

/// The sensor in a file, and the file that it is moved along, if it names one.
///
/// # Errors
/// The file is not what it should be.
pub(crate) fn sensor(path: &Path) -> Result<(Sensor, Option<PathBuf>)> {
    let (text, file) = text(path)?;
    let sensor = Sensor::from_toml(&text, &file)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let along = sensor.motion.file.as_ref().map(|named| folder.join(named));
    Ok((sensor, along))
}

fn simulated(path: &Path) -> Result<Recording> {
    let (sensor, along) = sensor(path)?;
    let motion = match along {
        None => Motion::to_and_fro(&sensor),
        Some(along) => moved(&sensor, &along).with_context(|| {
            format!(
                "{}: motion.file: without that line the sensor is moved to and fro",
                path.display()
            )
        })?,
    };
    let samples = sensor.simulate(&motion, SEED);
    let overrides = Overrides {
        adc_bits: Some(sensor.adc.bits),
        periods_per_revolution: sensor.motion.periods_per_revolution,
        ..Overrides::default()
    };
    let mut recording =
        Recording::from_samples(samples.time_s, samples.cos, samples.sin, &overrides)
            .with_context(|| format!("{} makes no recording", path.display()))?;
    // The ADC is known: what the reader sees of it in the samples, and notes, is less.
    let [cos, sin] = [0, 1].map(|which| {
        let Grid { lsb, centre } = sensor.adc.grid(which);
        Adc {
            bits: sensor.adc.bits,
            lsb,
            centre,
            source: AdcSource::Described,
        }
    });
    recording.metadata.adc = AdcPair { cos, sin };
    recording.notes.clear();
    Ok(recording)
}

/// What stands in a file, and its name for messages.
fn text(path: &Path) -> Result<(String, String)> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {file}"))?;
    Ok((text, file))
}

/// The motion in a file.
fn moved(sensor: &Sensor, along: &Path) -> Result<Motion> {
    let (text, file) = text(along)?;
    Ok(Motion::along(sensor, &text, &file)?)
}

/// Says what the reader noticed and where recording and design do not fit each other.
///
/// # Errors
/// A recording to be repeated does not begin where it ends.
pub(crate) fn check(spec: &Spec, recording: &Recording, path: &Path, repeat: u32) -> Result<()> {
    crate::notes(&recording.notes);
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
pub fn stimulus(name: &str, spec: &Spec, recording: &Recording, repeat: u32) -> Stimulus {
    let converter = Converter::of(spec);
    let once = || recording.cos.iter().zip(&recording.sin);
    let samples = (0..repeat).flat_map(|_| once().map(|(c, s)| sample(&converter, *c, *s)));
    Stimulus {
        name: name.into(),
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
pub(crate) fn compare(spec: &Spec, recording: &Recording) {
    /// Share of the ADC's range below which the signals are those of another unit.
    const SMALL: f64 = 0.1;
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
    let adc = &spec.adc;
    let of_range = |v: &f64| (v - adc.middle).abs() / adc.full_scale;
    let both = recording.cos.iter().chain(&recording.sin);
    let most = both.map(of_range).fold(0.0, f64::max);
    let range = format!(
        "the design's ADC range {} … {}",
        adc.middle - adc.full_scale,
        adc.middle + adc.full_scale
    );
    let fits = "`nonius new NAME --from RECORDING.csv` fits a range";
    if clipped > 0 {
        let samples = recording.samples();
        eprintln!(
            "note: {clipped} of {samples} samples lie outside {range} and are held at its ends; {fits}"
        );
    } else if most < SMALL {
        let share = 100.0 * most;
        eprintln!("note: the signals take {share:.1} % of {range}: are they in its unit? {fits}");
    }
}
