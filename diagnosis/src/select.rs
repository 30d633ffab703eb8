//! Which causes are in a recording: the one that explains most first, rivals named, unknown shapes left unnamed.

use crate::cause::{Candidate, Domain, Estimate};
use crate::causes;
use crate::context::Context;
use crate::finding::{Finding, Gain};
use crate::generic;
use crate::model::{Column, Fit, System};
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

/// A cause that was accepted, and where its columns are.
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
    columns: Vec<Column>,
    gain: f64,
    freedom: usize,
    log_p: f64,
}

fn score(system: &System, fit: &Fit, candidate: Candidate) -> Option<Scored> {
    let columns: Vec<Column> = candidate
        .shapes
        .iter()
        .map(|s| system.column(s, candidate.motion))
        .collect();
    let solution = fit.with(system, &columns);
    let gain = 0.5 * (solution.explained - fit.solution.explained);
    let freedom = solution.rank.saturating_sub(fit.solution.rank);
    if freedom == 0 || !gain.is_finite() {
        return None;
    }
    let own = &solution.x[fit.columns.len()..];
    let first = fit.columns.len();
    let below_zero = |(i, x): (usize, &f64)| {
        let error = solution.covariance[(first + i, first + i)].sqrt();
        *x < -4.0 * error
    };
    let most = own.iter().copied().fold(f64::MIN, f64::max);
    if candidate.positive && (most <= 0.0 || own.iter().enumerate().any(below_zero)) {
        return None;
    }
    let log_p = after_trials(log_tail(2.0 * gain, freedom), candidate.trials * KINDS);
    Some(Scored {
        candidate,
        columns,
        gain,
        freedom,
        log_p,
    })
}

/// Accepts causes one after the other.
pub(crate) fn select(context: &Context, system: &System) -> Selection {
    let parameters = context.parameters();
    let columns = parameters.iter().map(|s| system.column(s, false)).collect();
    let base = Fit::new(system, columns);
    let mut fit = base.clone();
    let mut accepted: Vec<Accepted> = vec![];
    let mut unnamed: Vec<Unnamed> = vec![];
    let mut closed: Vec<Domain> = vec![];
    let mut refused: Vec<&'static str> = vec![];
    while accepted.len() + unnamed.len() < MOST {
        let residual = system.residual(&fit.left(system));
        let mut scored: Vec<Scored> = causes::all(context, &residual)
            .into_iter()
            .filter(|c| !closed.contains(&c.domain) && !refused.contains(&c.name))
            .filter_map(|c| score(system, &fit, c))
            .collect();
        scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
        if scored.is_empty() || scored[0].log_p > SHOWN.ln() {
            break;
        }
        let best = refined(context, system, &fit, scored.remove(0));
        let rivals = rivals(system, &fit, &best, &scored);
        let held = holds(context, system, &fit, &best, &scored);
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
            let mut shapes: Vec<Column> = generic::basis(context, best.candidate.domain)
                .iter()
                .map(|s| system.column(s, false))
                .collect();
            shapes.extend(best.columns);
            fit = fit.extended(system, shapes);
            continue;
        }
        let first = fit.columns.len();
        let extended = fit.extended(system, best.columns);
        // What does not hold on data that was not fitted is no cause.
        if extended.held_out(system) > fit.held_out(system) * 1.01 {
            refused.push(best.candidate.name);
            continue;
        }
        fit = extended;
        accepted.push(Accepted {
            candidate: best.candidate,
            first,
            confounded: rivals,
        });
    }
    unnamed.extend(leftover(context, system, &fit, &closed));
    Selection {
        fit,
        base,
        accepted,
        unnamed,
    }
}

/// The same cause with the shapes of its own size.
fn refined(context: &Context, system: &System, fit: &Fit, mut best: Scored) -> Scored {
    for _ in 0..3 {
        let Some(refine) = &best.candidate.refine else {
            break;
        };
        let solution = fit.with(system, &best.columns);
        let own = &solution.x[fit.columns.len()..];
        if own.iter().any(|x| !x.is_finite() || *x <= 0.0) {
            break;
        }
        best.candidate.shapes = refine(context, own);
        let shapes = best.candidate.shapes.iter();
        best.columns = shapes
            .map(|s| system.column(s, best.candidate.motion))
            .collect();
        let solution = fit.with(system, &best.columns);
        best.gain = 0.5 * (solution.explained - fit.solution.explained);
        let log_p = log_tail(2.0 * best.gain, best.freedom);
        best.log_p = after_trials(log_p, best.candidate.trials * KINDS);
    }
    best
}

