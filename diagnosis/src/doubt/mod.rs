//! Names that do not hold in the end. A name is accepted beside what is not known yet; once everything is known, a domain
//! in which too much is left is one that its names do not explain, and what a strong error of the channel leaves is no
//! error of its own: no model holds to the last per cent.

mod bends;
pub(crate) mod codes;
pub(crate) mod curves;
pub(crate) mod simpler;
pub(crate) mod steps;

use crate::causes::Catalogue;
use crate::causes::angle::HARMONICS;
use crate::causes::candidate::{Candidate, Domain};
use crate::finding::Cause;
use crate::model::System;
use crate::select::beside::Beside;
use crate::select::held::share;
use crate::select::locked::is_at_an_order;
use crate::select::selection::{Accepted, Selection};
use crate::shapes::generic::HOLDS;
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::{Unnamed, What, explains_only, like};

/// Share of what static errors, or errors of speed, explain below which another kind of them is what the strongest one's
/// model leaves: an SNR between a fourth and a fifth of its.
pub(crate) const LEFTOVER: f64 = 0.05;

/// Share of what the strongest explains below which something may be what its model leaves: an SNR of a tenth of its.
pub(crate) const TRACE: f64 = 0.01;
/// Gain in log-likelihood (an SNR of 5) below which nothing is left of it.
const ANYTHING: f64 = 12.5;
/// Share of what one of them explains alone from which on another is as strong.
const ALIKE: f64 = 0.95;

/// Scale periods travelled from which what depends on the code is told from what depends on the angle: where each code stands at one
/// angle only, neither is what the other leaves.
pub(crate) const APART: f64 = 2.0;

/// Domains that slow noise of the channels is in: all that can be slow.
pub(crate) const SLOW_DOMAINS: [Domain; 3] = [Domain::Speed, Domain::Time, Domain::Revolution];

/// Takes names back that do not hold, and returns the domains that have none for what is in them.
pub(crate) fn doubt(system: &System, catalogue: &Catalogue, found: &mut Selection) -> Vec<Domain> {
    let mut closed = vec![];
    for domain in [
        Domain::Angle,
        Domain::Speed,
        Domain::Time,
        Domain::Revolution,
    ] {
        // Slow noise has its own name.
        if system.flicker.is_some() && SLOW_DOMAINS.contains(&domain) {
            continue;
        }
        let own: Vec<usize> = (0..found.accepted.len())
            .filter(|i| found.accepted[*i].candidate.domain.home() == domain)
            .collect();
        let one = domain == Domain::Angle && system.context.periods_travelled() < APART;
        if own.is_empty() || one {
            continue;
        }
        if let Some(unnamed) = too_much_left(system, catalogue, found, domain, &own) {
            own.iter().for_each(|i| found.accepted[*i].doubted = true);
            found.unnamed.push(unnamed);
            closed.push(domain);
        } else if matches!(domain, Domain::Angle | Domain::Speed)
            && let Some(unnamed) = leftovers(system, found, domain, &own)
        {
            found.unnamed.push(unnamed);
            closed.push(domain);
        }
    }
    if let Some(unnamed) = moves_with_the_period(system, found) {
        found.unnamed.push(unnamed);
        closed.push(Domain::Angle);
    }
    if let Some(unnamed) = bends::of_no_one_kind(system, found) {
        found.unnamed.push(unnamed);
        closed.push(Domain::Angle);
    }
    let traces = traces(system, found);
    found.unnamed.extend(traces);
    bends::may_be_the_converters(found);
    closed
}

/// Takes lines back that stand at an order of the scale period, where what goes with the angle has no name: they are part of it.
pub(crate) fn lines_at_orders(system: &System, found: &mut Selection) {
    let of_angle = |one: &Unnamed| one.domain().map(Domain::home) == Some(Domain::Angle);
    if !found.unnamed.iter().chain(&found.left).any(of_angle) {
        return;
    }
    let is_part = |one: &&mut Accepted| is_at_an_order(system.context, &one.candidate);
    let lines = found.accepted.iter_mut().filter(is_part);
    lines.for_each(|line| line.doubted = true);
}

