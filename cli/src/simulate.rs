//! `nonius simulate`: the chip over a recording.

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use nonius_model::physical::{metres, radians_of_revolution};
use nonius_model::spec::Spec;
use nonius_quantity::times;
use nonius_recording::Recording;

use crate::interpolator::{BitTrue, InFloatingPoint, Interpolator};
use crate::play;
use crate::recording_args::RecordingArgs;
use crate::samples;
use crate::target::Target;

/// What to simulate.
#[derive(Args)]
pub(crate) struct Simulate {
    /// The design.
    design: PathBuf,
    /// The recording (CSV).
    #[arg(required_unless_present = "sensor", conflicts_with = "sensor")]
    recording: Option<PathBuf>,
    /// A simulated sensor (sensor.toml of `nonius diagnose`) in place of a recording: along the motion that its motion.file holds,
    /// that of the recording; to and fro where it names none.
    #[arg(long, value_name = "SENSOR")]
    sensor: Option<PathBuf>,
    /// File to write (CSV): time_s, position_periods, speed_periods_per_s, locked, theta_1, …
    #[arg(short)]
    output: PathBuf,
    /// Also writes what the simulated sensor's ADC says, as a recording (CSV): time_s, cos, sin.
    #[arg(
        long,
        value_name = "FILE",
        requires = "sensor",
        conflicts_with = "recording"
    )]
    samples: Option<PathBuf>,
    /// Also writes the waves of the bit-true chip (VCD), with the signal names of its Verilog.
    #[arg(long, value_name = "FILE", conflicts_with = "reference")]
    vcd: Option<PathBuf>,
    /// The paper in floating point instead of the bit-true chip. It counts periods from where its own loop begins, which may be one
    /// before or behind the chip's.
    #[arg(long)]
    reference: bool,
    /// Plays a recording of whole turns so many times.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    repeat: u32,
    /// Adds position_m or position_rad (radians of the revolution), equation (1), as the design gives scale_period_m or
    /// periods_per_revolution.
    #[arg(long)]
    physical: bool,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

pub(crate) fn run(args: &Simulate) -> Result<()> {
    apart(args)?;
    let (design, text) = crate::design_file::read(&args.design)?;
    let spec = &design.spec;
    let (recording, path) = play::source(
        args.recording.as_deref(),
        args.sensor.as_deref(),
        &args.recording_args.overrides(),
    )?;
    play::check(spec, &recording, &path, args.repeat)?;
    let thetas = spec.calibration.thetas();
    let mut interpolator: Box<dyn Interpolator> = if args.reference {
        Box::new(InFloatingPoint::of(&design)?)
    } else {
        Box::new(BitTrue::of(&design, args.vcd.as_deref())?)
    };
    let units = if args.physical {
        units(
            spec,
            &crate::design_file::place(&args.design, &text, "sensor"),
        )?
    } else {
        vec![]
    };
    let samples = args.samples.as_deref();
    let samples = samples
        .map(|path| samples::write(path, &recording))
        .transpose()?;
    let target = Target::new(&args.output)?;
    let lost = write(
        &target,
        interpolator.as_mut(),
        &recording,
        args.repeat,
        thetas,
        &units,
    )
    .with_context(|| format!("cannot write {}", args.output.display()))?;
    interpolator.finish()?;
    target.keep()?;
    if let Some(samples) = samples {
        samples.keep()?;
    }
    if let Some(first) = lost.first() {
        eprintln!(
            "note: lock is lost {}, first at {first} s: the position may have lost periods there",
            times(lost.len())
        );
    }
    Ok(())
}

/// Where a path leads to. A file or a folder that is not there yet is known by the folder that it will be in.
fn real(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| {
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
        let folder = match folder {
            Some(folder) => real(folder),
            None if path.is_absolute() => return path.to_owned(),
            None => Path::new(".").canonicalize().unwrap_or_default(),
        };
        folder.join(path.file_name().unwrap_or_default())
    })
}

/// What is read is not written over, and no file is written twice.
fn apart(args: &Simulate) -> Result<()> {
    let sensor = args.sensor.as_deref().map(play::sensor).transpose()?;
    let motion = sensor.and_then(|(_, motion)| motion);
    let read = [
        Some(&args.design),
        args.recording.as_ref(),
        args.sensor.as_ref(),
        motion.as_ref(),
    ];
    let written = [Some(&args.output), args.vcd.as_ref(), args.samples.as_ref()];
    for (i, out) in written.iter().enumerate() {
        let Some(out) = out else { continue };
        let others = read.iter().chain(&written[..i]).flatten();
        for other in others {
            if real(out) == real(other) {
                anyhow::bail!(
                    "{} is {} too; name another file to write",
                    out.display(),
                    other.display()
                );
            }
        }
    }
    Ok(())
}

/// What the position is written in besides periods: column and unit per period, equation (1). `place` is where the design
/// describes its sensor.
fn units(spec: &Spec, place: &str) -> Result<Vec<(&'static str, f64)>> {
    let known = [
        ("position_m", metres(spec, 1.0)),
        ("position_rad", radians_of_revolution(spec, 1.0)),
    ];
    let units: Vec<_> = known
        .into_iter()
        .filter_map(|(column, unit)| Some((column, unit?)))
        .collect();
    if units.is_empty() {
        anyhow::bail!(
            "{place}: --physical: neither sensor.scale_period_m nor sensor.periods_per_revolution is given; write one of them \
             here, or leave out --physical"
        );
    }
    Ok(units)
}

/// Writes a row for each sample; says when lock was lost, seconds.
fn write(
    target: &Target,
    interpolator: &mut dyn Interpolator,
    recording: &Recording,
    repeat: u32,
    thetas: &[usize],
    units: &[(&str, f64)],
) -> Result<Vec<f64>> {
    let (mut lost, mut locked) = (vec![], false);
    let mut out = BufWriter::with_capacity(1 << 16, target.file());
    write!(out, "time_s,position_periods,speed_periods_per_s,locked")?;
    for i in thetas {
        write!(out, ",theta_{i}")?;
    }
    for (name, _) in units {
        write!(out, ",{name}")?;
    }
    writeln!(out)?;
    let rate = recording.metadata.sample_rate_hz;
    let first = recording.time_s.first().copied().unwrap_or_default();
    let last = recording.time_s.last().copied().unwrap_or_default();
    let turn = last - first + 1.0 / rate;
    let samples = recording.samples() as u64;
    let bar = ProgressBar::new(samples * u64::from(repeat));
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} samples, {eta} left") {
        bar.set_style(style);
    }
    for round in 0..repeat {
        for k in 0..recording.samples() {
            let now = interpolator.estimate();
            let time = recording.time_s[k] + f64::from(round) * turn;
            if locked && !now.locked {
                lost.push(time);
            }
            locked = now.locked;
            write!(
                out,
                "{time:.9},{},{},{}",
                now.position,
                now.speed_per_sample * rate,
                u8::from(now.locked)
            )?;
            for theta in &now.theta {
                write!(out, ",{theta}")?;
            }
            for (_, unit) in units {
                let periods: f64 = now.position.parse().context("a position is a number")?;
                write!(out, ",{}", periods * unit)?;
            }
            writeln!(out)?;
            interpolator.step(recording.cos[k], recording.sin[k])?;
            if k & 0xfff == 0 {
                bar.set_position(u64::from(round) * samples + k as u64);
            }
        }
    }
    bar.finish_and_clear();
    out.flush()?;
    Ok(lost)
}