/// Causes of other names to which the best adds nothing, and that need no more parameters.
fn rivals(system: &System, fit: &Fit, best: &Scored, others: &[Scored]) -> Vec<String> {
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
        let with_other = fit.extended(system, other.columns.clone());
        let together = with_other.with(system, &best.columns);
        let adds = 0.5 * (together.explained - with_other.solution.explained);
        let freedom = together.rank.saturating_sub(with_other.solution.rank);
        if freedom == 0 || log_tail(2.0 * adds, freedom) > NOTHING_NEW.ln() {
            names.push(name.to_owned());
        }
    }
    names
}

/// Share of what a generic basis of the domain explains that named shapes hold: the best one, and others of the catalogue
/// that stand beside it.
fn holds(context: &Context, system: &System, fit: &Fit, best: &Scored, others: &[Scored]) -> f64 {
    let shapes = generic::basis(context, best.candidate.domain);
    if shapes.is_empty() {
        return 1.0;
    }
    let columns: Vec<Column> = shapes.iter().map(|s| system.column(s, false)).collect();
    let mut named = fit.extended(system, best.columns.clone());
    for _ in 0..3 {
        let beside = others
            .iter()
            .filter(|o| o.candidate.domain == best.candidate.domain)
            .filter_map(|o| {
                let solution = named.with(system, &o.columns);
                let gain = 0.5 * (solution.explained - named.solution.explained);
                let freedom = solution.rank.saturating_sub(named.solution.rank);
                let log_p = after_trials(log_tail(2.0 * gain, freedom), o.candidate.trials * KINDS);
                (freedom > 0 && log_p < SHOWN.ln()).then_some((log_p, o))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, other)) = beside else { break };
        named = named.extended(system, other.columns.clone());
    }
    let more = named.with(system, &columns);
    let beyond = 0.5 * (more.explained - named.solution.explained);
    let freedom = more.rank.saturating_sub(named.solution.rank);
    // What as many free numbers explain of noise alone does not count against it.
    let spread = (2.0 * freedom as f64).sqrt();
    let beyond = (beyond - freedom as f64 / 2.0 - 2.0 * spread).max(0.0);
    let held = 0.5 * (named.solution.explained - fit.solution.explained);
    held / (held + beyond)
}

/// Domains in which something significant is left that no cause was found for.
fn leftover(context: &Context, system: &System, fit: &Fit, closed: &[Domain]) -> Vec<Unnamed> {
    let mut list = vec![];
    for domain in [
        Domain::Angle,
        Domain::Speed,
        Domain::Time,
        Domain::Revolution,
    ] {
        if closed.contains(&domain) {
            continue;
        }
        let shapes = generic::basis(context, domain);
        if shapes.is_empty() {
            continue;
        }
        let columns: Vec<Column> = shapes.iter().map(|s| system.column(s, false)).collect();
        let solution = fit.with(system, &columns);
        let gain = 0.5 * (solution.explained - fit.solution.explained);
        let freedom = solution.rank.saturating_sub(fit.solution.rank);
        let log_p = after_trials(log_tail(2.0 * gain, freedom), 40.0);
        if log_p < SHOWN.ln() {
            list.push(Unnamed {
                log_p,
                signature: format!("{}; it looks like no cause of the catalogue", lives(domain)),
            });
        }
    }
    list
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
    pub(crate) fn findings(&self, system: &System) -> Vec<Finding> {
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
            let without: Vec<Column> = self
                .fit
                .columns
                .iter()
                .enumerate()
                .filter(|(k, _)| !range.contains(k))
                .map(|(_, c)| c.clone())
                .collect();
            let without = Fit::new(system, without);
            // What the others explain as well in the end is no finding of its own.
            let gain = 0.5 * (self.fit.solution.explained - without.solution.explained);
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
                    held_out_residual_rms_before: without.held_out(system),
                    held_out_residual_rms_after: self.fit.held_out(system),
                    position_error_rms_before_rad: without.position_error(system),
                    position_error_rms_after_rad: self.fit.position_error(system),
                },
                chip: accepted.candidate.chip,
                weight: gain - i as f64 * 1e-9,
            });
        }
        list.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        list
    }
}

impl Selection {
    /// The five parameters and every accepted cause that is no motion, with their amounts.
    pub(crate) fn sensor_shapes(&self, context: &Context) -> Vec<(crate::column::Shape, f64)> {
        let x = &self.fit.solution.x;
        let mut list: Vec<_> = context
            .parameters()
            .into_iter()
            .zip(x.iter().copied())
            .collect();
        for accepted in self.accepted.iter().filter(|a| !a.candidate.motion) {
            let amounts = x[accepted.first..].iter().copied();
            list.extend(accepted.candidate.shapes.iter().cloned().zip(amounts));
        }
        list
    }
}
