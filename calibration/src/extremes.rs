//! The extremes of the two signals: the baseline that the paper's introduction argues against.

use nonius_recording::Ellipse;
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::curve::{Curve, Parameters};
use nalgebra::SMatrix;

/// Lowest and highest value.
pub(crate) fn ends(values: &[f64]) -> (f64, f64) {
    let all = values.iter();
    all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(*x), high.max(*x))
    })
}

/// Half the difference and half the sum of the extremes; β = 0. `None` where a channel does not move.
#[must_use]
pub fn extremes(cos: &[f64], sin: &[f64]) -> Option<Ellipse> {
    let [(c0, c1), (s0, s1)] = [cos, sin].map(ends);
    let ellipse = Ellipse {
        a_c: (c1 - c0) / 2.0,
        b_c: c0 + (c1 - c0) / 2.0,
        a_s: (s1 - s0) / 2.0,
        b_s: s0 + (s1 - s0) / 2.0,
        beta: 0.0,
    };
    ellipse.is_sound().then_some(ellipse)
}

/// What noise does to the extremes.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeats {
    /// Covariance of a_c, b_c, a_s, b_s; β has none.
    pub covariance: SMatrix<f64, 5, 5>,
    /// Mean of what the extremes give less what is true.
    pub bias: Parameters,
}

/// Whether an end of the cosine, and of the sine, lies further beyond the samples at the angles `alpha` (radians) than their
/// noise reaches: then the extremes are those of an arc.
#[must_use]
pub fn unseen(curve: &Ellipse, alpha: &[f64], noise: [f64; 2]) -> [bool; 2] {
    use std::f64::consts::{FRAC_PI_2, PI};
    // Nearest sample to an angle, as 1 − cos of the way to it.
    let missed = |end: f64| {
        let near = alpha.iter().map(|a| (a - end).cos());
        1.0 - near.fold(-1.0, f64::max)
    };
    let channel = |size: f64, first: f64, noise: f64| {
        [first, first + PI]
            .map(missed)
            .into_iter()
            .fold(0.0, f64::max)
            * size
            > noise
    };
    [
        channel(curve.a_c, 0.0, noise[0]),
        channel(curve.a_s, curve.beta + FRAC_PI_2, noise[1]),
    ]
}

/// Repetitions of the recording.
const REPEATS: usize = 100;

/// The recording made again and again, with the noise that it has, about the curve that fits it. Extremes depend on few
/// samples, so no formula from the samples themselves tells their scatter.
#[must_use]
pub fn repeats(cos: &[f64], sin: &[f64], curve: &Ellipse, noise: [f64; 2]) -> Option<Repeats> {
    // The same numbers every time: a calibration is a function of its recording.
    let mut random = StdRng::seed_from_u64(0);
    let mut draw = |sigma: f64| -> f64 {
        let normal: f64 = StandardNormal.sample(&mut random);
        sigma * normal
    };
    let pairs = cos.iter().zip(sin);
    let clean: Vec<_> = pairs
        .map(|(c, s)| curve.point(curve.angle(*c, *s) * std::f64::consts::TAU))
        .collect();
    let mut all = Vec::with_capacity(REPEATS);
    let (mut c, mut s) = (vec![0.0; clean.len()], vec![0.0; clean.len()]);
    for _ in 0..REPEATS {
        for (k, y) in clean.iter().enumerate() {
            (c[k], s[k]) = (y.x + draw(noise[0]), y.y + draw(noise[1]));
        }
        all.push(extremes(&c, &s)?.parameters());
    }
    let n = REPEATS as f64;
    let mean = all.iter().sum::<Parameters>() / n;
    let mut covariance = SMatrix::zeros();
    for one in &all {
        covariance += (one - mean) * (one - mean).transpose() / (n - 1.0);
    }
    let bias = mean - curve.parameters();
    Some(Repeats { covariance, bias })
}
