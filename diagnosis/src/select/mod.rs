//! Which causes are in a recording: the one that explains most first, rivals named, unknown shapes left unnamed.

mod ahead;
pub(crate) mod beside;
pub(crate) mod choice;
pub(crate) mod contender;
pub(crate) mod held;
mod locked;
pub(crate) mod rivals;
pub(crate) mod rounds;
pub(crate) mod score;
pub(crate) mod selection;
pub(crate) mod speed_anew;

use crate::causes::angle::is_a_circle;
use crate::causes::candidate::{Candidate, Domain};
use crate::causes::{self, Catalogue};
use crate::context::Context;
use crate::doubt::curves;
use crate::doubt::simpler::simpler;
use crate::doubt::{self, doubt};
use crate::drifts::channels::Channels;
use crate::finding::Cause;
use crate::model::exact::{self, Start};
use crate::model::{Fit, Halves, Residual, System, atoms_of};
use crate::noise::flicker::{self, records::Records};
use crate::noise::louder::{beyond_uneven_noise, widen_where_slow, widen_where_uneven};
use crate::numerics::statistics::price;
use crate::select::beside::Beside;
use crate::select::contender::{Contender, contender, paid_where_noise_shows};
use crate::select::rounds::Anew;
use crate::select::score::{CLEAR, SHOWN, Scored, retain_likely, score, worth};
use crate::select::selection::{Accepted, Selection};
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::leftover;

/// Most causes of one recording.
const MOST: usize = 8;
/// Share of what could not be named that a cause has to explain beside it to be named.
const BEYOND_UNKNOWN: f64 = 0.5;
/// What is there once: the direction turns over in one way only, of two high passes in a row the faster is nearly all, and two delays
/// are one.
pub(crate) const ONCE: [Cause; 4] = [
    Cause::Hysteresis,
    Cause::AcCoupling,
    Cause::ChannelSkew,
    Cause::BandwidthMismatch,
];

/// Shapes of one list, then of the other.
pub(crate) fn both(a: &[Shape], b: &[Shape]) -> Vec<Shape> {
    a.iter().chain(b).cloned().collect()
}

/// Where a line or motion is the best that was found, or nothing was: what stands out of the noise as it is weighed may
/// be another.
fn with_weighed(
    system: &mut System,
    fixed: usize,
    fit: &Fit,
    residual: &Residual,
    open: impl Fn(&Candidate) -> bool,
    mut scored: Vec<Scored>,
) -> Vec<Scored> {
    let line = |s: &Scored| matches!(s.candidate.domain, Domain::Line | Domain::Motion);
    let best = scored.first().filter(|s| s.log_p < SHOWN.ln());
    let most = best.map_or(0.0, |s| s.gain);
    if best.is_some_and(|s| !line(s)) {
        return scored;
    }
    let Some(weighed) = system.weighed(residual) else {
        return scored;
    };
    let (context, coloured) = (system.context, system.flicker.is_some());
    let library = &mut system.samples.library;
    let mut list = causes::shown_weighed(context, &weighed, coloured, library);
    list.retain(open);
    scored.extend(worth(system, fit, list, most));
    scored = take_in(system, fixed, fit, scored);
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
    scored
}

/// Keeps the functions of these candidates, and drops those of all others.
fn take_in(system: &mut System, fixed: usize, fit: &Fit, mut list: Vec<Scored>) -> Vec<Scored> {
    let own = list.iter().flat_map(|s| &s.candidate.shapes);
    let used = atoms_of(&own.chain(&fit.shapes).cloned().collect::<Vec<_>>());
    // What the fit has stands before what is new, so that its numbers stay.
    let map = system.retain(|i| i < fixed || used.binary_search(&i).is_ok());
    for shape in list.iter_mut().flat_map(|s| &mut s.candidate.shapes) {
        *shape = shape.mapped(&map);
    }
    list
}

