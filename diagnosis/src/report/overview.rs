//! Pictures of the whole recording: the figure of the signals, and what either model leaves of it.

use nonius_fourier::Complex;
use nonius_plot::{Axis, Look, Mark, Plot, Series};

use super::binned::{Against, Along, Row, Seen};
use super::pictures::{hertz_text, title};
use super::spectra::Signal;
use crate::diagnose::Diagnosis;
use crate::finding::Cause;

/// Points of a cloud.
const POINTS: usize = 1500;
/// Part of the radius to which its largest error is drawn.
const DRAWN: f64 = 0.3;
/// Plots of what is left at most.
const LEFT: usize = 4;
/// Mean square of means over their errors, above which a plot of them shows something.
const SHOWS: f64 = 2.0;
/// Marks of a plot at most.
const MARKS: usize = 4;

/// Radial and tangential residual.
type Residuals = (Vec<f64>, Vec<f64>);

/// The samples that are shown of a cloud.
fn shown(found: &Diagnosis) -> impl Iterator<Item = usize> + '_ {
    let n = found.context.samples();
    let counts = |k: &usize| found.context.weight[*k] > 0.0;
    (0..n).step_by(n.div_ceil(POINTS).max(1)).filter(counts)
}

/// The figure that the signals draw, with its radial error so many times as large, for either model.
pub(super) fn figures(found: &Diagnosis) -> Vec<Plot> {
    let context = &found.context;
    let mut sizes: Vec<f64> = shown(found)
        .map(|k| found.residuals[0].0[k].abs())
        .collect();
    sizes.sort_by(f64::total_cmp);
    let largest = sizes.get(sizes.len() * 99 / 100).copied().unwrap_or(0.0);
    // 1, 2 or 5 times a power of ten.
    let most = (DRAWN / largest.max(1e-9)).max(1.0);
    let power = 10f64.powf(most.log10().floor());
    let times = [5.0, 2.0, 1.0].map(|f| f * power);
    let times = times.into_iter().find(|t| *t <= most).unwrap_or(1.0);
    let circle: Vec<[f64; 2]> = (0..=120)
        .map(|i| f64::from(i) / 120.0 * std::f64::consts::TAU)
        .map(|a| [a.cos(), a.sin()])
        .collect();
    let names = [
        ("Five parameters", Look::Before),
        ("Extended model", Look::After),
    ];
    let one = |(name, look): (&str, Look), residual: &Residuals| Plot {
        title: format!("{name}: radial error × {times}"),
        x: Axis::linear("cos", [-1.4, 1.4]),
        y: Axis::linear("sin", [-1.4, 1.4]),
        series: vec![
            Series::new("circle", Look::Model, circle.clone()),
            Series::new(
                "measured",
                look,
                shown(found)
                    .map(|k| {
                        let r = 1.0 + times * residual.0[k];
                        [r * context.cos[k], r * context.sin[k]]
                    })
                    .collect(),
            ),
        ],
        marks: vec![],
        round: true,
    };
    names
        .into_iter()
        .zip(&found.residuals)
        .map(|(name, residual)| one(name, residual))
        .collect()
}

/// What either model leaves, against the angle and as spectra.
pub(super) fn residuals(found: &Diagnosis) -> Vec<Plot> {
    let context = &found.context;
    let turn = |k: usize| (context.alpha[k] / std::f64::consts::TAU).rem_euclid(1.0);
    let cloud = |title: &str, label: &str, unit: f64, of: fn(&Residuals) -> &[f64]| {
        let points = |model: usize| -> Vec<[f64; 2]> {
            let values = of(&found.residuals[model]);
            shown(found).map(|k| [turn(k), unit * values[k]]).collect()
        };
        let (was, is) = (points(0), points(1));
        let heights = was.iter().chain(&is).map(|p| p[1]);
        Plot {
            title: title.into(),
            x: Axis::linear("angle, scale periods", [0.0, 1.0]),
            y: Axis::fitted(label, heights.collect::<Vec<_>>()),
            series: vec![
                Series::new("five parameters", Look::Before, was),
                Series::new("extended", Look::After, is),
            ],
            marks: vec![],
            round: false,
        }
    };
    let mut plots = vec![
        cloud(
            "Radial error against the angle",
            "radial error, % of the amplitude",
            100.0,
            |r| &r.0,
        ),
        cloud(
            if context.against_reference.is_some() {
                "Angle error against the reference, over the angle"
            } else {
                "Angle error above the motion, over the angle"
            },
            "angle error, mrad (electrical)",
            1000.0,
            |r| &r.1,
        ),
    ];
    let signal = Signal {
        context,
        label: "radial and angle error, % of the amplitude",
        unit: 100.0,
    };
    let both = |model: usize| {
        let (radial, tangential) = &found.residuals[model];
        move |k: usize| Complex::new(radial[k], tangential[k])
    };
    let lines = found.findings.iter().filter_map(|f| {
        let text = hertz_text(f);
        f.parameter("frequency_hz").map(|x| Mark { x, text })
    });
    plots.extend(signal.frequency(
        "Spectrum against frequency",
        &both(0),
        &both(1),
        None,
        lines.take(MARKS).collect(),
    ));
    let orders = found
        .findings
        .iter()
        .filter(|f| f.cause == Cause::SpatialHarmonic)
        .filter_map(|f| f.parameter("order"))
        .take(MARKS)
        .map(|x| Mark {
            x,
            text: format!("order {x}"),
        });
    plots.extend(signal.order(
        "Spectrum of the channels against the order of the scale period",
        &both(0),
        &both(1),
        orders.collect(),
    ));
    plots
}

/// What has no name, against whatever shows it, the clearest first.
pub(super) fn left(found: &Diagnosis) -> Vec<Plot> {
    if !found.unexplained.significant {
        return vec![];
    }
    let (radial, tangential) = &found.residuals[1];
    let residual = |k: usize| -> Row {
        let motion = found.left_motion.as_ref().map_or(0.0, |m| m[k]);
        [radial[k], tangential[k], motion]
    };
    let seen = Seen {
        context: &found.context,
        left: &residual,
        effect: &|_| [0.0; 3],
    };
    let ways = [
        (Against::Angle, Along::Radius),
        (Against::Angle, Along::Circle),
        (Against::Speed, Along::Radius),
        (Against::Speed, Along::Phase(1)),
        (Against::Time, Along::Radius),
        (Against::Time, Along::Offset(0)),
        (Against::Time, Along::Offset(1)),
        (Against::Revolution, Along::Radius),
        (Against::Revolution, Along::Circle),
    ];
    let mut plots: Vec<(f64, Plot)> = ways
        .into_iter()
        .filter_map(|(against, along)| {
            let mut plot = seen.plot(&title(against, along), against, along)?;
            if let [measured, model] = plot.series.as_mut_slice() {
                measured.name = "left, ± standard error".into();
                model.name = "zero".into();
            }
            Some((shows(&plot), plot))
        })
        .filter(|p| p.0 > SHOWS)
        .collect();
    plots.sort_by(|a, b| b.0.total_cmp(&a.0));
    plots.into_iter().take(LEFT).map(|p| p.1).collect()
}

/// Mean square of the means of a plot over their errors: about one, if there is nothing.
fn shows(plot: &Plot) -> f64 {
    let Some(means) = plot.series.first() else {
        return 0.0;
    };
    let pairs = means.points.iter().zip(&means.errors);
    let squares = pairs.map(|(p, e)| (p[1] / e.max(f64::MIN_POSITIVE)).powi(2));
    squares.sum::<f64>() / means.points.len().max(1) as f64
}
