//! Whether steps in time are what a cause was taken for: a drift follows a few of them nearly as well as they do themselves, and
//! so does what grows with the speed where that only rises.

use crate::drifts::channels::Channels;
use crate::drifts::steps::{self, Change};
use crate::finding::Cause;
use crate::model::{Fit, System};
use crate::select::beside::Beside;
use crate::select::both;
use crate::select::held::stand_beside;
use crate::select::score::Scored;
use crate::shapes::library::Shape;

/// Log-likelihood that steps explain beside the cause alone, and with other causes there, if there are any: what turns over with the
/// direction looks like steps, and what repeats with the revolution, another drift, or what goes with the speed may look like some.
/// `among` says it, given the shapes of the fit, of the cause, and of those.
fn explained(
    system: &System,
    fit: &Fit,
    own: &Scored,
    rest: &[&Scored],
    among: impl Fn(&[Shape]) -> Option<f64>,
) -> Option<f64> {
    let mut named = both(&fit.shapes, &own.candidate.shapes);
    let alone = among(&named)?;
    let before = named.len();
    stand_beside(system, &mut named, rest, |o| {
        o.candidate.name != own.candidate.name
    });
    if named.len() == before {
        return Some(alone);
    }
    among(&named)
}

/// Log-likelihood that steps in time explain of the channels, where that is more than a slow change does: then it is no drift.
pub(crate) fn instead_of_drift(
    system: &System,
    fit: &Fit,
    drift: &Scored,
    rest: &[&Scored],
) -> Option<f64> {
    let changes: &[Change] = if drift.candidate.name == Cause::GainDrift {
        &[Change::Gains, Change::Radius]
    } else {
        &[Change::Offsets]
    };
    // The five parameters and other causes as they are beside the drift: without it they are off by what they take of it.
    explained(system, fit, drift, rest, |named| {
        let range = fit.shapes.len()..fit.shapes.len() + drift.candidate.shapes.len();
        let left = system.left_but(named.to_vec(), range);
        steps::instead(Channels::of(system, &left), system.noise(), changes)
    })
}

/// Log-likelihood that steps in time explain of what is left, where that is clearly more than what grows with the speed does: where
/// the speed only rises, that is slow, too.
pub(crate) fn instead_of_speed(
    system: &System,
    fit: &Fit,
    own: &Scored,
    rest: &[&Scored],
) -> Option<f64> {
    const ANY: [Change; 3] = [Change::Gains, Change::Radius, Change::Offsets];
    /// By which share of it: tangents of what is large are off.
    const CLEARLY: f64 = 0.1;
    // What turns over with the direction has steps, and what a capacitor remembers may look like some.
    if [Cause::Hysteresis, Cause::AcCoupling].contains(&own.candidate.name) {
        return None;
    }
    let paid = system.price() * own.freedom as f64;
    explained(system, fit, own, rest, |named| {
        let mut others = named.to_vec();
        others.drain(fit.shapes.len()..fit.shapes.len() + own.candidate.shapes.len());
        let gain = Beside::new(&system.total, &others)
            .gain(&own.candidate.shapes)
            .0;
        let left = system.residual(&system.fit(others));
        let steps = steps::instead(Channels::of(system, &left), system.noise(), &ANY)?;
        (steps > (1.0 + CLEARLY) * gain - paid).then_some(steps)
    })
}

/// Whether a cause can stand in for steps that a drift was taken for: it has to explain as much as the drift did, by itself or
/// with others beside it.
pub(crate) fn stands_in(
    system: &System,
    fit: &Fit,
    scored: &[Scored],
    drift: usize,
    which: usize,
) -> bool {
    /// Share of it by which what turns over with the direction may explain less: some samples early or late.
    const TURNS: f64 = 0.02;
    let (drift, own) = (&scored[drift], &scored[which]);
    let turns = own.candidate.name == Cause::Hysteresis;
    let less = if turns { TURNS * drift.gain } else { 0.0 };
    let enough = drift.gain - less - drift.freedom as f64;
    if own.gain >= enough {
        return true;
    }
    let others: Vec<&Scored> = scored.iter().collect();
    let mut named = both(&fit.shapes, &own.candidate.shapes);
    let other = |o: &Scored| {
        ![drift, own]
            .map(|s| s.candidate.name)
            .contains(&o.candidate.name)
    };
    stand_beside(system, &mut named, &others, other);
    let beside = Beside::new(&system.total, &fit.shapes);
    beside.gain(&named[fit.shapes.len()..]).0 >= enough
}
