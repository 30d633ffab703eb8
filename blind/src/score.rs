//! A verdict against the truth.

use crate::baseline::{five_parameters, of_positions};
use crate::case::Case;
use crate::truth::{HiddenCause, Kind, Truth};
use crate::verdict::{Named, Verdict};

/// What became of a hidden cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Outcome {
    /// Its name comes first.
    First,
    /// First comes another name, in a declared group of two with it.
    Group,
    /// It is named, but something else comes first.
    Later,
    /// Another name alone was given.
    Misnamed,
    /// No name was given, and it was said that something is left.
    Unexplained,
    /// Nothing was said.
    Silent,
}

/// A parameter against the truth.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterScore {
    /// Which.
    pub name: String,
    /// Error over the stated standard error.
    pub stated: f64,
    /// Error over the Cramér–Rao bound, where that is |value| / SNR.
    pub bound: Option<f64>,
}

/// What a verdict is worth.
#[derive(Clone, Debug)]
pub struct Score {
    /// What was hidden.
    pub truth: Truth,
    /// For each hidden cause.
    pub outcomes: Vec<Outcome>,
    /// What came first: a name, `unexplained` or `nothing`.
    pub first: String,
    /// Sensor causes that were named and are not hidden, nor brought by what is, nor in a group with that.
    pub wrong: Vec<String>,
    /// Motions that were named and are not hidden.
    pub motions: Vec<String>,
    /// Something significant was left.
    pub unexplained: bool,
    /// What was said of it.
    pub signature: String,
    /// Parameters of what was named rightly.
    pub parameters: Vec<ParameterScore>,
    /// Systematic position error with the five parameters alone, and by the diagnosis, rad rms.
    pub position: Option<[f64; 2]>,
    /// Wall-clock time of the diagnosis, s.
    pub seconds: f64,
}

impl Score {
    /// Scores a verdict on a case by its opened truth.
    #[must_use]
    pub fn of(truth: Truth, case: &Case, verdict: &Verdict) -> Self {
        let hidden = |name: &Named| {
            truth.hidden.iter().any(|h| is(name, h, &truth)) || is_brought(name, &truth)
        };
        let strange = |motion: bool| -> Vec<String> {
            let others = verdict.named.iter().filter(|n| n.motion == motion);
            others
                .filter(|n| !hidden(n))
                .map(|n| n.cause.clone())
                .collect()
        };
        let found = |h: &HiddenCause| verdict.named.iter().any(|n| is(n, h, &truth));
        let brings = |h: &HiddenCause| !h.brings.is_empty() && found(h);
        let found = truth.hidden.iter().any(brings);
        let named = verdict.named.iter().filter(|n| counts(&truth, n, found));
        let named: Vec<&Named> = named.collect();
        let first = match named.first() {
            Some(n) => n.cause.clone(),
            None if verdict.unexplained => "unexplained".into(),
            None => "nothing".into(),
        };
        let outcomes = truth.hidden.iter();
        let outcomes = outcomes.map(|h| outcome(h, &named, verdict.unexplained, &truth));
        // Of several causes one that can be removed is enough to ask what became of the positions.
        let electrical = match truth.kind {
            Kind::Many => truth.hidden.iter().any(|h| h.electrical),
            _ => !truth.hidden.is_empty() && truth.hidden.iter().all(|h| h.electrical),
        };
        let position = electrical
            .then(|| of_positions(&case.world, &case.rows, &verdict.positions))
            .flatten()
            .map(|after| [five_parameters(&case.world, &case.rows), after]);
        Self {
            outcomes: outcomes.collect(),
            first,
            wrong: strange(false),
            motions: strange(true),
            unexplained: verdict.unexplained,
            signature: verdict.signature.clone(),
            parameters: truth
                .hidden
                .iter()
                .flat_map(|h| parameters(h, &verdict.named, &truth))
                .collect(),
            position,
            seconds: verdict.seconds,
            truth,
        }
    }

    /// SNR of the first hidden cause.
    #[must_use]
    pub fn snr(&self) -> Option<f64> {
        self.truth.hidden.first().map(|h| h.snr)
    }
}

/// A motion that is named where the axis truly vibrates is no rival of a hidden sensor cause, unless it may be that cause; nor is what a
/// hidden cause brings where that cause is `found` as well.
fn counts(truth: &Truth, named: &Named, found: bool) -> bool {
    let true_motion = named.motion && truth.vibration_rad.is_some();
    let hidden = |h: &HiddenCause| h.motion && true_motion || is(named, h, truth);
    let beside = true_motion || found && is_brought(named, truth);
    !beside || truth.hidden.iter().any(hidden)
}

/// Whether a name, or the other one of a group of two, is true of a hidden cause beside its own.
fn is_brought(named: &Named, truth: &Truth) -> bool {
    let pair = named.confounded_with.len() <= 1;
    let is = |name: &String| named.cause == *name || pair && named.holds(name);
    truth.hidden.iter().any(|h| h.brings.iter().any(is))
}

/// Whether a name, or one that it cannot be told from, is that of a hidden cause. An order that is not its own, or a frequency farther
/// from its own than four standard errors and than the recording resolves, is another cause.
fn is(named: &Named, hidden: &HiddenCause, truth: &Truth) -> bool {
    if named.cause != hidden.name {
        return named.holds(&hidden.name);
    }
    let resolved = truth.rate / truth.samples as f64;
    hidden.parameters.iter().all(|own| {
        let shown = named.parameters.iter().find(|(name, ..)| *name == own.name);
        let near = |error: f64| shown.is_none_or(|(_, x, _)| (x - own.value).abs() <= error);
        match own.name.as_str() {
            "order" => near(0.0),
            "frequency_hz" => near(shown.map_or(0.0, |p| 4.0 * p.2).max(resolved)),
            _ => true,
        }
    })
}

fn outcome(hidden: &HiddenCause, named: &[&Named], unexplained: bool, truth: &Truth) -> Outcome {
    match named.first() {
        Some(first) if first.cause == hidden.name && is(first, hidden, truth) => Outcome::First,
        Some(first) if is(first, hidden, truth) && first.confounded_with.len() == 1 => {
            Outcome::Group
        }
        _ if named.iter().any(|n| is(n, hidden, truth)) => Outcome::Later,
        Some(_) => Outcome::Misnamed,
        None if unexplained => Outcome::Unexplained,
        None => Outcome::Silent,
    }
}

fn parameters(hidden: &HiddenCause, named: &[Named], truth: &Truth) -> Vec<ParameterScore> {
    let own = |n: &&Named| n.cause == hidden.name && is(n, hidden, truth);
    let Some(found) = named.iter().find(own) else {
        return vec![];
    };
    let value = |name: &str| found.parameters.iter().find(|(n, _, _)| n == name);
    let scores = hidden.parameters.iter().filter_map(|p| {
        let (_, shown, error) = value(&p.name)?;
        (*error > 0.0).then(|| ParameterScore {
            name: p.name.clone(),
            stated: (shown - p.value) / error,
            bound: p
                .bounded
                .then(|| (shown - p.value) / (p.value.abs() / hidden.snr)),
        })
    });
    scores.collect()
}
