//! Which of two frequencies a line of the axis has, and of two orders its cogging. A spline follows a wave slower than half its
//! knots in part, and its knots make the rest look like a wave of their frequency less that of the line; so does a faster
//! one the other way round. After such a spline the two are one shape. Knots farther apart tell them, for they have another
//! mirror.

use super::place::{order_waves, strongest_order};
use crate::context::Context;
use crate::motion::spline::Spline;
use crate::numerics::lines::{wave, window};
use crate::numerics::solve::dot;

/// So many times farther apart are knots that tell: the motion's stand closer than it needs by more than that.
const WIDER: f64 = 1.3;
/// Frequency over that of the knots beyond which hardly anything is mirrored.
const FASTEST: f64 = 0.85;
/// And below which hardly anything is left of it: nothing is looked for there.
pub(super) const FOLLOWED: f64 = 1.0 - FASTEST;
/// Mean square of a wave of which knots leave nothing.
const SOMETHING: f64 = 1e-3;
/// The mirror has to explain so many times as much as the line where it seems to be.
const CLEARLY: f64 = 1.5;

/// The frequency that a line of the axis has which seems to be at `seen`, both in cycles per sample.
pub(super) fn unmirrored(context: &Context, seen: f64) -> f64 {
    let Some(spline) = &context.spline else {
        return seen;
    };
    let knots = 1.0 / spline.spacing();
    let mirror = knots - seen;
    if seen > FASTEST * knots {
        return seen;
    }
    let weight = &context.weight;
    let wider = wider(context, spline);
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
    if explained(&left[0], &left[3..5]) > CLEARLY * explained(&left[0], &left[1..3]) {
        mirror
    } else {
        seen
    }
}

/// The order of the revolution, of `per` scale periods, in which the axis cogs where what the knots leave of it, `fast`, seems to have
/// the order `seen`: knots follow a low order where the speed is low, and leave of it what looks like others where it is high.
pub(super) fn unmirrored_order(
    context: &Context,
    (per, phi): (u32, &[f64]),
    fast: &[f64],
    seen: usize,
) -> usize {
    let Some(spline) = &context.spline else {
        return seen;
    };
    let weight = &context.weight;
    let left = wider(context, spline).residual(&context.measured, weight);
    let other = strongest_order(per, phi, &left);
    let Some(other) = other.filter(|other| *other != seen) else {
        return seen;
    };
    // Of a wave that knots follow in part its order is not the strongest one; what they leave of it explains the most.
    let [(of_seen, _), (of_other, left)] = [seen, other].map(|order| {
        let waves = order_waves(order, phi);
        let left = spline.residuals(&waves.each_ref().map(Vec::as_slice), weight);
        let square = dot(&left[0], &left[0]) / fast.len() as f64;
        (explained(fast, &left), square)
    });
    if of_other > CLEARLY * of_seen && left > SOMETHING {
        other
    } else {
        seen
    }
}

/// The spline with knots farther apart.
fn wider(context: &Context, spline: &Spline) -> Spline {
    Spline::new(context.samples(), WIDER * spline.spacing(), &context.weight)
}

/// Square of what waves at right angles to each other explain.
fn explained(values: &[f64], waves: &[Vec<f64>]) -> f64 {
    let power = |wave: &Vec<f64>| dot(values, wave).powi(2) / dot(wave, wave).max(1e-300);
    waves.iter().map(power).sum()
}

/// Numbers of the samples.
fn number(context: &Context) -> Vec<f64> {
    (0..context.samples()).map(|k| k as f64).collect()
}
