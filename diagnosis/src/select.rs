//! Which causes are in a recording: the one that explains most first, rivals named, unknown shapes left unnamed.

use crate::cause::{Candidate, Domain};
use crate::causes::{self, Catalogue};
use crate::context::Context;
use crate::exact::{self, Start};
use crate::library::Shape;
use crate::model::{Fit, System, atoms_of};
use crate::selection::{Accepted, Selection, Unnamed};
use crate::solve::{Normal, Solution};
use crate::statistics::{after_trials, log_tail};

/// Global probability below which a cause is shown.
pub(crate) const SHOWN: f64 = 3e-4;
/// Kinds of cause that are tried.
pub(crate) const KINDS: f64 = 22.0;
/// A cause must hold this share of what a generic basis of its domain explains.
const HOLDS: f64 = 0.75;
/// Most causes of one recording.
const MOST: usize = 8;
/// Share of the best gain below which another cause is no rival.
const RIVALS: f64 = 0.6;
/// Gain in log-likelihood (an SNR of 300) from which on a choice between causes is made where tangents are exact.
const LARGE: f64 = 45_000.0;
/// Most others that are tried there.
const OTHERS: usize = 3;
/// Share of the best gain from which on another cause may stand in for one that does not hold.
const NEARLY: f64 = 0.8;
/// A cause that adds less than this probability says nothing new.
const NOTHING_NEW: f64 = 1e-3;

struct Scored {
    candidate: Candidate,
    gain: f64,
    freedom: usize,
    log_p: f64,
}

/// The normal equations with the fit taken off, and how much it explains.
pub(crate) struct Beside<'a> {
    whole: &'a Normal,
    rest: Normal,
}

impl<'a> Beside<'a> {
    pub(crate) fn new(whole: &'a Normal, shapes: &[Shape]) -> Self {
        Self {
            whole,
            rest: whole.deflated(shapes),
        }
    }

    /// What shapes explain beside the fit, and how many numbers they have for it.
    pub(crate) fn gain(&self, shapes: &[Shape]) -> (f64, usize) {
        let solution = self.solve(shapes);
        (solution.gain(), solution.rank)
    }

    /// The amounts of shapes beside the fit.
    pub(crate) fn solve(&self, shapes: &[Shape]) -> Solution {
        self.rest.solve_beside(self.whole, shapes)
    }
}

/// Shapes of one list, then of the other.
fn both(a: &[Shape], b: &[Shape]) -> Vec<Shape> {
    a.iter().chain(b).cloned().collect()
}

fn score(beside: &Beside, candidate: Candidate) -> Option<Scored> {
    let solution = beside.solve(&candidate.shapes);
    let (gain, freedom) = (solution.gain(), solution.rank);
    if freedom == 0 || !gain.is_finite() {
        return None;
    }
    let own = &solution.x;
    let below_zero = |(i, x): (usize, &f64)| {
        let error = solution.covariance[(i, i)].sqrt();
        *x < -4.0 * error
    };
    let most = own.iter().copied().fold(f64::MIN, f64::max);
    if candidate.positive && (most <= 0.0 || own.iter().enumerate().any(below_zero)) {
        return None;
    }
    let log_p = after_trials(log_tail(2.0 * gain, freedom), candidate.trials * KINDS);
    Some(Scored {
        candidate,
        gain,
        freedom,
        log_p,
    })
}

/// Of candidates with functions of their own, those that explain something, or could rival a gain of `most`.
fn worth(system: &mut System, fit: &Fit, list: Vec<Candidate>, most: f64) -> Vec<Scored> {
    let all = list.iter().flat_map(|c| &c.shapes).chain(&fit.shapes);
    let atoms = atoms_of(&all.cloned().collect::<Vec<_>>());
    let whole = system.among(&atoms);
    let among =
        |shapes: &[Shape]| -> Vec<Shape> { shapes.iter().map(|s| s.among(&atoms)).collect() };
    let beside = Beside::new(&whole, &among(&fit.shapes));
    let mut scored: Vec<Scored> = list
        .into_iter()
        .filter_map(|mut candidate| {
            let own = std::mem::take(&mut candidate.shapes);
            candidate.shapes = among(&own);
            let mut scored = score(&beside, candidate)?;
            scored.candidate.shapes = own;
            Some(scored)
        })
        .collect();
    let most = scored.iter().map(|s| s.gain).fold(most, f64::max);
    scored.retain(|s| s.log_p < SHOWN.ln() && s.gain > RIVALS * most);
    scored
}

