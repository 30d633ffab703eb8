//! A drift that a polynomial follows may be an exponential, which needs fewer numbers and goes where the polynomial does not: it is
//! looked for where a polynomial explains about as much as anything else does.

use crate::beside::Beside;
use crate::cause::Domain;
use crate::causes::settling;
use crate::channels::Channels;
use crate::contender::GAIN_DRIFT;
use crate::exact;
use crate::library::Shape;
use crate::model::{Fit, System, amounts};
use crate::score::{Scored, score};
use crate::select::both;
use crate::selection::Accepted;
use crate::statistics::price;
use crate::steps::{self, Change};

/// Numbers from which on a polynomial bends, and may stand in for something else.
const BENDS: usize = 6;

/// Adds the exponentials that explain more than the polynomials of at least that gain in log-likelihood do, the numbers of either paid
/// for; the list stays in order.
pub(crate) fn join(system: &mut System, fit: &Fit, scored: &mut Vec<Scored>, least: f64) {
    let price = price(system.context.samples() as f64);
    let bends = |s: &&Scored| {
        let time = s.candidate.domain == Domain::Time && s.candidate.exact.is_none();
        time && s.candidate.shapes.len() >= BENDS && s.gain >= least
    };
    // Of offsets and of gains, the one that explains most for its numbers.
    let mut best: Vec<&Scored> = vec![];
    for own in scored.iter().filter(bends) {
        match best
            .iter_mut()
            .find(|b| b.candidate.name == own.candidate.name)
        {
            Some(other) if own.paid(price) > other.paid(price) => *other = own,
            Some(_) => {}
            None => best.push(own),
        }
    }
    let like: Vec<(&'static str, Vec<Shape>, f64)> = best
        .into_iter()
        .map(|s| (s.candidate.name, s.candidate.shapes.clone(), s.paid(price)))
        .collect();
    for (name, shapes, paid) in like {
        if let Some(found) = exponential(system, fit, name, &shapes).filter(|e| {
            let places = e.candidate.exact.as_ref().map_or(0, |e| e.inner.len());
            e.paid(price) - price * places as f64 > paid
        }) {
            scored.push(found);
        }
    }
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
}

/// The best exponential in the place of a polynomial of these shapes.
fn exponential(
    system: &mut System,
    fit: &Fit,
    name: &'static str,
    polynomial: &[Shape],
) -> Option<Scored> {
    let last = *system.context.time.last()?;
    let (gain, change) = if name == GAIN_DRIFT {
        (true, Change::Gains)
    } else {
        (false, Change::Offsets)
    };
    // The five parameters as they are beside the drift, and what is left without it.
    let named = both(&fit.shapes, polynomial);
    let mut amounts = system.fit(named.clone()).solution.x;
    amounts[fit.shapes.len()..].fill(0.0);
    let left = system.left(&self::amounts(&named, &amounts));
    let like = steps::warming(Channels::of(system, &left), system.noise(), change)?;
    let candidates = settling(name, gain, last, like, &mut system.samples.library);
    system.extend();
    let price = price(system.context.samples() as f64);
    let mut best: Option<(f64, Scored)> = None;
    for candidate in candidates {
        let gain = Beside::new(&system.total, &fit.shapes)
            .gain(&candidate.shapes)
            .0;
        let mut cause = Accepted::new(candidate);
        exact::tuned(system, &fit.shapes, &mut cause, gain);
        system.extend();
        let inner = cause.candidate.exact.as_ref().map_or(&[][..], |e| &e.inner);
        // One that began before the recording did begins with it.
        if inner
            .get(1)
            .is_some_and(|start| !(0.0..last).contains(start))
        {
            continue;
        }
        let places = inner.len() as f64;
        let beside = Beside::new(&system.total, &fit.shapes);
        if let Some(one) = score(&beside, cause.candidate) {
            let paid = one.paid(price) - price * places;
            if best.as_ref().is_none_or(|b| paid > b.0) {
                best = Some((paid, one));
            }
        }
    }
    best.map(|b| b.1)
}
