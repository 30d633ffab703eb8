//! Pictures of noise: its size against what it depends on, its spectrum.

use std::f64::consts::TAU;

use nonius_plot::{Axis, Look, Plot, Series};

use crate::diagnose::Diagnosis;
use crate::finding::{Cause, Finding};
use crate::noise::flicker;

const BINS: usize = 24;
/// Fewest samples that tell a size.
const FEWEST: f64 = 20.0;

/// The pictures of a finding; none where it is of another kind.
pub(super) fn of(finding: &Finding, found: &Diagnosis) -> Vec<Plot> {
    let context = &found.context;
    let (radial, tangential) = &found.residuals[1];
    let n = context.samples();
    match finding.cause {
        Cause::AmplitudeNoise => {
            let rms = finding.parameter("rms").unwrap_or(0.0);
            let sizes = [0, 1].map(|which| {
                let value = |k: usize| {
                    let (cos, sin) = (context.cos[k], context.sin[k]);
                    let (r, t) = (radial[k], tangential[k]);
                    [(cos, r * cos - t * sin), (sin, r * sin + t * cos)][which]
                };
                (which, sizes(n, &context.weight, &value, [-1.0, 1.0]))
            });
            let label = |which: usize| ["cos, in amplitudes", "sin, in amplitudes"][which];
            sizes
                .into_iter()
                .map(|(which, s)| {
                    drawn("Noise against the signal", label(which), s, |x| {
                        (rms * x).powi(2)
                    })
                })
                .collect()
        }
        Cause::ClockJitter => {
            let rms = finding.parameter("rms_s").unwrap_or(0.0);
            let value = |k: usize| (context.speed[k].abs() / TAU, tangential[k]);
            let top = context.top_speed() / TAU;
            let sizes = sizes(n, &context.weight, &value, [0.0, top]);
            let label = "speed, scale periods per second";
            vec![drawn(
                "Noise of the angle against speed",
                label,
                sizes,
                |v| (rms * v * TAU).powi(2),
            )]
        }
        Cause::FlickerNoise => vec![spectrum(finding, found)],
        _ => vec![],
    }
}

/// Mean square and its standard error of what falls into a bin.
fn sizes(
    n: usize,
    weight: &[f64],
    value: &dyn Fn(usize) -> (f64, f64),
    [low, high]: [f64; 2],
) -> Vec<(f64, f64, f64)> {
    let mut bins = [[0.0; 3]; BINS];
    for k in (0..n).filter(|k| weight[*k] > 0.0) {
        let (x, noise) = value(k);
        let place = (x - low) / (high - low) * BINS as f64;
        let bin = &mut bins[(place.max(0.0) as usize).min(BINS - 1)];
        for (sum, add) in bin.iter_mut().zip([1.0, x, noise * noise]) {
            *sum += add;
        }
    }
    let enough = bins.into_iter().filter(|b| b[0] >= FEWEST);
    enough
        .map(|[count, x, square]| {
            let mean = square / count;
            (x / count, mean, mean * (2.0 / count).sqrt())
        })
        .collect()
}

/// Sizes as rms, and what white noise with the cause would have: the white part is that which fits them best.
fn drawn(title: &str, label: &str, sizes: Vec<(f64, f64, f64)>, more: impl Fn(f64) -> f64) -> Plot {
    let weight = |s: &(f64, f64, f64)| s.2.powi(-2).min(1e30);
    let total: f64 = sizes.iter().map(&weight).sum();
    let white = sizes
        .iter()
        .map(|s| weight(s) * (s.1 - more(s.0)))
        .sum::<f64>()
        / total;
    let percent = |square: f64| 100.0 * square.max(0.0).sqrt();
    let points: Vec<[f64; 2]> = sizes.iter().map(|s| [s.0, percent(s.1)]).collect();
    let errors: Vec<f64> = sizes
        .iter()
        .map(|s| percent(s.1) * s.2 / (2.0 * s.1))
        .collect();
    let model: Vec<[f64; 2]> = sizes
        .iter()
        .map(|s| [s.0, percent(white + more(s.0))])
        .collect();
    Plot {
        title: title.into(),
        x: Axis::fitted(label, points.iter().map(|p| p[0])),
        y: Axis::fitted(
            "noise, % of the amplitude rms",
            points.iter().chain(&model).map(|p| p[1]).chain([0.0]),
        ),
        series: vec![
            Series {
                name: "measured, ± standard error".into(),
                look: Look::Bars,
                points,
                errors,
            },
            Series::new("white noise and the cause", Look::Model, model),
        ],
        marks: vec![],
        round: false,
    }
}

/// The spectrum of the channels' noise, and 1/f beside white noise.
fn spectrum(finding: &Finding, found: &Diagnosis) -> Plot {
    let context = &found.context;
    let corner = finding.parameter("corner_hz").unwrap_or(0.0);
    let density = finding.parameter("density_at_1_hz").unwrap_or(0.0);
    // Power of a line, white: see `flicker::find`.
    let level = density * density * context.rate / corner.max(f64::MIN_POSITIVE);
    let per_hertz = |power: f64| 100.0 * (power / context.rate).sqrt();
    let lines = flicker::gathered(context, &found.residuals[1].0);
    let measured: Vec<[f64; 2]> = lines
        .iter()
        .map(|l| [l.hertz, per_hertz(l.power)])
        .collect();
    let model: Vec<[f64; 2]> = lines
        .iter()
        .map(|l| [l.hertz, per_hertz(level * (2.0 + corner * l.flicker))])
        .collect();
    let white: Vec<[f64; 2]> = lines
        .iter()
        .map(|l| [l.hertz, per_hertz(level * 2.0)])
        .collect();
    let heights = measured.iter().chain(&model).map(|p| p[1]);
    Plot {
        title: "Noise of the channels against frequency".into(),
        x: Axis::logarithmic("frequency, Hz", measured.iter().map(|p| p[0])),
        y: Axis::logarithmic("noise, % of the amplitude per √Hz", heights),
        series: vec![
            Series::new("measured", Look::Before, measured),
            Series::new("white noise alone", Look::AfterLine, white),
            Series::new("with 1/f", Look::Model, model),
        ],
        marks: vec![],
        round: false,
    }
}
