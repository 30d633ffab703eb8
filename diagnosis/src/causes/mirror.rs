//! Which of two frequencies a line of the axis has. A spline follows a wave slower than half its knots in part, and its
//! knots make the rest look like a wave of their frequency less that of the line; so does a faster one the other way
//! round. After such a spline the two are one shape. Knots farther apart tell them, for they have another mirror.

use crate::context::Context;
use crate::lines::{wave, window};
use crate::solve::dot;
use crate::spline::Spline;

/// So many times farther apart are knots that tell: the motion's stand closer than it needs by more than that.
const WIDER: f64 = 1.3;
/// Frequency over that of the knots beyond which hardly anything is mirrored.
const FASTEST: f64 = 0.85;
/// The mirror has to explain so many times as much as the line where it seems to be.
const CLEARLY: f64 = 1.5;

/// The frequency that a line of the axis has which seems to be at `seen`, both in cycles per sample.
pub(super) fn unmirrored(context: &Context, seen: f64) -> f64 {
    let Some(spline) = &context.spline else {
        return seen;
    };
    let knots = 1.0 / spline.spacing();
    let mirror = knots - seen;
    if seen > FASTEST * knots || mirror > FASTEST * knots {
        return seen;
    }
    let weight = &context.weight;
    let wider = Spline::new(context.samples(), WIDER * spline.spacing(), weight);
    let lines = [seen, mirror].map(|f| wave(&number(context), f));
    let mut columns = vec![context.measured.as_slice()];
    columns.extend(lines.iter().flatten().map(Vec::as_slice));
    let mut left = wider.residuals(&columns, weight);
    // What the drive leaves at the ends of the recording is no line.
    for column in &mut left {
        let n = column.len();
        column
            .iter_mut()
            .enumerate()
            .for_each(|(k, v)| *v *= window(k, n));
    }
    let gain = |of: &[Vec<f64>]| {
        let power = |wave: &Vec<f64>| dot(&left[0], wave).powi(2) / dot(wave, wave).max(1e-300);
        of.iter().map(power).sum::<f64>()
    };
    if gain(&left[3..5]) > CLEARLY * gain(&left[1..3]) {
        mirror
    } else {
        seen
    }
}

/// Numbers of the samples.
fn number(context: &Context) -> Vec<f64> {
    (0..context.samples()).map(|k| k as f64).collect()
}
