//! A reference that does not follow the sensor is none: what it says is left out, and said.

use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

use nonius_recording::Recording;

use crate::checks::first;
use crate::checks::jumps;
use crate::context::{against, unwrapped};
use crate::numerics::continuous::nearest;
use crate::numerics::ends::span;

/// Share of samples that may be farther than a quarter period from where the reference says.
const ASTRAY: f64 = 0.05;
/// Share of what is between angle and reference from which on a straight line explains it.
const STRAIGHT: f64 = 0.98;
/// So near, in parts of itself, a scale has to be to one that is looked for.
const NEAR: f64 = 0.01;
/// Scales that are off by less than that, in percent, are meant to be right.
const LITTLE: f64 = 25.0;
/// Most periods of a revolution that a reference may count.
const MOST_PERIODS: f64 = 10_000.0;

/// A straight line of one value against another.
struct Line {
    slope: f64,
    /// Share that it explains.
    explains: f64,
}

impl Line {
    fn through(x: &[f64], y: &[f64]) -> Self {
        let n = x.len().max(1) as f64;
        let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
        let (x0, y0) = (mean(x), mean(y));
        let sum = |f: fn(f64, f64) -> f64| -> f64 {
            x.iter().zip(y).map(|(x, y)| f(x - x0, y - y0)).sum()
        };
        let [xx, xy, yy] = [sum(|x, _| x * x), sum(|x, y| x * y), sum(|_, y| y * y)];
        let xx = xx.max(f64::MIN_POSITIVE);
        Self {
            slope: xy / xx,
            explains: xy * xy / (xx * yy).max(f64::MIN_POSITIVE),
        }
    }
}

/// Whether the sensor's angle and its reference go together but for what an error can be: latency and graduation are far less.
fn follows(angle: &[f64], reference: &[f64]) -> bool {
    let apart = against(angle, reference);
    let (sin, cos) = apart
        .iter()
        .fold((0.0, 0.0), |(s, c), d| (s + d.sin(), c + d.cos()));
    let middle = f64::atan2(sin, cos);
    let off = |d: f64| nearest(d, 0.0);
    let astray = apart.iter().filter(|d| off(*d - middle).abs() > FRAC_PI_2);
    if astray.count() as f64 > ASTRAY * apart.len() as f64 {
        return false;
    }
    // A scale that is off by little is within that where the recording is short.
    let line = Line::through(angle, &apart);
    let runs_away = line.slope.abs() * span(angle.iter().copied()) > FRAC_PI_4;
    !(runs_away && line.explains > STRAIGHT)
}

/// What is likely the matter with a reference that does not follow.
fn reason(angle: &[f64], reference: &[f64], per: Option<u32>) -> String {
    let in_unit = |unit: f64| -> Vec<f64> {
        let scaled = reference.iter().map(|r| unit * r).collect();
        unwrapped(scaled)
    };
    let is = |value: f64, near: f64| (value / near - 1.0).abs() < NEAR;
    let [shown, moved] = [reference, angle].map(|values| span(values.iter().copied()));
    if shown < 1e-6 * moved {
        return "it does not change while the sensor moves".into();
    }
    for (unit, name) in [(PI / 180.0, "degrees"), (TAU, "periods")] {
        let line = Line::through(angle, &in_unit(unit));
        if line.explains > STRAIGHT && is(line.slope.abs(), 1.0) {
            return format!("it seems to be in {name}, and radians are expected");
        }
    }
    let line = Line::through(angle, &in_unit(1.0));
    let off = 100.0 * (line.slope.abs() - 1.0);
    if line.explains > STRAIGHT && off.abs() < LITTLE {
        let side = if off < 0.0 { "less" } else { "more" };
        return format!(
            "its scale seems to be off: it moves {:.2} % {side}",
            off.abs()
        );
    }
    for (unit, name) in [(1.0, ""), (PI / 180.0, ", in degrees")] {
        let line = Line::through(angle, &in_unit(unit));
        let periods = (1.0 / line.slope.abs()).round();
        let whole = (2.0..MOST_PERIODS).contains(&periods) && is(line.slope.abs() * periods, 1.0);
        let known = per.is_none_or(|per| f64::from(per) == periods);
        if line.explains > STRAIGHT && whole && known {
            return format!(
                "it moves 1/{periods} as far: it seems to be the angle of a revolution of {periods} periods{name}, and that of the scale period is expected"
            );
        }
    }
    "it seems to have nothing to do with the sensor".into()
}

/// A recording without its reference, and a note that says so, where that does not follow the sensor; as it is otherwise.
pub(crate) fn checked(recording: &Recording) -> Cow<'_, Recording> {
    let all = vec![1.0; recording.samples()];
    let own = recording.reference_rad.as_ref();
    let ellipse = own.and_then(|_| first::of_all(recording));
    let Some((reference, ellipse)) = own.zip(ellipse) else {
        return Cow::Borrowed(recording);
    };
    let angle = jumps::angle(recording, &ellipse, &all);
    let continuous = unwrapped(reference.clone());
    if follows(&angle, &continuous) {
        return Cow::Borrowed(recording);
    }
    let why = reason(&angle, reference, recording.metadata.periods_per_revolution);
    let mut without = recording.clone();
    without.reference_rad = None;
    without.notes.push(format!(
        "reference_rad does not follow the angle of the sensor and is not used: {why}"
    ));
    Cow::Owned(without)
}
