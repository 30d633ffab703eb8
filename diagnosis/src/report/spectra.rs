//! Spectra of residuals, against frequency and against the order of the scale period or of the revolution.

use std::f64::consts::{PI, TAU};

use nonius_fourier::Complex;
use nonius_plot::{Axis, Look, Mark, Plot, Series};
use nonius_quantity::{Unit, prefixed};

use crate::context::Context;
use crate::numerics::ends::span;

/// Points of a spectrum; of several lines at a point, the highest is shown.
const POINTS: usize = 700;
/// Lines on either side of one that is looked at closely.
const NEAR: usize = 60;
/// Places of a scale period when samples are gathered by their angle.
const PLACES: usize = 64;
/// Highest order of the scale period that is shown.
const TOP: usize = 12;
/// Most scale periods of an order spectrum.
const PERIODS: usize = 512;

/// What the samples' values mean.
pub(super) struct Signal<'a> {
    pub(super) context: &'a Context,
    pub(super) label: &'static str,
    pub(super) unit: f64,
}

/// The Hann window, of mean one.
fn window(k: usize, n: usize) -> f64 {
    let x = (k as f64 + 0.5) / n as f64;
    2.0 * (PI * x).sin().powi(2)
}

/// Amplitudes of the lines of a spectrum: of a real signal, or of two at once as real and imaginary part.
fn amplitudes(values: &dyn Fn(usize) -> Complex<f64>, n: usize) -> Vec<f64> {
    let mut buffer: Vec<Complex<f64>> = (0..n).map(|k| values(k) * window(k, n)).collect();
    nonius_fourier::forward(&mut buffer);
    // Both sides together: of two channels, the root of the sum of squares.
    let line = |k: usize| {
        let both = buffer[k].norm_sqr() + buffer[(n - k) % n].norm_sqr();
        (2.0 * both).sqrt() / n as f64
    };
    (1..n / 2).map(line).collect()
}

/// As few points as can be shown, each the highest of its lines.
fn gathered(lines: &[f64], first: usize, step: f64, unit: f64) -> Vec<[f64; 2]> {
    let per = lines.len().div_ceil(POINTS).max(1);
    let highest = |(i, part): (usize, &[f64])| {
        let best = (0..part.len()).max_by(|a, b| part[*a].total_cmp(&part[*b]));
        let best = best.unwrap_or(0);
        [step * (first + i * per + best) as f64, unit * part[best]]
    };
    lines.chunks(per).enumerate().map(highest).collect()
}

impl Signal<'_> {
    /// The spectrum before and after, whole or close to a line of so many hertz.
    pub(super) fn frequency(
        &self,
        title: &str,
        before: &dyn Fn(usize) -> Complex<f64>,
        after: &dyn Fn(usize) -> Complex<f64>,
        near: Option<f64>,
        marks: Vec<Mark>,
    ) -> Option<Plot> {
        let names = match near {
            None => ["five parameters", "extended"],
            Some(_) => ["without the cause", "with it"],
        };
        let n = self.context.samples();
        let step = self.context.rate / n as f64;
        let (was, is) = (amplitudes(before, n), amplitudes(after, n));
        let range = match near {
            None => 0..was.len(),
            Some(hertz) => {
                let middle = (hertz / step).round() as usize;
                middle.saturating_sub(NEAR + 1)..(middle + NEAR).min(was.len())
            }
        };
        let (unit, factor) = prefixed(step * range.end as f64, Unit::Prefixed("Hz"));
        let marks = marks.into_iter().map(|mark| Mark {
            x: factor * mark.x,
            ..mark
        });
        let first = range.start + 1;
        let part = |lines: &[f64]| {
            lines
                .get(range.clone())
                .map(|l| gathered(l, first, factor * step, self.unit))
        };
        let (was, is) = (part(&was)?, part(&is)?);
        let label = format!("frequency, {unit}");
        Some(self.drawn(title, &label, was, is, names, marks.collect()))
    }

    /// The spectrum of both channels against the order of the scale period.
    pub(super) fn order(
        &self,
        title: &str,
        before: &dyn Fn(usize) -> Complex<f64>,
        after: &dyn Fn(usize) -> Complex<f64>,
        marks: Vec<Mark>,
    ) -> Option<Plot> {
        let context = self.context;
        let alpha = &context.alpha;
        let travelled = (span(alpha.iter().copied()) / TAU).floor() as usize;
        // A revolution closes upon itself; else as far as the scale was moved.
        let revolution = context.periods_per_revolution.map(|n| n as usize);
        let periods = revolution
            .filter(|n| *n <= PERIODS && travelled >= *n)
            .unwrap_or(travelled.min(PERIODS));
        if periods == 0 {
            return None;
        }
        let count = periods * PLACES;
        let of = |value: &dyn Fn(usize) -> Complex<f64>| {
            let mut sum = vec![Complex::new(0.0, 0.0); count];
            let mut weight = vec![0.0; count];
            for (k, alpha) in alpha.iter().enumerate() {
                let place = (alpha / TAU / periods as f64).rem_euclid(1.0) * count as f64;
                let place = (place as usize).min(count - 1);
                // In the frame of the channels: an order of theirs stands at that order.
                let frame = Complex::new(context.cos[k], context.sin[k]);
                sum[place] += value(k) * frame * context.weight[k];
                weight[place] += context.weight[k];
            }
            for (s, w) in sum.iter_mut().zip(&weight).filter(|(_, w)| **w > 0.0) {
                *s /= w;
            }
            nonius_fourier::forward(&mut sum);
            let line = |k: usize| {
                let both = sum[k].norm_sqr() + sum[count - k].norm_sqr();
                (2.0 * both).sqrt() / count as f64
            };
            let lines: Vec<f64> = (1..=TOP * periods).map(line).collect();
            gathered(&lines, 1, 1.0 / periods as f64, self.unit)
        };
        let names = ["five parameters", "extended"];
        let label = "order of the scale period";
        Some(self.drawn(title, label, of(before), of(after), names, marks))
    }

    fn drawn(
        &self,
        title: &str,
        x: &str,
        was: Vec<[f64; 2]>,
        is: Vec<[f64; 2]>,
        names: [&str; 2],
        marks: Vec<Mark>,
    ) -> Plot {
        let ends = [was.first(), was.last()].map(|p| p.map_or(0.0, |p| p[0]));
        let mut heights: Vec<f64> = was.iter().chain(&is).map(|p| p[1]).collect();
        heights.sort_by(f64::total_cmp);
        // Single deep notches would take the room of all the rest.
        let low = heights.get(heights.len() / 50).copied().unwrap_or(1e-6);
        let high = heights.last().copied().unwrap_or(1.0);
        let clipped = |points: Vec<[f64; 2]>| {
            let held = |[x, y]: [f64; 2]| [x, y.max(low * 0.7)];
            points.into_iter().map(held).collect()
        };
        Plot {
            title: title.into(),
            x: Axis::linear(x, ends),
            y: Axis::logarithmic(self.label, [low, high]),
            series: vec![
                Series::new(names[0], Look::BeforeLine, clipped(was)),
                Series::new(names[1], Look::AfterLine, clipped(is)),
            ],
            marks,
            round: false,
        }
    }
}