/// Takes cogging at an order of the scale period back beside a harmonic that changes the radius at the same order, where the next harmonic that does
/// both is of an order above the last of the catalogue: one name for each half of it is none.
fn moves_with_the_period(system: &System, found: &mut Selection) -> Option<Unnamed> {
    let per = system.context.periods_per_revolution? as usize;
    let all = found.accepted.iter().map(|a| &a.candidate);
    let position = |is: &dyn Fn(&Candidate) -> bool| all.clone().position(is);
    let with_period = |c: &Candidate| c.of_revolution.filter(|order| order.is_multiple_of(per));
    let (i, beside) = (all.clone().enumerate()).find_map(|(i, cogging)| {
        let order = with_period(cogging)? / per;
        let half = |n: usize| n + 1 == order && !HARMONICS.contains(&(n + 2));
        Some((i, position(&|c| c.order.is_some_and(half))?))
    })?;
    let gain = gain_of(system, found, &[i, beside]);
    for one in [i, beside] {
        found.accepted[one].doubted = true;
    }
    let but = "the axis would have to move in step with it, as a harmonic of a higher order does by itself";
    Some(unnamed(Domain::Angle, Cause::SpatialHarmonic, gain, but))
}

/// Weak names of any kind beside an error of the sensor that is ten times as large, and any beside one that is a hundred times as
/// large: its model is not known to the last per cent, and what that leaves goes with the time as with the angle.
fn traces(system: &System, found: &mut Selection) -> Vec<Unnamed> {
    /// Log-likelihood (an SNR of 8) from which on it is something by itself.
    const WEAK: f64 = 32.0;
    /// Share below which nothing is: an SNR of a hundredth of the strongest one's.
    const LAST: f64 = 1e-4;
    if found.accepted.len() < 2 {
        return vec![];
    }
    // What has no name stands aside: it spans names, too. So does a name that was taken back, as a harmonic spans a bend.
    let everything = found.of(found.accepted.clone(), system);
    let (kept, named) = found.kept(system);
    // All that has one name is one error.
    let mut names: Vec<(Cause, Vec<usize>)> = vec![];
    for (i, one) in found.accepted.iter().enumerate() {
        let name = one.candidate.name;
        match names.iter_mut().find(|(known, _)| *known == name) {
            _ if one.candidate.motion => {}
            Some((_, own)) => own.push(i),
            None => names.push((name, vec![i])),
        }
    }
    let gain = |own: &[usize]| {
        let places = own.iter().filter_map(|i| kept.iter().position(|k| k == i));
        let places: Vec<usize> = places.collect();
        if places.is_empty() {
            all_gain_of(system, &everything, own)
        } else {
            all_gain_of(system, &named, &places)
        }
    };
    let gains: Vec<f64> = names.iter().map(|(_, own)| gain(own)).collect();
    let most = gains.iter().copied().fold(0.0, f64::max);
    let Some(strongest) = gains.iter().position(|gain| *gain >= most) else {
        return vec![];
    };
    let mut list = vec![];
    for ((name, own), gain) in names.iter().zip(&gains) {
        let sure = own.iter().any(|i| !found.accepted[*i].doubted);
        if !sure || *gain >= WEAK.min(TRACE * most).max(LAST * most) {
            continue;
        }
        own.iter().for_each(|i| found.accepted[*i].doubted = true);
        if *gain > ANYTHING {
            let domain = found.accepted[own[0]].candidate.domain;
            let but = so_small(*gain, most, names[strongest].0);
            list.push(unnamed(domain, *name, *gain, &but));
        }
    }
    list
}

/// Why something weak is no error of its own.
pub(crate) fn so_small(gain: f64, most: f64, strongest: Cause) -> String {
    format!(
        "its SNR of {:.0} is so small beside the {:.0} of {} that it may be what that model leaves",
        (2.0 * gain).sqrt(),
        (2.0 * most).sqrt(),
        strongest.plain()
    )
}

/// What the fit explains more than without some of its causes, as far as it is sure.
pub(crate) fn gain_of(system: &System, found: &Selection, own: &[usize]) -> f64 {
    let gain = |shapes: &[Shape]| system.fit(system.sure(shapes)).solution.gain();
    gain(&found.fit.shapes) - gain(&found.shapes_but(own))
}

