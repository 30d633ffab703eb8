//! Whether a line in the channels stands by itself. One whose frequency wanders, as a lamp's on a dimmer, spreads over many
//! frequencies. To a filter that tells what is next from what was, that is the colour of the noise, and the highest of its
//! crests a steady line.

use std::f64::consts::TAU;

use crate::causes::candidate::Candidate;
use crate::context::Context;
use crate::finding::Cause;
use crate::model::Residual;
use crate::numerics::lines::{pair_spectrum, window};

/// Cycles per recording up to which something is beside a line.
const BESIDE: f64 = 90.0;
/// Shares of its frequency between which: noise of the channels may be higher below.
const NEAR: [f64; 2] = [0.75, 1.5];
/// Cycles per recording that a line itself is wide, with the window of the spectrum.
const WIDE: f64 = 4.0;
/// So many times a line is what stands beside it as high: noise beside a line that is seen is half as high, hardly more.
const AS_HIGH: f64 = 0.85;
/// Steady lines that may be beside it, and higher.
const OTHERS: usize = 2;
/// Harmonics that are its own.
const HARMONICS: usize = 10;

/// Whether many things beside a line of interference are as high as it is, along the radius as well as with the angle.
pub(crate) fn is_one_of_many(
    context: &Context,
    residual: &Residual,
    candidate: &Candidate,
) -> bool {
    let line = candidate.name == Cause::Interference;
    let Some(hertz) = candidate.inner().filter(|_| line) else {
        return false;
    };
    let still = vec![0.0; residual.radial.len()];
    [&still, &residual.tangential]
        .into_iter()
        .all(|tangential| beaten(context, hertz, &residual.radial, tangential))
}

/// Whether more than a few lines beside a line are as high in the spectrum of both channels.
fn beaten(context: &Context, hertz: f64, radial: &[f64], tangential: &[f64]) -> bool {
    let n = radial.len();
    let mut channels = context.in_frame(radial, tangential);
    for channel in &mut channels {
        let values = channel.iter_mut().enumerate();
        values.for_each(|(k, v)| *v *= window(k, n));
    }
    let (power, length) = pair_spectrum(&channels[0], &channels[1]);
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
    // Along the radius a line has an image on either side of twice the angle, which are lines, too, at a constant speed.
    let turning = 2.0 * context.speed.iter().sum::<f64>() / n as f64 / TAU / context.rate;
    let turning = turning * length as f64;
    let with_images = |at: f64| [at, (turning - at).abs(), (turning + at).abs()];
    let mut known: Vec<f64> = (1..=HARMONICS).map(|m| m as f64 * own).collect();
    known.extend(with_images(own));
    let [low, high] = NEAR.map(|share| share * own);
    // Another line or two that are steady leave nothing beside them.
    for _ in 0..=OTHERS {
        let is_known = |k: &usize| known.iter().any(|at| (*k as f64 - at).abs() <= WIDE * per);
        let beside = near(low.max(own - BESIDE * per), high.min(own + BESIDE * per));
        let crest = beside
            .filter(|k| !is_known(k))
            .max_by(|a, b| power[*a].total_cmp(&power[*b]));
        let Some(crest) = crest.filter(|k| power[*k] > AS_HIGH * highest) else {
            return false;
        };
        known.extend(with_images(crest as f64));
    }
    true
}
