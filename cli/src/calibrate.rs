//! `nonius calibrate`: off-line calibration of a recording.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::{Args, ValueEnum};
use nonius_calibration::{
    Calibration, Correlations, Method, Options, Parameter, RatioSource, calibrate, report,
    undetermined,
};
use nonius_recording::{AdcSource, Recording};
use serde::Serialize;

use crate::progress::Busy;
use crate::recording_args::RecordingArgs;

/// What to calibrate.
#[derive(Args)]
pub(crate) struct Calibrate {
    /// The recording (CSV).
    recording: PathBuf,
    /// The estimator.
    #[arg(long, value_enum, default_value_t = Estimator::Unbiased)]
    method: Estimator,
    /// Noise of the sine channel over that of the cosine channel; estimated if not given. `unbiased` weighs the channels by it,
    /// and the bound beside every method is made of it.
    #[arg(long, value_name = "RATIO", allow_negative_numbers = true)]
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
    /// Of them, far off the curve and left out.
    left_out: usize,
    /// Share of the scale period in which there are samples.
    arc: f64,
    residual_rms: f64,
    /// What repeats with the angle and is no ellipse; null where none is seen.
    distortion: Option<Distortion>,
    /// Of the channels, white, in the unit of the columns; null where it cannot be told.
    noise: Option<Noise>,
    parameters: &'a [Parameter],
    /// Of the physical parameters and of Θ.
    correlations: Vec<Correlated<'a>>,
    /// What no unbiased estimator can beat; that of each parameter stands beside it.
    bound: Option<OfAngle>,
    cannot_tell: &'a [String],
    remarks: &'a [String],
}

#[derive(Serialize)]
struct Distortion {
    /// Of the radius, in fractions of the amplitude.
    rms: f64,
    /// The largest, in cycles per scale period.
    order: usize,
}

#[derive(Serialize)]
struct Noise {
    cos_rms: f64,
    sin_rms: f64,
    /// Of the sine over that of the cosine.
    ratio: f64,
    /// Where the ratio is from.
    ratio_source: RatioSource,
    /// Null where the ratio was given, assumed, or further from 1 than the samples can tell.
    ratio_std_error: Option<f64>,
    /// Of the channels' noise with each other; null where none is seen.
    correlation: Option<f64>,
    correlation_std_error: Option<f64>,
}

/// Rows and columns are the parameters of these names; null with one whose error cannot be told, or which is held.
#[derive(Serialize)]
struct Correlated<'a> {
    names: Vec<&'a str>,
    matrix: &'a Correlations,
}

/// Rms over the period, radians.
#[derive(Serialize)]
struct OfAngle {
    by_parameters_rad: f64,
    by_noise_of_a_sample_rad: f64,
}

impl<'a> Json<'a> {
    fn of(found: &'a Calibration) -> Self {
        let (physical, theta) = found.parameters.split_at(5.min(found.parameters.len()));
        let correlated = |of: &'a [Parameter], matrix: &'a Option<Correlations>| {
            Some(Correlated {
                names: of.iter().map(|p| p.name.as_str()).collect(),
                matrix: matrix.as_ref()?,
            })
        };
        Self {
            schema: "nonius.calibration/1",
            method: found.method,
            samples: found.samples,
            left_out: found.outliers,
            arc: found.arc,
            residual_rms: found.residual_rms,
            distortion: found.shape.as_ref().map(|shape| Distortion {
                rms: shape.rms,
                order: shape.order,
            }),
            noise: found.noise.map(|[cos_rms, sin_rms]| Noise {
                cos_rms,
                sin_rms,
                ratio: sin_rms / cos_rms,
                ratio_source: found.noise_ratio_source,
                ratio_std_error: found.noise_ratio_error,
                correlation: found.noise_together.map(|t| t.value),
                correlation_std_error: found.noise_together.map(|t| t.std_error),
            }),
            parameters: &found.parameters,
            correlations: [
                correlated(physical, &found.correlations),
                correlated(theta, &found.theta_correlations),
            ]
            .into_iter()
            .flatten()
            .collect(),
            bound: found.bound.as_ref().map(|bound| OfAngle {
                by_parameters_rad: bound.angle_by_parameters,
                by_noise_of_a_sample_rad: bound.angle_by_noise,
            }),
            cannot_tell: &found.cannot_tell,
            remarks: &found.remarks,
        }
    }
}

pub(crate) fn run(args: &Calibrate) -> Result<()> {
    if let Some(ratio) = args.noise_ratio
        && !(ratio.is_finite() && (0.01..=100.0).contains(&ratio))
    {
        bail!(
            "--noise-ratio {ratio}: expected 0.01 to 100, the noise of the sine channel over that of the cosine channel"
        );
    }
    let recording =
        Recording::read_even_at_rest(&args.recording, &args.recording_args.overrides())?;
    crate::notes(&recording.notes);
    let options = Options {
        noise_ratio: args.noise_ratio,
    };
    let (cos, sin, method) = (&recording.cos, &recording.sin, args.method.method());
    let busy = Busy::new(format!("calibrates {} samples", recording.samples()));
    let found = calibrate(cos, sin, method, &options);
    drop(busy);
    let found = match found {
        Ok(found) => found,
        // The file is in order; what it does not tell is the answer.
        Err(why) if why.is_ignorance() => undetermined(method, cos, sin, &why),
        Err(why) => bail!("{}: {why}", args.recording.display()),
    };
    if args.json {
        crate::notes(&found.remarks);
        say!("{}", serde_json::to_string_pretty(&Json::of(&found))?);
    } else {
        let adc = recording.metadata.adc;
        // The rounding of an ADC that was merely assumed is no finding.
        let known = adc.cos.source != AdcSource::Assumed;
        let lsb = known.then_some([adc.cos.lsb, adc.sin.lsb]);
        say_as_it_is!("{}", report(&found, lsb));
    }
    Ok(())
}
