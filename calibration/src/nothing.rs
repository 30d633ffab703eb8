//! Why samples draw no ellipse, in plain words.

use crate::method::Error;

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

/// At how many places of the period the samples stand, seen from their mean. A cloud about its mean, and an arc, have one. Near the mean
/// noise alone makes the angle; places of a ring stand away from it.
fn places(centred: &[nalgebra::Vector2<f64>]) -> usize {
    /// Share of the rms distance.
    const AWAY: f64 = 0.5;
    let rms = (centred.iter().map(|y| y.norm_squared()).sum::<f64>() / centred.len() as f64).sqrt();
    let away = centred.iter().filter(|y| y.norm() > AWAY * rms);
    places_of(
        away.map(|y| y.y.atan2(y.x) / std::f64::consts::TAU)
            .collect(),
    )
}

/// Clusters of angles, in turns, that are a gap of 20° and more apart.
pub(crate) fn places_of(angles: Vec<f64>) -> usize {
    gaps(angles).len().max(1)
}

/// The same where the angles are so many, or the clusters so narrow, that it is no chance.
pub(crate) fn narrow_places_of(angles: Vec<f64>) -> Option<usize> {
    /// Angles of which hardly any place of the period would be left out.
    const MANY: usize = 128;
    /// Angles of each place, and share of the period that all places fill, of fewer.
    const EACH: usize = 8;
    const NARROW: f64 = 0.1;
    let samples = angles.len();
    let gaps = gaps(angles);
    let filled = 1.0 - gaps.iter().sum::<f64>();
    let narrow = filled < NARROW && samples >= EACH * gaps.len();
    (samples >= MANY || narrow).then_some(gaps.len().max(1))
}

/// Gaps of 20° and more between neighbouring angles, in turns.
fn gaps(mut angles: Vec<f64>) -> Vec<f64> {
    /// Turns.
    const GAP: f64 = 20.0 / 360.0;
    angles.sort_by(f64::total_cmp);
    let around = angles.first().zip(angles.last()).map(|(a, b)| a + 1.0 - b);
    let between = angles.windows(2).map(|pair| pair[1] - pair[0]);
    between.chain(around).filter(|gap| *gap > GAP).collect()
}

/// Where the samples draw no ellipse at all.
pub(crate) fn of_nothing(cos: &[f64], sin: &[f64], why: &Error) -> String {
    /// Slimmer than this is a line, rounder a cloud.
    const LINE: f64 = 0.4;
    const MOVE: &str = "move the scale by a whole period or more while recording";
    let centred = centred(cos, sin);
    let (slimness, places) = (slimness(&centred), places(&centred));
    let (seen, advice) = match why {
        Error::NoEllipse if slimness < LINE => (
            "the samples lie on a line within their noise: the arc is too short, or both channels carry one signal"
                .into(),
            MOVE,
        ),
        Error::NoEllipse if places > 2 => (
            format!(
                "the samples stand at {places} places of the period only, which is too few: the speed was such that {places} samples \
                 make whole periods, or the axis stood there"
            ),
            "record at another speed",
        ),
        Error::NoEllipse => (
            "the samples are a cloud and no ring: the scale stands still, or the signals are no sin/cos pair".into(),
            MOVE,
        ),
        Error::Standstill(why) => (format!("the scale stands still: {why}"), MOVE),
        other => (other.to_string(), MOVE),
    };
    format!(
        "a_c, b_c, a_s, b_s, beta, theta: {seen}; {advice}; the values are half the sums and differences of the extremes"
    )
}
