//! The end of the search: what was accepted, as findings.

use crate::cause::{Candidate, Estimate};
use crate::finding::{Finding, Gain};
use crate::library::Shape;
use crate::model::{Fit, Halves, System, amounts};
use crate::select::{KINDS, SHOWN};
use crate::statistics::{after_trials, log_tail};

/// A cause that was accepted; its shapes stand in the fit from `first` on.
pub(crate) struct Accepted {
    pub(crate) candidate: Candidate,
    pub(crate) first: usize,
    pub(crate) confounded: Vec<String>,
}

impl Accepted {
    /// Where its shapes stand.
    pub(crate) fn range(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.candidate.shapes.len()
    }
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

impl Selection {
    /// The findings, the one that explains most first.
    pub(crate) fn findings(&self, system: &System, halves: &Halves) -> Vec<Finding> {
        let mut list = vec![];
        for (i, accepted) in self.accepted.iter().enumerate() {
            let range = accepted.range();
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
        let own = self.base.shapes.len();
        let sensor = self.accepted.iter().filter(|a| !a.candidate.motion);
        let kept: Vec<usize> = (0..own).chain(sensor.flat_map(Accepted::range)).collect();
        let shapes: Vec<Shape> = kept.iter().map(|k| self.fit.shapes[*k].clone()).collect();
        let x: Vec<f64> = kept.iter().map(|k| self.fit.solution.x[*k]).collect();
        amounts(&shapes, &x)
    }
}