/// Takes the functions of these candidates in, and drops those of all others.
fn take_in(system: &mut System, fixed: usize, fit: &Fit, mut list: Vec<Scored>) -> Vec<Scored> {
    let own = list.iter().flat_map(|s| &s.candidate.shapes);
    let used = atoms_of(&own.chain(&fit.shapes).cloned().collect::<Vec<_>>());
    // What the fit has stands before what is new, so that its numbers stay.
    let map = system.retain(|i| i < fixed || used.binary_search(&i).is_ok());
    for shape in list.iter_mut().flat_map(|s| &mut s.candidate.shapes) {
        *shape = shape.mapped(&map);
    }
    system.extend();
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
    // What stands beside a cause has changed since its numbers were fitted.
    for i in 0..accepted.len() {
        let range = accepted[i].range();
        let others = fit.shapes.iter().enumerate();
        let others: Vec<Shape> = others
            .filter(|(k, _)| !range.contains(k))
            .map(|(_, s)| s.clone())
            .collect();
        let gain = fit.solution.gain() - system.fit(others.clone()).solution.gain();
        exact::tuned(system, &others, &mut accepted[i], gain);
        let mut shapes = fit.shapes.clone();
        shapes.splice(range, accepted[i].candidate.shapes.iter().cloned());
        fit = system.fit(shapes);
    }
    let mut found = Selection {
        fit,
        base,
        accepted,
        unnamed: vec![],
        again: vec![],
    };
    // Functions that were made for the known causes and that no shape uses.
    keep_used(system, catalogue.atoms, &mut found);
    if !found.accepted.is_empty() && !exact::tangents_do(system, &found.fit, &found.accepted) {
        found.again = vec![exact::start(system, &found.fit, &found.accepted)];
    }
    found
}