/// The five parameters, and the causes that are known.
pub(crate) fn begin(
    system: &mut System,
    catalogue: &Catalogue,
    carried: Vec<Accepted>,
) -> Selection {
    let base = system.fit(catalogue.parameters.clone());
    let mut accepted = carried;
    accepted.retain(|a| !a.candidate.shapes.is_empty());
    let mut fit = base.clone();
    for one in &mut accepted {
        one.first = fit.shapes.len();
        fit = system.fit(both(&fit.shapes, &one.candidate.shapes));
    }
    let mut found = Selection::of_fits(base, fit, accepted);
    tune(system, catalogue, &mut found);
    found
}

/// Fits the inner numbers of what is accepted anew: what stands beside it has changed.
fn tune(system: &mut System, catalogue: &Catalogue, found: &mut Selection) {
    for one in &mut found.accepted {
        let range = one.range();
        let others = found.fit.others(&range);
        let gain = found.fit.solution.gain() - system.fit(others.clone()).solution.gain();
        // What all samples tell where they are tried, as far as a part of them shows it.
        let gain = gain * (system.every() / system.tried()) as f64;
        exact::tuned(system, &others, one, gain);
        found.fit = system.fit(found.fit.with_in_place(range, &one.candidate.shapes));
    }
    // Functions that were made for the known causes and that no shape uses.
    keep_used(system, catalogue.atoms, found);
}

/// Whether the tangents do not do for causes in a fit.
pub(crate) fn astray(system: &System, fit: &Fit, accepted: &[Accepted]) -> bool {
    !accepted.is_empty() && !exact::tangents_do(system, fit, accepted, exact::NAMED)
}

/// Where to look anew from, if the tangents do not do for what is known.
pub(crate) fn anew(system: &System, found: &Selection) -> Option<Start> {
    let astray = astray(system, &found.fit, &found.accepted);
    astray.then(|| exact::start(system, &found.fit, &found.accepted))
}

/// Accepts causes one after the other, beside those that are known; ends where the tangents do not do, as far as it may. In a long
/// recording, what is large is found in a part of it first.
pub(crate) fn select(
    context: &Context,
    system: &mut System,
    catalogue: &Catalogue,
    carried: Vec<Accepted>,
    may: Anew,
) -> Selection {
    let found = begin(system, catalogue, carried);
    let known = found.accepted.len();
    let mut found = search(context, system, catalogue, found, (known, may));
    if system.every() == 1 {
        return found;
    }
    if let [start] = found.again.as_mut_slice() {
        // The amounts that all samples give need not be looked at anew for their errors in a part of them.
        system.try_on_all();
        let fit = system.fit_tried(found.fit.shapes.clone());
        *start = exact::start(system, &fit, &found.accepted);
    }
    if !found.again.is_empty() {
        return found;
    }
    // What was found in a part has its numbers from all of it, and then the rest is looked for there.
    system.try_on_all();
    let mut found = begin(system, catalogue, found.accepted);
    found.fit = system.fit_tried(found.fit.shapes);
    if may.with(found.accepted.len() > known)
        && let Some(start) = anew(system, &found)
    {
        found.again = vec![start];
        return found;
    }
    system.complete();
    found.refit(system);
    let with_inner = found.accepted.iter().filter(|a| a.has_inner());
    if with_inner.count() > 1 {
        // Each was fitted beside others that were not yet.
        tune(system, catalogue, &mut found);
    }
    search(context, system, catalogue, found, (known, may))
}

/// Beside flicker noise, what is slow in the channels is that noise: drift cannot be told from it, nor can these.
pub(crate) const SLOW: [Cause; 2] = [Cause::Hysteresis, Cause::AcCoupling];

/// Log-likelihood, its numbers paid for (an SNR of 25), below which a drift may be what is seen of slow noise: a stronger one has its
/// own shape.
const FAINT: f64 = 300.0;

/// Whether what is slow is flicker noise, which goes to the system then.
fn slow_noise(system: &mut System, residual: &Residual, change: f64) -> bool {
    if system.only_white || system.flicker.is_some() {
        return false;
    }
    system.flicker = flicker::instead(Channels::of(system, residual), change);
    system.flicker.is_some()
}

