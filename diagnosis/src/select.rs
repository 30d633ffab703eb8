//! Which causes are in a recording: the one that explains most first, rivals named, unknown shapes left unnamed.

use crate::cause::{Candidate, Domain, Estimate};
use crate::causes::{self, Catalogue};
use crate::context::Context;
use crate::finding::{Finding, Gain};
use crate::library::Shape;
use crate::model::{Fit, Halves, System, amounts};
use crate::solve::Normal;
use crate::statistics::{after_trials, log_tail};

/// Global probability below which a cause is shown.
const SHOWN: f64 = 3e-4;
/// Kinds of cause that are tried.
const KINDS: f64 = 22.0;
/// A cause must hold this share of what a generic basis of its domain explains.
const HOLDS: f64 = 0.75;
/// Most causes of one recording.
const MOST: usize = 8;
/// A cause that adds less than this probability says nothing new.
const NOTHING_NEW: f64 = 1e-3;

/// A cause that was accepted; its shapes stand in the fit from `first` on.
pub(crate) struct Accepted {
    pub(crate) candidate: Candidate,
    first: usize,
    confounded: Vec<String>,
}

/// What cannot be named.
#[derive(Clone, Debug)]
pub(crate) struct Unnamed {
    pub(crate) log_p: f64,
    pub(crate) signature: String,
}

/// The end of the selection.
pub(crate) struct Selection {
    pub(crate) fit: Fit,
    pub(crate) base: Fit,
    pub(crate) accepted: Vec<Accepted>,
    pub(crate) unnamed: Vec<Unnamed>,
}

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
    fn new(system: &'a System, shapes: &[Shape]) -> Self {
        Self {
            whole: &system.total,
            rest: system.total.deflated(shapes),
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
        system.extend();
        let beside = Beside::new(system, &fit.shapes);
        let candidates = catalogue.candidates.iter().cloned().chain(shown);
        let mut scored: Vec<Scored> = candidates
            .filter(|c| !closed.contains(&c.domain) && !refused.contains(&c.name))
            .filter_map(|c| score(&beside, c))
            .collect();
        scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
        if scored.is_empty() || scored[0].log_p > SHOWN.ln() {
            break;
        }
        let best = scored.remove(0);
        let best = refined(system, &fit, best);
        let beside = Beside::new(system, &fit.shapes);
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
    let used: std::collections::BTreeSet<usize> = fit
        .shapes
        .iter()
        .flat_map(|s| s.0.iter().map(|p| p.0))
        .collect();
    let map = system.retain(|i| i < fixed || used.contains(&i));
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
        let beside = Beside::new(system, &fit.shapes);
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
        let beside = Beside::new(system, &fit.shapes);
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
        if other.gain < 0.6 * best.gain || other.freedom > best.freedom + 1 {
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
    let mut beside = Beside::new(system, &named);
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
        beside = Beside::new(system, &named);
    }
    let (beyond, freedom) = beside.gain(basis);
    // What as many free numbers explain of noise alone does not count against it.
    let spread = (2.0 * freedom as f64).sqrt();
    let beyond = (beyond - freedom as f64 / 2.0 - 2.0 * spread).max(0.0);
    held / (held + beyond)
}

/// Domains in which something significant is left that no cause was found for.
fn leftover(system: &System, catalogue: &Catalogue, fit: &Fit, closed: &[Domain]) -> Vec<Unnamed> {
    let beside = Beside::new(system, &fit.shapes);
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

impl Selection {
    /// The findings, the one that explains most first.
    pub(crate) fn findings(&self, system: &System, halves: &Halves) -> Vec<Finding> {
        let mut list = vec![];
        for (i, accepted) in self.accepted.iter().enumerate() {
            let count = accepted.candidate.shapes.len();
            let range = accepted.first..accepted.first + count;
            let error: Vec<f64> = range
                .clone()
                .map(|k| self.fit.solution.covariance[(k, k)].sqrt())
                .collect();
            let parameters = (accepted.candidate.parameters)(&Estimate {
                x: &self.fit.solution.x[range.clone()],
                error: &error,
            });
            let shapes = self.fit.shapes.iter().enumerate();
            let others = shapes.filter(|(k, _)| !range.contains(k));
            let without = system.fit(others.map(|(_, s)| s.clone()).collect());
            // What the others explain as well in the end is no finding of its own.
            let gain = self.fit.solution.gain() - without.solution.gain();
            let freedom = self.fit.solution.rank.saturating_sub(without.solution.rank);
            let trials = accepted.candidate.trials * KINDS;
            let log_p = after_trials(log_tail(2.0 * gain, freedom), trials);
            if freedom == 0 || log_p > SHOWN.ln() {
                continue;
            }
            let p_value = log_p.exp();
            let seen = (accepted.candidate.evidence)(&parameters);
            list.push(Finding {
                cause: accepted.candidate.name.into(),
                confounded_with: accepted.confounded.clone(),
                p_value,
                evidence: format!("{seen}; it raises the log-likelihood by {gain:.1}"),
                parameters,
                gain: Gain {
                    held_out_residual_rms_before: halves.held_out(&without.shapes),
                    held_out_residual_rms_after: halves.held_out(&self.fit.shapes),
                    position_error_rms_before_rad: halves.position_error(&without),
                    position_error_rms_after_rad: halves.position_error(&self.fit),
                },
                chip: accepted.candidate.chip,
                weight: gain - i as f64 * 1e-9,
            });
        }
        list.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        list
    }

    /// The five parameters and every accepted cause that is no motion, with their amounts.
    pub(crate) fn sensor_amounts(&self) -> Vec<(usize, f64)> {
        let of_motion = |k: usize| {
            self.accepted.iter().any(|a| {
                let range = a.first..a.first + a.candidate.shapes.len();
                a.candidate.motion && range.contains(&k)
            })
        };
        let own = self.base.shapes.len();
        let named = |k: &usize| {
            *k < own
                || self.accepted.iter().any(|a| {
                    let range = a.first..a.first + a.candidate.shapes.len();
                    range.contains(k)
                })
        };
        let kept: Vec<usize> = (0..self.fit.shapes.len())
            .filter(|k| named(k) && !of_motion(*k))
            .collect();
        let shapes: Vec<Shape> = kept.iter().map(|k| self.fit.shapes[*k].clone()).collect();
        let x: Vec<f64> = kept.iter().map(|k| self.fit.solution.x[*k]).collect();
        amounts(&shapes, &x)
    }
}
