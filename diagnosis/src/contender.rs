//! Which of the causes that explain most is accepted: one that holds what any shape of its domain explains, and that no
//! more than one other explains as well.

use crate::cause::Domain;
use crate::causes::Catalogue;
use crate::exact;
use crate::library::Shape;
use crate::model::{Fit, System};
use crate::select::{Beside, KINDS, RIVALS, SHOWN, Scored, both};
use crate::selection::{Accepted, Unnamed};
use crate::statistics::{after_trials, log_tail};

/// A cause must hold this share of what a generic basis of its domain explains.
const HOLDS: f64 = 0.75;
/// Gain in log-likelihood (an SNR of 300) from which on a choice between causes is made where tangents are exact.
const LARGE: f64 = 45_000.0;
/// Most others that are tried there.
const OTHERS: usize = 3;
/// Share of the best gain from which on another cause may stand in for one that does not hold.
const NEARLY: f64 = 0.8;
/// A cause that adds less than this probability says nothing new.
const NOTHING_NEW: f64 = 1e-3;

/// The cause to accept and others that may turn out better where tangents are exact, or what cannot be named in its
/// domain.
pub(crate) enum Contender {
    Named(Box<Accepted>, Vec<Accepted>),
    Unnamed(Unnamed, Domain, Vec<Shape>),
}

/// The best cause that holds; one that explains nearly as much may hold where the first does not.
pub(crate) fn contender(
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

/// Where something lives, in words.
pub(crate) fn lives(domain: Domain) -> &'static str {
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
