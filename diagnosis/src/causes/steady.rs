//! Whether a line in the channels stands by itself. One whose frequency wanders, as a lamp's on a dimmer, spreads over many
//! frequencies. To a filter that tells what is next from what was, that is the colour of the noise, and the highest of its
//! crests a steady line.

use std::f64::consts::TAU;

use crate::cause::{Candidate, Domain};
use crate::context::Context;
use crate::lines::{pair_spectrum, window};
use crate::model::Residual;

/// Cycles per recording up to which something is beside a line.
const BESIDE: f64 = 90.0;
/// Shares of its frequency between which: noise of the channels may be higher below.
const NEAR: [f64; 2] = [0.75, 1.5];
/// Cycles per recording that a line itself is wide, with the window of the spectrum.
const WIDE: f64 = 4.0;
/// So many times a line is what stands beside it as high: noise beside a line that is seen is half as high, hardly more.
const AS_HIGH: f64 = 0.85;
/// Harmonics that are its own.
const HARMONICS: usize = 10;

/// Whether something beside a line of interference is as high as it is, along the radius as well as with the angle.
pub(crate) fn is_one_of_many(
    context: &Context,
    residual: &Residual,
    candidate: &Candidate,
) -> bool {
    let line = candidate.domain == Domain::Line && candidate.name == "interference";
    let Some(hertz) = candidate.inner().filter(|_| line) else {
        return false;
    };
    let still = vec![0.0; residual.radial.len()];
    [&still, &residual.tangential]
        .into_iter()
        .all(|tangential| beaten(context, hertz, &residual.radial, tangential))
}

/// Whether something beside a line is as high in the spectrum of both channels.
fn beaten(context: &Context, hertz: f64, radial: &[f64], tangential: &[f64]) -> bool {
    let n = radial.len();
    let frame = |k: usize| {
        let (r, t) = (radial[k] * window(k, n), tangential[k] * window(k, n));
        let (c, s) = (context.cos[k], context.sin[k]);
        (r * c - t * s, r * s + t * c)
    };
    let (in_c, in_s): (Vec<f64>, Vec<f64>) = (0..n).map(frame).unzip();
    let (power, length) = pair_spectrum(&in_c, &in_s);
    // Places of the spectrum in a cycle per recording.
    let per = length as f64 / n as f64;
    let own = hertz / context.rate * length as f64;
    let near = |from: f64, to: f64| {
        let from = from.max(1.0).min(power.len() as f64) as usize;
        let to = (to.max(0.0).ceil() as usize + 1).min(power.len());
        from..to.max(from)
    };
    let highest = power[near(own - WIDE * per, own + WIDE * per)]
        .iter()
        .copied()
        .fold(0.0, f64::max);
    // Along the radius a line has an image about twice the angle, which is a line, too, at a constant speed.
    let turning = context.speed.iter().sum::<f64>() / n as f64 / TAU;
    let image = (2.0 * turning.abs() / context.rate * length as f64 - own).abs();
    let is_own = |k: usize| {
        let mut places = (1..=HARMONICS).map(|m| m as f64 * own).chain([image]);
        places.any(|at| (k as f64 - at).abs() <= WIDE * per)
    };
    let [low, high] = NEAR.map(|share| share * own);
    near(low.max(own - BESIDE * per), high.min(own + BESIDE * per))
        .filter(|k| !is_own(*k))
        .any(|k| power[k] > AS_HIGH * highest)
}
