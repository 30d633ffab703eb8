//! `nonius calibrate`: off-line calibration of a recording.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use nonius_calibration::{Calibration, Method, Options, Parameter, calibrate};
use nonius_recording::Recording;
use serde::Serialize;

use crate::recording_args::RecordingArgs;

/// What to calibrate.
#[derive(Args)]
pub(crate) struct Calibrate {
    /// The recording (CSV).
    recording: PathBuf,
    /// The estimator.
    #[arg(long, value_enum, default_value_t = Estimator::Unbiased)]
    method: Estimator,
    /// Noise of the sine channel over that of the cosine channel; estimated if not given (`unbiased` only).
    #[arg(long, value_name = "RATIO")]
    noise_ratio: Option<f64>,
    /// Prints the result for programs.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    recording_args: RecordingArgs,
}

/// The estimators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Estimator {
    /// Geometric fit less its curvature bias: no bias by noise, error bars to be trusted.
    Unbiased,
    /// Heydemann's least squares, equation (5), solved in closed form.
    Heydemann,
    /// Extremes of the two signals: the baseline.
    Extremes,
    /// Gradient search of section 5.2: offsets and gains.
    Sumsq4,
    /// Gradient search of section 5.3: and the phase.
    Sumsq5,
    /// Gradient search of section 5.4: a cubic per channel.
    Poly8,
    /// And the phase.
    Poly9,
}

impl Estimator {
    fn method(self) -> Method {
        match self {
            Self::Unbiased => Method::Unbiased,
            Self::Heydemann => Method::Heydemann,
            Self::Extremes => Method::Extremes,
            Self::Sumsq4 => Method::Sumsq4,
            Self::Sumsq5 => Method::Sumsq5,
            Self::Poly8 => Method::Poly8,
            Self::Poly9 => Method::Poly9,
        }
    }
}

#[derive(Serialize)]
struct Json<'a> {
    schema: &'static str,
    method: Method,
    samples: usize,
    residual_rms: f64,
    parameters: &'a [Parameter],
    cannot_tell: &'a [String],
}

pub(crate) fn run(args: &Calibrate) -> Result<()> {
    if let Some(ratio) = args.noise_ratio
        && !(ratio.is_finite() && (0.01..=100.0).contains(&ratio))
    {
        bail!(
            "--noise-ratio {ratio}: expected 0.01 to 100, the sine channel's noise over the cosine's"
        );
    }
    let recording = Recording::read(&args.recording, &args.recording_args.overrides())?;
    for note in &recording.notes {
        eprintln!("note: {note}");
    }
    let options = Options {
        noise_ratio: args.noise_ratio,
    };
    let found = calibrate(
        &recording.cos,
        &recording.sin,
        args.method.method(),
        &options,
    )
    .map_err(|error| anyhow::anyhow!("{}: {error}", args.recording.display()))?;
    if args.json {
        let json = Json {
            schema: "nonius.calibration/1",
            method: found.method,
            samples: found.samples,
            residual_rms: found.residual_rms,
            parameters: &found.parameters,
            cannot_tell: &found.cannot_tell,
        };
        println!("{}", serde_json::to_string_pretty(&json)?);
    } else {
        print(&found);
    }
    Ok(())
}

fn print(found: &Calibration) {
    println!("[[Statistics]]");
    println!("    method             = {:?}", found.method);
    println!("    samples            = {}", found.samples);
    println!(
        "    residual rms       = {:.4e} of the amplitude",
        found.residual_rms
    );
    println!(
        "    noise              = {:.4e} (cos), {:.4e} (sin), in the unit of the columns",
        found.noise[0], found.noise[1]
    );
    if let Some(angle) = found.angle_bound {
        println!("    bound of the angle = {angle:.2e} rad rms, from the uncertain parameters");
    }
    println!("[[Parameters]]");
    for (i, p) in found.parameters.iter().enumerate() {
        let error = match p.std_error {
            Some(e) if p.value != 0.0 => {
                format!("+/- {e:.3e} ({:.3} %)", (e / p.value).abs() * 100.0)
            }
            Some(e) => format!("+/- {e:.3e}"),
            None => "+/- not known".into(),
        };
        let bound = match (&found.bound, i < 5) {
            (Some(bound), true) => format!("   bound {:.3e}", bound[i]),
            _ => String::new(),
        };
        let unit = if p.unit == "column" || p.unit == "1" {
            ""
        } else {
            &p.unit
        };
        println!(
            "    {:<8} {:>14.8} {error:<28}{bound}  {unit}",
            p.name, p.value
        );
        if i == 4 {
            println!("    {:<8} {:>14.6} deg", "", p.value.to_degrees());
        }
    }
    if let Some(correlations) = &found.correlations {
        println!("[[Correlations]] (beyond 0.1)");
        let mut pairs = vec![];
        for (i, row) in correlations.iter().enumerate() {
            pairs.extend(
                row.iter()
                    .take(i)
                    .enumerate()
                    .map(|(j, value)| (*value, j, i)),
            );
        }
        pairs.retain(|p| p.0.is_finite() && p.0.abs() > 0.1);
        pairs.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
        for (value, i, j) in pairs {
            let name = |k: usize| &found.parameters[k].name;
            println!("    C({}, {}) = {value:+.3}", name(i), name(j));
        }
    }
    if !found.cannot_tell.is_empty() {
        println!("[[What the data cannot tell]]");
        for sentence in &found.cannot_tell {
            println!("    {sentence}");
        }
    }
}
