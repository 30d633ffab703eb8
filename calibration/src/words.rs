//! What the data cannot tell, in plain words.

use crate::ellipse::Ellipse;
use crate::gradient::{Minimum, Set};
use crate::unbiased::Fit;

const NAMES: [&str; 5] = ["a_c", "b_c", "a_s", "b_s", "beta"];
/// Standard errors above this, in amplitudes or radians, are no knowledge.
const VAGUE: f64 = 0.2;
/// Largest gap between neighbouring angles, in turns, of data that go round.
const GAP: f64 = 0.25;

/// Largest arc, in turns, in which there is no sample.
pub(crate) fn gap(ellipse: &Ellipse, cos: &[f64], sin: &[f64]) -> f64 {
    const BINS: usize = 360;
    let mut seen = [false; BINS];
    for (y_c, y_s) in cos.iter().zip(sin) {
        let (c, s) = ellipse.corrected(*y_c, *y_s);
        let turn = s.atan2(c) / std::f64::consts::TAU + 0.5;
        seen[((turn * BINS as f64) as usize).min(BINS - 1)] = true;
    }
    let (mut longest, mut run) = (0, 0);
    for k in 0..2 * BINS {
        run = if seen[k % BINS] { 0 } else { run + 1 };
        longest = longest.max(run);
    }
    longest.min(BINS) as f64 / BINS as f64
}

pub(crate) fn of_arc(gap: f64) -> Option<String> {
    (gap > GAP).then(|| {
        format!(
            "the samples leave an arc of {gap:.2} of a period empty: amplitudes, offsets and phase are told apart by \
             the arc that is there only; a whole period tells them all"
        )
    })
}

pub(crate) fn of_fit(fit: &Fit) -> Vec<String> {
    let a = fit.ellipse.amplitude();
    let mut out = vec![];
    for (i, name) in NAMES.iter().enumerate() {
        let unit = if i == 4 { 1.0 } else { a };
        let error = fit.covariance[(i, i)].sqrt() / unit;
        if error.is_nan() || error > VAGUE {
            out.push(format!(
                "{name} cannot be told from these samples: its standard error is {:.0} % of the {}",
                error * 100.0,
                if i == 4 { "radian" } else { "amplitude" }
            ));
        }
    }
    if !fit.converged {
        out.push("the fit did not come to rest: take its numbers as a rough guess".into());
    }
    out
}

pub(crate) fn of_minimum(set: Set, minimum: &Minimum) -> Vec<String> {
    let mut out = vec![];
    if matches!(set, Set::Eight | Set::Nine) {
        out.push(
            "the direction (theta_1 -1, theta_3 +1, theta_5 +1, theta_7 -1, for signals of amplitude 1) changes no \
             radius: the angle error 1/2 sin 2 alpha per unit of it cannot be seen this way, and is left as it is"
                .into(),
        );
        let more = minimum.blind.saturating_sub(1);
        if more > 0 {
            out.push(format!(
                "{more} further direction(s) of Theta cannot be told from these samples"
            ));
        }
    } else if minimum.blind > 0 {
        out.push("some direction of Theta cannot be told from these samples".into());
    }
    if !minimum.converged {
        out.push("the search did not come to rest: take its numbers as a rough guess".into());
    }
    out
}