/// The same with what is seen along the circle, of causes that the radius has shown.
fn all_gain_of(system: &System, found: &Selection, own: &[usize]) -> f64 {
    let without = system.fit(found.shapes_but(own));
    found.fit.solution.gain() - without.solution.gain()
}

/// What each of some causes explains of what they all explain, where the others do not stand beside it.
fn alone(system: &System, found: &Selection, own: &[usize]) -> impl Iterator<Item = f64> {
    let all = all_gain_of(system, found, own);
    own.iter().map(move |i| {
        let others: Vec<usize> = own.iter().copied().filter(|o| o != i).collect();
        all - all_gain_of(system, found, &others)
    })
}

/// What is taken back, and why; `gain` is what its name explained.
pub(crate) fn unnamed(domain: Domain, nearest: Cause, gain: f64, but: &str) -> Unnamed {
    Unnamed {
        log_p: -gain,
        gain,
        what: What::Error(domain, None, like(nearest, but)),
    }
}

/// More of a domain is left than its names may leave.
fn too_much_left(
    system: &System,
    catalogue: &Catalogue,
    found: &Selection,
    domain: Domain,
    own: &[usize],
) -> Option<Unnamed> {
    let beside = Beside::new(&system.total, &system.sure(&found.fit.shapes));
    let beyond = beside.gain(&system.sure(catalogue.basis(domain)));
    let gain = gain_of(system, found, own);
    let share = share(gain, beyond);
    let but = explains_only(share);
    let nearest = found.accepted[own[0]].candidate.name;
    (share < HOLDS).then(|| unnamed(domain, nearest, gain, &but))
}

/// Static errors, or errors of speed, of another kind that are a small part of the strongest. What has no name spans the
/// strongest, too, and stands aside.
fn leftovers(
    system: &System,
    found: &mut Selection,
    domain: Domain,
    own: &[usize],
) -> Option<Unnamed> {
    // A latency turns the pair by the speed, and its model leaves nothing else: beside it the others are what they are.
    let late = |i: &usize| found.accepted[*i].candidate.name == Cause::Latency;
    let with_late = own;
    let own: Vec<usize> = own.iter().copied().filter(|i| !late(i)).collect();
    let everything = found.of(found.accepted.clone(), system);
    let all = all_gain_of(system, &everything, &own);
    // A harmonic holds all that a bend does, which is nothing beside it; errors of speed hold a part of each other.
    let strength: Vec<f64> = match domain {
        Domain::Speed => own
            .iter()
            .map(|i| all_gain_of(system, &everything, &[*i]))
            .collect(),
        _ => alone(system, &everything, &own).collect(),
    };
    let most = strength.iter().copied().fold(0.0, f64::max);
    // A wider one that holds the strongest was found after it.
    let strongest = strength.iter().position(|gain| *gain > ALIKE * most)?;
    let name = found.accepted[own[strongest]].candidate.name;
    // The model of a crosstalk knows its fraction times its delay, and not the fraction by itself, which turns the pair by the speed, too.
    let own = if name == Cause::DelayedCrosstalk {
        with_late
    } else {
        &own
    };
    // The smallest goes first: without it the others explain more by themselves.
    let mut largest: Option<(f64, Cause)> = None;
    loop {
        let (kept, named) = found.kept(system);
        let gain = |i: &usize| {
            let at = kept.iter().position(|k| k == i)?;
            let other = found.accepted[*i].candidate.name != name;
            other.then(|| (all_gain_of(system, &named, &[at]), *i))
        };
        let smallest = own
            .iter()
            .filter_map(gain)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((gain, i)) = smallest.filter(|(gain, _)| *gain < LEFTOVER * all) else {
            break;
        };
        found.accepted[i].doubted = true;
        if gain > largest.map_or(ANYTHING, |l| l.0) {
            largest = Some((gain, found.accepted[i].candidate.name));
        }
    }
    let (gain, nearest) = largest?;
    Some(unnamed(domain, nearest, gain, &so_small(gain, all, name)))
}
