//! A drift that a polynomial of the catalogue follows may be an exponential, which needs fewer numbers and goes where polynomials do
//! not. Its start and its time constant are fitted with functions of their own, which cost time: it is looked for where a polynomial
//! explains about as much as anything else does. Polynomials of more numbers are not: at standstill they run away, and got gains that
//! drift by 70 % into a measured interferometer.

use crate::causes::candidate::{Candidate, Domain};
use crate::causes::{settling, tells};
use crate::drifts::channels::Channels;
use crate::drifts::steps::{self, Change};
use crate::finding::Cause;
use crate::model::tuned::{FITTED, tuned};
use crate::model::{Fit, System};
use crate::numerics::polynomial::DEGREE;
use crate::select::beside::Beside;
use crate::select::both;
use crate::select::score::{Scored, score};
use crate::select::selection::Accepted;
use crate::shapes::library::Shape;

/// Numbers from which on a polynomial bends, and may stand in for something else.
const BENDS: usize = 6;

/// A polynomial of the catalogue that explains much.
struct Polynomial {
    name: Cause,
    shapes: Vec<Shape>,
    /// Log-likelihood that it explains, its numbers paid for.
    paid: f64,
}

/// Adds the best exponential in each place of polynomials of at least that gain in log-likelihood, where it explains more than they
/// do, the numbers of either paid for; the list stays in order.
pub(crate) fn join(system: &mut System, fit: &Fit, scored: &mut Vec<Scored>, least: f64) {
    // It is as bent as the highest polynomial.
    if !tells(system.context, DEGREE) {
        return;
    }
    let price = system.price();
    let mut best: Vec<Polynomial> = vec![];
    for own in scored.iter() {
        let time = own.candidate.domain == Domain::Time && own.candidate.exact.is_none();
        // Of less, neither start nor time constant is told.
        if !time || own.candidate.shapes.len() < BENDS || own.gain < least.max(FITTED) {
            continue;
        }
        let own = Polynomial {
            name: own.candidate.name,
            shapes: own.candidate.shapes.clone(),
            paid: own.paid(price),
        };
        // Of offsets and of gains, the one that explains most for its numbers.
        match best.iter_mut().find(|b| b.name == own.name) {
            Some(other) if own.paid > other.paid => *other = own,
            Some(_) => {}
            None => best.push(own),
        }
    }
    for like in best {
        let found = exponentials(system, fit, &like);
        let best = found.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
        scored.extend(best.filter(|b| b.0 > like.paid).map(|b| b.1));
    }
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
}

/// What a candidate explains beside a fit, the numbers of its place paid for, too.
fn paid(system: &System, fit: &Fit, candidate: Candidate) -> Option<(f64, Scored)> {
    let price = system.price();
    let places = candidate.exact.as_ref().map_or(0, |e| e.inner.len());
    let beside = Beside::new(&system.total, &fit.shapes);
    let one = score(&beside, candidate)?;
    Some((one.paid(price) - price * places as f64, one))
}

/// Exponentials in the place of a polynomial.
fn exponentials(system: &mut System, fit: &Fit, like: &Polynomial) -> Vec<(f64, Scored)> {
    let Some(last) = system.context.time.last().copied() else {
        return vec![];
    };
    let (gain, change) = if like.name == Cause::GainDrift {
        (true, Change::Gains)
    } else {
        (false, Change::Offsets)
    };
    // The five parameters as they are beside the drift, and what is left without it.
    let named = both(&fit.shapes, &like.shapes);
    let range = fit.shapes.len()..named.len();
    let left = system.left_but(named, range);
    let seen = Channels::of(system, &left);
    let Some(warming) = steps::warming(seen, system.noise(), change) else {
        return vec![];
    };
    let candidates = settling(gain, last, warming, &mut system.samples.library);
    system.extend();
    let mut found = vec![];
    for candidate in candidates {
        let beside = Beside::new(&system.total, &fit.shapes);
        let gain = beside.gain(&candidate.shapes).0;
        let mut cause = Accepted::new(candidate);
        tuned(system, &fit.shapes, &mut cause, gain);
        system.extend();
        if cause.inner_error.is_none() {
            continue;
        }
        let inner = cause.candidate.exact.as_ref().map_or(&[][..], |e| &e.inner);
        // One that began before the recording did begins with it.
        if inner.get(1).is_none_or(|start| (0.0..last).contains(start)) {
            found.extend(paid(system, fit, cause.candidate));
        }
    }
    found
}