/// Accepts causes one after the other, beside those that are known; ends where the tangents do not do, unless this is
/// the last look.
pub(crate) fn select(
    context: &Context,
    system: &mut System,
    catalogue: &Catalogue,
    carried: Vec<Accepted>,
    last: bool,
) -> Selection {
    let fixed = catalogue.atoms;
    let mut found = begin(system, catalogue, carried);
    if !last && !found.again.is_empty() {
        return found;
    }
    found.again.clear();
    let mut closed: Vec<Domain> = vec![];
    let mut refused: Vec<&'static str> = vec![];
    while found.accepted.len() + found.unnamed.len() < MOST {
        let residual = system.residual(&found.fit);
        let shown = causes::shown(context, &residual, &mut system.samples.library);
        let open = |c: &Candidate| !closed.contains(&c.domain) && !refused.contains(&c.name);
        let beside = Beside::new(&system.total, &found.fit.shapes);
        let known = catalogue.candidates.iter().filter(|c| open(c));
        let mut scored: Vec<Scored> = known.filter_map(|c| score(&beside, c.clone())).collect();
        let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
        let shown = shown.into_iter().filter(open).collect();
        let worth = worth(system, &found.fit, shown, most);
        scored.extend(take_in(system, fixed, &found.fit, worth));
        scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
        if scored.is_empty() || scored[0].log_p > SHOWN.ln() {
            break;
        }
        match contender(system, catalogue, &found.fit, scored) {
            Contender::Unnamed(unnamed, domain, shapes) => {
                found.unnamed.push(unnamed);
                closed.push(domain);
                let generic = both(&found.fit.shapes, catalogue.basis(domain));
                found.fit = system.fit(both(&generic, &shapes));
            }
            Contender::Named(mut cause, others) => {
                cause.first = found.fit.shapes.len();
                let shapes = both(&found.fit.shapes, &cause.candidate.shapes);
                let halves = system.halves(&shapes);
                // What does not hold on data that was not fitted is no cause.
                if halves.held_out(&shapes) > halves.held_out(&found.fit.shapes) * 1.01 {
                    refused.push(cause.candidate.name);
                } else {
                    let before = found.fit;
                    found.accepted.push(*cause);
                    found.fit = system.fit(shapes);
                    if !last && !exact::tangents_do(system, &found.fit, &found.accepted) {
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
    let left = leftover(system, catalogue, &found.fit, &closed);
    found.unnamed.extend(left);
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

/// The cause to accept and others that may turn out better where tangents are exact, or what cannot be named in its
/// domain.
enum Contender {
    Named(Box<Accepted>, Vec<Accepted>),
    Unnamed(Unnamed, Domain, Vec<Shape>),
}

/// The best cause that holds; one that explains nearly as much may hold where the first does not.
fn contender(
    system: &mut System,
    catalogue: &Catalogue,
    fit: &Fit,
    scored: Vec<Scored>,
) -> Contender {
    let most = scored[0].gain;
    let large = most > LARGE;
    let (mut first, mut named): (Option<Contender>, Option<Box<Accepted>>) = (None, None);
    let mut others = vec![];
    let mut tried: Vec<(&'static str, Domain)> = vec![];
    for i in 0..scored.len() {
        let best = &scored[i];
        let one = (best.candidate.name, best.candidate.domain);
        if tried.contains(&one) || best.gain < NEARLY * most {
            continue;
        }
        tried.push(one);
        let mut cause = Accepted::new(best.candidate.clone());
        exact::tuned(system, &fit.shapes, &mut cause, best.gain);
        let beside = Beside::new(&system.total, &fit.shapes);
        let own = Scored {
            gain: beside.gain(&cause.candidate.shapes).0,
            candidate: cause.candidate.clone(),
            ..*best
        };
        let rest: Vec<&Scored> = scored[..i].iter().chain(&scored[i + 1..]).collect();
        let rivals = rivals(&beside, &own, &rest);
        let held = holds(system, catalogue, fit, &own, &rest);
        if rivals.len() <= 1 && held >= HOLDS {
            cause.confounded = rivals;
            match &named {
                None => named = Some(Box::new(cause)),
                Some(_) => others.push(cause),
            }
            if large && others.len() < OTHERS {
                continue;
            }
            break;
        }
        let nearest = own.candidate.name.replace('_', " ");
        let why = if held < HOLDS {
            format!(
                "it holds {:.0} % of what any shape there explains",
                held * 100.0
            )
        } else {
            format!("{} explain it as well", rivals.join(", ").replace('_', " "))
        };
        let signature = format!(
            "{}; nearest likeness: {nearest}, but {why}",
            lives(own.candidate.domain)
        );
        let unnamed = Unnamed {
            log_p: own.log_p,
            signature,
        };
        let domain = own.candidate.domain;
        first.get_or_insert(Contender::Unnamed(unnamed, domain, own.candidate.shapes));
    }
    match (named, first) {
        (Some(cause), _) => Contender::Named(cause, others),
        (None, Some(unnamed)) => unnamed,
        // Nothing was tried: there was nothing to try.
        (None, None) => Contender::Unnamed(
            Unnamed {
                log_p: 0.0,
                signature: String::new(),
            },
            Domain::Angle,
            vec![],
        ),
    }
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

/// Causes of other names to which the best adds nothing, and that need no more parameters.
fn rivals(beside: &Beside, best: &Scored, others: &[&Scored]) -> Vec<String> {
    let mut names: Vec<String> = vec![];
    for other in others {
        let name = other.candidate.name;
        if name == best.candidate.name || names.iter().any(|n| n == name) {
            continue;
        }
        // Far behind, or bought with more parameters: no rival.
        if other.gain < RIVALS * best.gain || other.freedom > best.freedom + 1 {
            continue;
        }
        let together = both(&other.candidate.shapes, &best.candidate.shapes);
        let (gain, rank) = beside.gain(&together);
        let (adds, freedom) = (gain - other.gain, rank.saturating_sub(other.freedom));
        if freedom == 0 || log_tail(2.0 * adds, freedom) > NOTHING_NEW.ln() {
            names.push(name.to_owned());
        }
    }
    names
}

/// Share of what a generic basis of the domain explains that named shapes hold: the best one, and others of the catalogue
/// that stand beside it.
fn holds(
    system: &System,
    catalogue: &Catalogue,
    fit: &Fit,
    best: &Scored,
    others: &[&Scored],
) -> f64 {
    let basis = catalogue.basis(best.candidate.domain);
    if basis.is_empty() {
        return 1.0;
    }
    let mut named = both(&fit.shapes, &best.candidate.shapes);
    let mut held = best.gain;
    let mut beside = Beside::new(&system.total, &named);
    for _ in 0..3 {
        let next = others
            .iter()
            .filter(|o| o.candidate.domain == best.candidate.domain)
            .filter_map(|o| {
                let (gain, freedom) = beside.gain(&o.candidate.shapes);
                let log_p = after_trials(log_tail(2.0 * gain, freedom), o.candidate.trials * KINDS);
                (freedom > 0 && log_p < SHOWN.ln()).then_some((log_p, gain, o))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, gain, other)) = next else { break };
        named.extend(other.candidate.shapes.iter().cloned());
        held += gain;
        beside = Beside::new(&system.total, &named);
    }
    let (beyond, freedom) = beside.gain(basis);
    // What as many free numbers explain of noise alone does not count against it.
    let spread = (2.0 * freedom as f64).sqrt();
    let beyond = (beyond - freedom as f64 / 2.0 - 2.0 * spread).max(0.0);
    held / (held + beyond)
}

/// Domains in which something significant is left that no cause was found for.
fn leftover(system: &System, catalogue: &Catalogue, fit: &Fit, closed: &[Domain]) -> Vec<Unnamed> {
    let beside = Beside::new(&system.total, &fit.shapes);
    let open = [
        Domain::Angle,
        Domain::Speed,
        Domain::Time,
        Domain::Revolution,
    ];
    let tell = |domain: Domain| {
        let (gain, freedom) = beside.gain(catalogue.basis(domain));
        let log_p = after_trials(log_tail(2.0 * gain, freedom), 40.0);
        (log_p < SHOWN.ln()).then(|| Unnamed {
            log_p,
            signature: format!("{}; it looks like no cause of the catalogue", lives(domain)),
        })
    };
    let left = open.into_iter().filter(|d| !closed.contains(d));
    left.filter_map(tell).collect()
}

fn lives(domain: Domain) -> &'static str {
    match domain {
        Domain::Angle => "something repeats with the scale period",
        Domain::Code => "something depends on the ADC code",
        Domain::Speed => "something depends on the speed",
        Domain::Time => "something changes slowly with time",
        Domain::Line => "something stands at a fixed frequency",
        Domain::Revolution => "something repeats with the revolution",
        Domain::Motion => "something moves that the motion's spline does not follow",
    }
}
