//! A sampling time that wanders, and not at random: in a line, or with the angle. Jitter is the name of what is random.

use nonius_quantity::{Quantity, Unit};

use crate::context::Context;
use crate::finding::Cause;
use crate::numerics::lines;
use crate::unnamed::unexplained::like;

/// Probability below which the highest line of a spectrum is no noise.
const A_LINE: f64 = 1e-4;
/// Share of what jitter explains that such a line has to explain to be the reason for it: what is left of a shaking axis
/// has weak ones.
const MUCH: f64 = 0.2;
/// Log-likelihood by which a line of the axis has to stand higher to be the reason for one of the clock.
const CLEARLY: f64 = 3.0;

/// What is said of how the sampling time wanders.
pub(super) fn sentence(how: &str) -> String {
    let like = like(Cause::ClockJitter, "that is random");
    format!("the sampling time wanders {how}; {like}")
}

/// Whether what is left along the circle, in its rms, grows with the speed from sample to sample as well, as what is random at each does.
/// What a spline leaves of an axis that shakes grows with the speed by chance, but changes slowly.
pub(super) fn is_at_random(context: &Context, tangential: &[f64]) -> bool {
    /// Share of the growth that the difference of two samples has to have, of white noise all of it.
    const MUCH: f64 = 0.5;
    let counted = |k: &usize| context.weight[*k] > 0.0 && context.weight[*k - 1] > 0.0;
    let counted: Vec<usize> = (1..tangential.len()).filter(counted).collect();
    let square = |k: usize| (context.speed[k] / context.top_speed()).powi(2);
    let mean = |of: &dyn Fn(usize) -> f64| {
        counted.iter().map(|k| of(*k)).sum::<f64>() / counted.len().max(1) as f64
    };
    let usual = mean(&square);
    let spread = mean(&|k| (square(k) - usual).powi(2)).max(f64::MIN_POSITIVE);
    let grows =
        |size: &dyn Fn(usize) -> f64| mean(&|k| size(k).powi(2) * (square(k) - usual)) / spread;
    let all = grows(&|k| tangential[k]);
    let fast = grows(&|k| (tangential[k] - tangential[k - 1]) / 2f64.sqrt());
    // Squares of differences go together with those beside them.
    let error = (2.0 * 1.5 / (spread * counted.len().max(1) as f64)).sqrt();
    fast + error > MUCH * all
}

/// How the sampling time wanders where it is not at random: in a line, or with the angle, that explains much of what jitter
/// does.
pub(super) fn how(context: &Context, tangential: &[f64], gain: f64) -> Option<String> {
    in_a_line(context, tangential, gain).or_else(|| with_the_angle(context, tangential, gain))
}

/// Probability that the highest of so many places has that power, in means, by chance.
fn by_chance(power: f64, places: usize) -> f64 {
    places as f64 * (-power).exp()
}

/// The sampling time's error, as far as the speed shows it.
fn time_error(context: &Context, tangential: &[f64]) -> Vec<f64> {
    let speeds = context.speed.iter().zip(tangential);
    speeds.map(|(v, t)| t * v / context.top_speed()).collect()
}

/// How it wanders in a line that explains much of what jitter does.
pub(super) fn in_a_line(context: &Context, tangential: &[f64], gain: f64) -> Option<String> {
    /// Fewest turns of a line over the recording: what does not turn is a delay.
    const TURNS: f64 = 3.0;
    let n = tangential.len();
    let time = time_error(context, tangential);
    let (mut power, length) = over_mean(&time);
    let slow = (TURNS * length as f64 / n as f64) as usize;
    power.iter_mut().take(slow).for_each(|p| *p = 0.0);
    let line = power.iter().copied().fold(0.0, f64::max);
    let at = power.iter().position(|p| *p == line).unwrap_or(0);
    // What a shaking axis leaves is coloured: a line of the clock stands out of what is near it. Half of noise is below
    // ln 2 of its mean.
    let near = lines::flattened(&power)[at] * std::f64::consts::LN_2;
    let stands_out = by_chance(near.min(line), n) < A_LINE;
    // The axis vibrates at any speed alike.
    let vibrates = line_near(tangential, at) > line + CLEARLY;
    if stands_out && line > MUCH * gain && !vibrates {
        let hertz = Quantity::rounded(
            at as f64 / length as f64 * context.rate,
            3,
            Unit::Prefixed("Hz"),
        );
        return Some(format!("periodically, at {}", hertz.brief()));
    }
    None
}

/// How it wanders with the angle, where that explains much of what jitter does.
fn with_the_angle(context: &Context, tangential: &[f64], gain: f64) -> Option<String> {
    /// Highest order of the scale period.
    const TOP: usize = 12;
    let time = time_error(context, tangential);
    let total: f64 = time.iter().map(|t| t * t).sum();
    let order = |m: usize| {
        let pairs = time.iter().zip(&context.alpha);
        let (c, s) = pairs.fold((0.0, 0.0), |(c, s), (t, alpha)| {
            let (sin, cos) = (m as f64 * alpha).sin_cos();
            (c + t * cos, s + t * sin)
        });
        (m, (c * c + s * s) / total)
    };
    let (m, most) = (1..=TOP).map(order).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (by_chance(most, TOP) < A_LINE && most > MUCH * gain)
        .then(|| format!("with the angle, at order {m} of the scale period"))
}

/// The spectrum of values over its mean, and its length.
fn over_mean(values: &[f64]) -> (Vec<f64>, usize) {
    let (mut power, length) = lines::spectrum(values);
    let mean = power.iter().sum::<f64>() / power.len() as f64;
    power.iter_mut().for_each(|p| *p /= mean);
    (power, length)
}

/// The highest line of a spectrum near a place in it, over the spectrum's mean.
fn line_near(values: &[f64], at: usize) -> f64 {
    /// Share of the frequency by which what changes with the speed is beside it.
    const NEAR: f64 = 0.2;
    let (power, _) = over_mean(values);
    let reach = (NEAR * at as f64) as usize;
    let near = at - reach..(at + reach + 1).min(power.len());
    power[near].iter().copied().fold(0.0, f64::max)
}