/// Most that a slow change explains where noise of the channels is looked for.
fn best_change(system: &System, fit: &Fit, scored: &[Scored]) -> f64 {
    let slow = scored.iter().filter(|s| s.candidate.domain == Domain::Time);
    let best = slow.max_by(|a, b| a.gain.total_cmp(&b.gain));
    best.map_or(0.0, |s| {
        paid_where_noise_shows(system, fit, &s.candidate.shapes, s.freedom as f64).max(0.0)
    })
}

/// Accepts causes one after the other from what is known on, see [`select`].
fn search(
    context: &Context,
    system: &mut System,
    catalogue: &Catalogue,
    mut found: Selection,
    (known, may): (usize, Anew),
) -> Selection {
    let fixed = catalogue.atoms;
    if may.with(false) {
        found.again.extend(anew(system, &found));
    }
    if !found.again.is_empty() {
        return found;
    }
    let mut closed: Vec<Domain> = vec![];
    let mut refused: Vec<Cause> = vec![];
    let mut circled = false;
    if system.flicker.is_some() {
        closed.push(Domain::Time);
        refused.extend(SLOW);
    }
    while found.accepted.len() + found.unnamed.len() < MOST {
        let residual = system.residual(&found.fit);
        let coloured = system.flicker.is_some();
        let shown = causes::shown(context, &residual, coloured, &mut system.samples.library);
        let names: Vec<Cause> = found.accepted.iter().map(|a| a.candidate.name).collect();
        let open = |c: &Candidate| {
            let again = ONCE.contains(&c.name) && names.contains(&c.name);
            let circle = circled && c.order == Some(2);
            !closed.contains(&c.domain) && !refused.contains(&c.name) && !again && !circle
        };
        let beside = Beside::all_that_moves(system, &found.fit.shapes);
        let known = catalogue.candidates.iter().filter(|c| open(c));
        let mut scored: Vec<Scored> = known.filter_map(|c| score(&beside, c.clone())).collect();
        let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
        let shown = shown.into_iter().filter(open).collect();
        let worth = worth(system, &found.fit, shown, most);
        scored.extend(take_in(system, fixed, &found.fit, worth));
        retain_likely(system, &mut scored);
        scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
        scored = with_weighed(system, fixed, &found.fit, &residual, open, scored);
        if system.every() == 1 {
            scored = beyond_uneven_noise(system, &found.fit, scored);
        }
        if scored.is_empty() || scored[0].log_p > SHOWN.ln() {
            // Weak noise that is slow explains more than any slow change, where no such change is to be seen.
            let known = !found.unnamed.is_empty() || closed.contains(&Domain::Time);
            let change = || best_change(system, &found.fit, &scored);
            if system.every() == 1 && !known && slow_noise(system, &residual, change()) {
                closed.push(Domain::Time);
                refused.extend(SLOW);
                continue;
            }
            break;
        }
        // What is left of an unknown shape can look like anything.
        let unknown = found.unnamed.iter().map(|u| u.gain).fold(0.0, f64::max);
        let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
        if most < BEYOND_UNKNOWN * unknown {
            break;
        }
        let partial = system.every() > 1;
        // In a part of a long recording only what is clear is named.
        if partial && most < CLEAR {
            break;
        }
        match contender(system, catalogue, &found.fit, &residual, scored) {
            Contender::Unnamed(_) if partial => break,
            Contender::Unnamed(one) => match one.domain {
                // Real motion that is no line is the axis at work, and no error.
                Some(Domain::Motion) => refused.extend(one.name),
                // Slow noise explains it, and has a name.
                _ if one.is_noise => refused.extend(one.name),
                Some(Domain::Time) if slow_noise(system, &residual, one.paid) => {
                    closed.push(Domain::Time);
                    refused.extend(SLOW);
                }
                domain => {
                    found.unnamed.push(one.unnamed);
                    closed.extend(domain);
                    let generic = domain.map_or(&[][..], |d| catalogue.basis(d));
                    let generic = both(&found.fit.shapes, generic);
                    found.fit = system.fit(both(&generic, &one.shapes));
                }
            },
            Contender::Named(mut cause, others) => {
                cause.first = found.fit.shapes.len();
                let shapes = both(&found.fit.shapes, &cause.candidate.shapes);
                let halves = system.halves(&shapes);
                let fit = system.fit(shapes);
                let amounts = &fit.solution.x[cause.first..];
                if context.against_reference.is_none() && is_a_circle(&cause.candidate, amounts) {
                    circled = true;
                    continue;
                }
                if cause.candidate.domain == Domain::Time {
                    let gain = fit.solution.gain() - found.fit.solution.gain();
                    let numbers = cause.candidate.shapes.len() as f64;
                    let paid = gain - price(context.samples() as f64) * numbers;
                    let own = found.fit.shapes.len()..;
                    let seen =
                        paid_where_noise_shows(system, &found.fit, &fit.shapes[own], numbers);
                    if paid < FAINT && slow_noise(system, &residual, seen) {
                        closed.push(Domain::Time);
                        refused.extend(SLOW);
                        continue;
                    }
                }
                let own = found.base.shapes.len();
                // What is slow may be noise that is, and whitening would hide how far off it goes on.
                let in_noise = system.vibrates() && cause.candidate.domain != Domain::Time;
                let held_out = if in_noise {
                    Halves::held_out_in_noise
                } else {
                    Halves::held_out
                };
                let before = held_out(&halves, &found.fit, own, 0);
                let fails = held_out(&halves, &fit, own, cause.candidate.given()) > 1.01 * before;
                let (name, turns) = (cause.candidate.name, cause.candidate.factor.is_some());
                let mut accepted = found.accepted.clone();
                accepted.push(*cause);
                let anew = may.with(true) && astray(system, &fit, &accepted);
                // What does not hold on data that was not fitted is no cause, unless it turns the pair so far that its tangents do not.
                if fails && !(turns && anew) {
                    refused.push(name);
                } else {
                    let before = std::mem::replace(&mut found.fit, fit);
                    found.accepted = accepted;
                    // Second orders may decide between causes long before they show beside one of them.
                    if anew || may.with(true) && !others.is_empty() {
                        found.again = starts(system, &before, &found, others);
                    }
                }
            }
        }
        keep_used(system, fixed, &mut found);
        if !found.again.is_empty() {
            return found;
        }
    }
    let joined = found.accepted.len() > known;
    let seen =
        may.with(joined) && !exact::tangents_do(system, &found.fit, &found.accepted, exact::SEEN);
    if seen || system.every() == 1 && simpler(system, catalogue, &mut found, !may.with(true)) {
        found.again = vec![exact::start(system, &found.fit, &found.accepted)];
        return found;
    }
    if system.every() == 1 {
        closed.extend(doubt(system, catalogue, &mut found));
        let curves = curves::of_drifts(system, &mut found);
        found.unnamed.extend(curves);
        if let Some(noise) = Records::of(system) {
            closed.extend(doubt::SLOW);
            widen_where_slow(system, &mut found, &noise);
        }
        widen_where_uneven(system, &mut found);
        found.left = leftover(system, catalogue, &found.fit, &closed);
    }
    keep_used(system, fixed, &mut found);
    found
}

/// Where to look anew from: with the cause that was accepted last, or with another in its place.
fn starts(system: &System, before: &Fit, found: &Selection, others: Vec<Accepted>) -> Vec<Start> {
    let mut list = vec![exact::start(system, &found.fit, &found.accepted)];
    for mut other in others {
        other.first = before.shapes.len();
        let fit = system.fit(both(&before.shapes, &other.candidate.shapes));
        let mut accepted = found.accepted.clone();
        accepted.pop();
        accepted.push(other);
        list.push(exact::start(system, &fit, &accepted));
    }
    list
}

/// Drops the functions that were only tried.
fn keep_used(system: &mut System, fixed: usize, found: &mut Selection) {
    let used = atoms_of(&found.fit.shapes);
    let map = system.retain(|i| i < fixed || used.binary_search(&i).is_ok());
    for shape in &mut found.fit.shapes {
        *shape = shape.mapped(&map);
    }
    for one in &mut found.accepted {
        one.candidate.shapes = found.fit.shapes[one.range()].to_vec();
    }
}
