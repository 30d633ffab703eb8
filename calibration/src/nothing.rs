//! Why samples draw no ellipse, in plain words.

use crate::method::Error;
use crate::places::seen_from_the_mean;
use crate::samples::{Repeated, Samples};

/// The samples as vectors from their mean.
pub(crate) fn centred(cos: &[f64], sin: &[f64]) -> Vec<nalgebra::Vector2<f64>> {
    let pairs = cos.iter().zip(sin);
    let all: Vec<_> = pairs.map(|(c, s)| nalgebra::Vector2::new(*c, *s)).collect();
    let mean = all.iter().sum::<nalgebra::Vector2<f64>>() / all.len() as f64;
    all.into_iter().map(|y| y - mean).collect()
}

/// Standard deviation across the samples' main direction over that along it, 0 to 1.
fn slimness(centred: &[nalgebra::Vector2<f64>]) -> f64 {
    let spread: nalgebra::Matrix2<f64> = centred.iter().map(|y| y * y.transpose()).sum();
    let values = spread.symmetric_eigenvalues();
    (values.min().max(0.0) / values.max().max(f64::MIN_POSITIVE)).sqrt()
}

/// The pair that many samples are to the last digit, and how many, where the others draw an ellipse.
fn stuck(cos: &[f64], sin: &[f64]) -> Option<([f64; 2], usize)> {
    /// Share of the samples.
    const MANY: f64 = 0.05;
    let repeated = Repeated::of(cos, sin)?;
    let many = repeated.count as f64 > MANY * cos.len() as f64;
    let (others, count) = (&repeated, repeated.count);
    let drawn = many
        && others.cos.len() >= nonius_recording::MIN_SAMPLES
        && Samples::of(&others.cos, &others.sin).is_some();
    drawn.then_some((repeated.pair, count))
}

/// Why the samples draw no ellipse, and what to do; `None` where they draw one.
#[must_use]
pub fn no_ellipse(cos: &[f64], sin: &[f64]) -> Option<String> {
    let drawn = Samples::of(cos, sin).is_some();
    (!drawn).then(|| reason(cos, sin, &Error::NoEllipse))
}

/// What to say of the parameters where the samples draw no ellipse at all.
pub(crate) fn of_nothing(cos: &[f64], sin: &[f64], why: &Error) -> String {
    let reason = reason(cos, sin, why);
    format!(
        "a_c, b_c, a_s, b_s, beta, theta: {reason}; the values are half the sums and differences of the extremes"
    )
}

/// What is seen, and what to do.
fn reason(cos: &[f64], sin: &[f64], why: &Error) -> String {
    /// Slimmer than this is a line, rounder a cloud.
    const LINE: f64 = 0.4;
    const MOVE: &str = "move the scale by a whole period or more while recording";
    let centred = centred(cos, sin);
    let (slimness, places) = (slimness(&centred), seen_from_the_mean(&centred));
    let stuck = match why {
        Error::NoEllipse => stuck(cos, sin),
        _ => None,
    };
    let (seen, advice) = match (why, stuck) {
        (_, Some(([c, s], count))) => (
            format!(
                "the samples draw no ellipse, but they do without the {count} of {} that are {c}, {s} to the last digit: nothing was \
                 connected then, the ADC did not run, or a gap was filled",
                cos.len()
            ),
            "leave those out",
        ),
        (Error::NoEllipse, _) if slimness < LINE => (
            "the samples lie on a line within their noise: the arc is too short, or both channels carry one signal"
                .into(),
            MOVE,
        ),
        (Error::NoEllipse, _) if places > 2 => (
            format!(
                "the samples stand at {places} places of the period only, which is too few: the speed was such that {places} samples \
                 make whole periods, or the axis stood there"
            ),
            "record at another speed",
        ),
        (Error::NoEllipse, _) => (
            "the samples are a cloud and no ring: the scale stands still, or the signals are no sin/cos pair".into(),
            MOVE,
        ),
        (Error::Standstill(why), _) => (format!("the scale stands still: {why}"), MOVE),
        (other, _) => (other.to_string(), MOVE),
    };
    format!("{seen}; {advice}")
}
