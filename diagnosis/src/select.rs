//! Which causes are in a recording: the one that explains most first, rivals named, unknown shapes left unnamed.

use crate::cause::{Candidate, Domain};
use crate::causes::{self, Catalogue};
use crate::context::Context;
use crate::library::Shape;
use crate::model::{Fit, System, atoms_of};
use crate::selection::{Accepted, Selection, Unnamed};
use crate::solve::Normal;
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
/// A cause that adds less than this probability says nothing new.
const NOTHING_NEW: f64 = 1e-3;

struct Scored {
    candidate: Candidate,
    gain: f64,
    freedom: usize,
    log_p: f64,
}

/// The normal equations with the fit taken off, and how much it explains.
struct Beside<'a> {
    whole: &'a Normal,
    rest: Normal,
}

impl<'a> Beside<'a> {
    fn new(whole: &'a Normal, shapes: &[Shape]) -> Self {
        Self {
            whole,
            rest: whole.deflated(shapes),
        }
    }

    /// What shapes explain beside the fit, and how many numbers they have for it.
    fn gain(&self, shapes: &[Shape]) -> (f64, usize) {
        let solution = self.rest.solve_beside(self.whole, shapes);
        (solution.gain(), solution.rank)
    }
}

/// Shapes of one list, then of the other.
fn both(a: &[Shape], b: &[Shape]) -> Vec<Shape> {
    a.iter().chain(b).cloned().collect()
}

fn score(beside: &Beside, candidate: Candidate) -> Option<Scored> {
    let solution = beside.rest.solve_beside(beside.whole, &candidate.shapes);
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

/// Accepts causes one after the other.
pub(crate) fn select(context: &Context, system: &mut System, catalogue: &Catalogue) -> Selection {
    let base = system.fit(catalogue.parameters.clone());
    let mut fit = base.clone();
    let mut accepted: Vec<Accepted> = vec![];
    let mut unnamed: Vec<Unnamed> = vec![];
    let mut closed: Vec<Domain> = vec![];
    let mut refused: Vec<&'static str> = vec![];
    let fixed = system.samples.library.atoms.len();
    while accepted.len() + unnamed.len() < MOST {
        let residual = system.residual(&fit);
        let shown = causes::shown(context, &residual, &mut system.samples.library);
        let open = |c: &Candidate| !closed.contains(&c.domain) && !refused.contains(&c.name);
        let beside = Beside::new(&system.total, &fit.shapes);
        let known = catalogue.candidates.iter().filter(|c| open(c));
        let mut scored: Vec<Scored> = known.filter_map(|c| score(&beside, c.clone())).collect();
        let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
        let worth = worth(system, &fit, shown.into_iter().filter(open).collect(), most);
        scored.extend(take_in(system, fixed, &fit, worth));
        scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
        if scored.is_empty() || scored[0].log_p > SHOWN.ln() {
            break;
        }
        let best = scored.remove(0);
        let best = refined(system, &fit, best);
        let beside = Beside::new(&system.total, &fit.shapes);
        let rivals = rivals(&beside, &best, &scored);
        let held = holds(system, catalogue, &fit, &best, &scored);
        if rivals.len() > 1 || held < HOLDS {
            let nearest = best.candidate.name.replace('_', " ");
            let why = if held < HOLDS {
                format!(
                    "it holds {:.0} % of what any shape there explains",
                    held * 100.0
                )
            } else {
                format!("{} explain it as well", rivals.join(", ").replace('_', " "))
            };
            unnamed.push(Unnamed {
                log_p: best.log_p,
                signature: format!(
                    "{}; nearest likeness: {nearest}, but {why}",
                    lives(best.candidate.domain)
                ),
            });
            closed.push(best.candidate.domain);
            let generic = both(&fit.shapes, catalogue.basis(best.candidate.domain));
            fit = system.fit(both(&generic, &best.candidate.shapes));
        } else {
            let shapes = both(&fit.shapes, &best.candidate.shapes);
            let halves = system.halves(&shapes);
            // What does not hold on data that was not fitted is no cause.
            if halves.held_out(&shapes) > halves.held_out(&fit.shapes) * 1.01 {
                refused.push(best.candidate.name);
            } else {
                accepted.push(Accepted {
                    candidate: best.candidate,
                    first: fit.shapes.len(),
                    confounded: rivals,
                });
                fit = system.fit(shapes);
            }
        }
        keep_used(system, fixed, &mut fit, &mut accepted);
    }
    unnamed.extend(leftover(system, catalogue, &fit, &closed));
    keep_used(system, fixed, &mut fit, &mut accepted);
    Selection {
        fit,
        base,
        accepted,
        unnamed,
    }
}

/// Drops the functions that were only tried.
fn keep_used(system: &mut System, fixed: usize, fit: &mut Fit, accepted: &mut [Accepted]) {
    let used = atoms_of(&fit.shapes);
    let map = system.retain(|i| i < fixed || used.binary_search(&i).is_ok());
    for shape in &mut fit.shapes {
        *shape = shape.mapped(&map);
    }
    for one in accepted {
        let count = one.candidate.shapes.len();
        one.candidate.shapes = fit.shapes[one.first..one.first + count].to_vec();
    }
}

/// The same cause with the shapes of its own size.
fn refined(system: &mut System, fit: &Fit, mut best: Scored) -> Scored {
    let Some(refine) = best.candidate.refine.clone() else {
        return best;
    };
    for _ in 0..3 {
        let beside = Beside::new(&system.total, &fit.shapes);
        let own = beside
            .rest
            .solve_beside(beside.whole, &best.candidate.shapes)
            .x;
        if own.iter().any(|x| !x.is_finite() || *x <= 0.0) {
            break;
        }
        let refine = refine.clone();
        let fill = move |block: &crate::block::Block, c: &mut [f64], s: &mut [f64]| {
            refine(block, &own, c, s);
        };
        best.candidate.shapes = vec![system.samples.library.pair(fill)];
        system.extend();
        let beside = Beside::new(&system.total, &fit.shapes);
        best.gain = beside.gain(&best.candidate.shapes).0;
        let log_p = log_tail(2.0 * best.gain, best.freedom);
        best.log_p = after_trials(log_p, best.candidate.trials * KINDS);
    }
    best
}

/// Causes of other names to which the best adds nothing, and that need no more parameters.
fn rivals(beside: &Beside, best: &Scored, others: &[Scored]) -> Vec<String> {
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
    others: &[Scored],
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
