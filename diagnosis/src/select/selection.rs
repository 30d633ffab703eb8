//! The end of the search: what was accepted, as findings.

use nonius_quantity::ordinal;

use crate::causes::candidate::{Candidate, Domain, Estimate};
use crate::finding::{Cause, Chip, Finding, Gain, OTHER_ORDER, Parameter};
use crate::model::exact::Start;
use crate::model::{Fit, Halves, System, amounts};
use crate::numerics::statistics::by_chance;
use crate::select::score::{KINDS, SHOWN};
use crate::shapes::generic::HOLDS;
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::Unnamed;

/// A cause that was accepted; its shapes stand in the fit from `first` on.
#[derive(Clone)]
pub(crate) struct Accepted {
    pub(crate) candidate: Candidate,
    pub(crate) first: usize,
    pub(crate) confounded: Vec<Cause>,
    /// Of a harmonic, the order that it may have as well.
    pub(crate) other_order: Option<usize>,
    /// Of a bend, the motion hides what it does along the circle.
    pub(crate) hidden: bool,
    /// The amounts at which its shapes are tangents; what is known of them is off the signals.
    pub(crate) x: Vec<f64>,
    /// Standard errors of inner numbers, where they were fitted.
    pub(crate) inner_error: Option<Vec<f64>>,
    /// So many times the variance of white noise alone, its numbers have.
    pub(crate) inflation: f64,
    /// What is left of it beside the others and what has no name, in the end.
    pub(crate) own: Own,
    /// It does not hold in the end, and gets no name.
    pub(crate) doubted: bool,
}

/// The largest share of a size that its standard error may have: beyond it a correction may add more than it takes.
pub const VAGUE: f64 = 1.0 / 3.0;

/// What a cause explains that nothing else explains.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Own {
    /// Gain in log-likelihood.
    gain: f64,
    /// Log of the probability of that by chance, after all trials.
    log_p: f64,
}

impl Own {
    /// Whether so many numbers do not explain that by chance.
    fn is_likely(&self, freedom: usize) -> bool {
        freedom > 0 && self.log_p <= SHOWN.ln()
    }
}

impl Accepted {
    /// A cause that is not known yet.
    pub(crate) fn new(candidate: Candidate) -> Self {
        Self {
            first: 0,
            confounded: vec![],
            other_order: None,
            hidden: false,
            x: vec![0.0; candidate.shapes.len()],
            inner_error: None,
            inflation: 1.0,
            own: Own::default(),
            doubted: false,
            candidate,
        }
    }

    /// Whether it has numbers that are no amounts.
    pub(crate) fn has_inner(&self) -> bool {
        let exact = self.candidate.exact.as_ref();
        exact.is_some_and(|e| !e.inner.is_empty())
    }

    /// Whether some of it is off the signals already, about which its shapes are tangents.
    pub(crate) fn is_taken_off(&self) -> bool {
        self.x.iter().any(|x| *x != 0.0)
    }

    /// How much of each atom is known.
    pub(crate) fn amounts(&self) -> Vec<(usize, f64)> {
        amounts(&self.candidate.shapes, &self.x)
    }

    /// Where its shapes stand.
    pub(crate) fn range(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.candidate.shapes.len()
    }
}

/// The fit anew without the shapes of a range.
fn without(fit: &Fit, range: &std::ops::Range<usize>, system: &System) -> Fit {
    system.fit(fit.others(range))
}

/// The end of the selection.
pub(crate) struct Selection {
    pub(crate) fit: Fit,
    pub(crate) base: Fit,
    pub(crate) accepted: Vec<Accepted>,
    pub(crate) unnamed: Vec<Unnamed>,
    /// What is left in the end and looks like no cause.
    pub(crate) left: Vec<Unnamed>,
    /// Where to look anew from, the likeliest first: something is too large for the tangents of this context.
    pub(crate) again: Vec<Start>,
    /// Rms error of the codes, in amplitudes, where it is seen in the noise.
    pub(crate) coded: f64,
    /// The part of it that looks slow.
    pub(crate) coded_slowly: f64,
    /// The reference moves in steps of which noise hides nothing: its rounding comes and goes as the axis moves.
    pub(crate) stepped: bool,
}

impl Selection {
    /// The model that can be simulated: the five parameters and the causes that are findings, without the shapes that stand
    /// in for what has no name. Those would make anything look explained.
    pub(crate) fn named(&self, system: &System) -> Self {
        let (kept, names) = self.kept(system);
        let pairs = kept.iter().zip(&names.accepted);
        let owns = pairs.map(|(i, alone)| {
            let own = self.own(&self.accepted[*i], system);
            own.or_else(|| self.held(&names, alone, system))
        });
        let owns: Vec<Option<Own>> = owns.collect();
        let pairs = || kept.iter().copied().zip(&owns);
        let idle: Vec<usize> = pairs()
            .filter_map(|(i, own)| own.is_none().then_some(i))
            .collect();
        if let Some(likeliest) = self.likeliest(&idle, system) {
            // Each of them is idle beside the others, which explain the same: one has to stay for the rest to be idle.
            let others: Vec<usize> = idle.into_iter().filter(|i| *i != likeliest).collect();
            return self.dropping(&others, system).named(system);
        }
        let findings = pairs().filter_map(|(i, own)| {
            Some(Accepted {
                own: (*own)?,
                ..self.accepted[i].clone()
            })
        });
        let mut names = self.of(findings.collect(), system);
        // What stands in for what has no name, and names that were dropped, took of them.
        let owns = names.accepted.iter().map(|one| names.own(one, system));
        let owns: Vec<Option<Own>> = owns.collect();
        for (one, own) in names.accepted.iter_mut().zip(owns) {
            one.own = own.unwrap_or(one.own);
        }
        names
    }

    /// Of some names the one that is likeliest where the rest of them is not there; nothing where none is likely, or where there are not
    /// two.
    fn likeliest(&self, some: &[usize], system: &System) -> Option<usize> {
        if some.len() < 2 {
            return None;
        }
        let alone = some.iter().filter_map(|&i| {
            let others: Vec<usize> = some.iter().copied().filter(|k| *k != i).collect();
            let at = i - others.iter().filter(|k| **k < i).count();
            let beside = self.dropping(&others, system);
            let own = beside.own(&beside.accepted[at], system)?;
            Some((i, own.log_p))
        });
        alone.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    }

    /// The same without some of the names, what has no name still in the fit.
    fn dropping(&self, some: &[usize], system: &System) -> Self {
        let accepted = self.accepted.iter().enumerate();
        let accepted = accepted.filter(|(i, _)| !some.contains(i)).map(|(_, one)| {
            let before = (0..one.first).filter(|k| self.is_of(some, *k)).count();
            Accepted {
                first: one.first - before,
                ..one.clone()
            }
        });
        self.of_fit(system.fit(self.shapes_but(some)), accepted.collect())
    }

    /// Whether one of the fit's shapes is of some of the names.
    fn is_of(&self, some: &[usize], shape: usize) -> bool {
        some.iter()
            .any(|i| self.accepted[*i].range().contains(&shape))
    }

    /// The shapes of the fit but those of some of the names.
    pub(crate) fn shapes_but(&self, some: &[usize]) -> Vec<Shape> {
        let shapes = self.fit.shapes.iter().enumerate();
        let others = shapes.filter(|(k, _)| !self.is_of(some, *k));
        others.map(|(_, shape)| shape.clone()).collect()
    }

    /// Names in a fit, and nothing else that is found.
    fn of_fit(&self, fit: Fit, accepted: Vec<Accepted>) -> Self {
        Self::of_fits(self.base.clone(), fit, accepted)
    }

    /// The five parameters, names beside them, and nothing else that is found.
    pub(crate) fn of_fits(base: Fit, fit: Fit, accepted: Vec<Accepted>) -> Self {
        Self {
            fit,
            base,
            accepted,
            unnamed: vec![],
            left: vec![],
            again: vec![],
            coded: 0.0,
            coded_slowly: 0.0,
            stepped: false,
        }
    }

    /// Fits the amounts anew.
    pub(crate) fn refit(&mut self, system: &System) {
        for fit in [&mut self.base, &mut self.fit] {
            *fit = system.fit(std::mem::take(&mut fit.shapes));
        }
    }

    /// The names that were not taken back: which they are, and what they explain alone.
    pub(crate) fn kept(&self, system: &System) -> (Vec<usize>, Self) {
        let all = 0..self.accepted.len();
        let kept: Vec<usize> = all.filter(|i| !self.accepted[*i].doubted).collect();
        let names = kept.iter().map(|i| self.accepted[*i].clone());
        let names = self.of(names.collect(), system);
        (kept, names)
    }

    /// The five parameters and these causes, without the shapes that stand in for what has no name.
    pub(crate) fn of(&self, mut accepted: Vec<Accepted>, system: &System) -> Self {
        let mut shapes = self.base.shapes.clone();
        for one in &mut accepted {
            one.first = shapes.len();
            shapes.extend(one.candidate.shapes.iter().cloned());
        }
        self.of_fit(system.fit(shapes), accepted)
    }

    /// The same where what has no name spans the cause too, as every harmonic of the period does: the cause is a finding if
    /// it holds its share of what it and all that has no name explain together.
    fn held(&self, names: &Self, accepted: &Accepted, system: &System) -> Option<Own> {
        let own = names.own(accepted, system)?;
        let more = self.fit.solution.gain() - names.fit.solution.gain();
        (own.gain >= HOLDS * (own.gain + more)).then_some(own)
    }

    /// What a cause explains; nothing where the others and what has no name explain it as well in the end: it is no finding.
    fn own(&self, accepted: &Accepted, system: &System) -> Option<Own> {
        let (own, freedom) = self.beside_others(accepted, system);
        own.is_likely(freedom).then_some(own)
    }

    /// What a cause explains beside the others and what has no name, and numbers that do.
    fn beside_others(&self, accepted: &Accepted, system: &System) -> (Own, usize) {
        let others = without(&self.fit, &accepted.range(), system);
        let gain = self.fit.solution.gain() - others.solution.gain();
        let freedom = self.fit.solution.rank.saturating_sub(others.solution.rank);
        let trials = accepted.candidate.trials * KINDS;
        let log_p = by_chance(gain, accepted.inflation, freedom, trials);
        (Own { gain, log_p }, freedom)
    }

    /// Drops, one after the other, names to which the others leave nothing: first the one that is the least worth its numbers.
    /// What is off the signals already stays.
    pub(crate) fn drop_idle(&mut self, system: &System) {
        let price = system.price();
        loop {
            let all = self.accepted.iter().enumerate();
            let idle = all
                .filter(|(_, one)| !one.is_taken_off())
                .filter_map(|(i, one)| {
                    let (own, freedom) = self.beside_others(one, system);
                    let worth = own.gain - price * freedom as f64;
                    (!own.is_likely(freedom)).then_some((i, worth))
                });
            let Some((least, _)) = idle.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                return;
            };
            let without = self.dropping(&[least], system);
            (self.fit, self.accepted) = (without.fit, without.accepted);
        }
    }

    /// The findings of what [`Self::named`] keeps; their numbers are those of the model that can be simulated.
    pub(crate) fn findings(&self, system: &System, halves: &Halves) -> Vec<Finding> {
        let mut list = vec![];
        let (fit, own) = (&self.fit, self.base.shapes.len());
        for accepted in &self.accepted {
            let range = accepted.range();
            let wider = accepted.inflation.sqrt();
            let error: Vec<f64> = range
                .clone()
                .map(|k| wider * fit.solution.covariance[(k, k)].sqrt())
                .collect();
            let inner_error: Option<Vec<f64>> = accepted
                .inner_error
                .as_ref()
                .map(|all| all.iter().map(|e| wider * e).collect());
            let mut parameters = (accepted.candidate.parameters)(&Estimate {
                x: &fit.solution.x[range.clone()],
                error: &error,
                inner: accepted.candidate.exact.as_ref().map_or(&[], |e| &e.inner),
                inner_error: inner_error.as_deref(),
            });
            let Own { gain, log_p } = accepted.own;
            let p_value = log_p.exp();
            let without = without(fit, &range, system);
            let mut seen = (accepted.candidate.evidence)(&parameters);
            if accepted.candidate.motion && accepted.confounded.is_empty() {
                seen += ", so the motion is real";
            }
            if let Some(order) = accepted.other_order {
                parameters.push(Parameter::exact(OTHER_ORDER, order as f64, "1"));
                seen += &format!(
                    "; a {} one, which errs the other way along the circle, explains it as well",
                    ordinal(order)
                );
            }
            let mut chip = accepted.candidate.chip;
            if accepted.hidden {
                seen += "; harmonics that err the other way along the circle explain it as well";
                chip = Chip::CannotCorrect;
            }
            let finding = Finding {
                cause: accepted.candidate.name,
                confounded_with: accepted.confounded.clone(),
                p_value,
                evidence: seen,
                parameters,
                gain: Gain {
                    held_out_residual_rms_before: halves.held_out(&without, own, 0),
                    held_out_residual_rms_after: halves.held_out(fit, own, 0),
                    position_error_rms_before_rad: halves.position_error(&without, own, 0),
                    position_error_rms_after_rad: halves.position_error(fit, own, 0),
                    ..Gain::of(gain)
                },
                chip,
                design: vec![],
                weight: gain,
                effect: Some(system.effect(fit, range)),
                place: None,
            };
            list.push(finding.naming_both());
        }
        list
    }

    /// What of the sensor is off the signals and is no part of the model that is `named`, as it comes back.
    pub(crate) fn taken_back(&self, named: &Self) -> Vec<(usize, f64)> {
        let is_named = |one: &Accepted| {
            let mut all = named.accepted.iter();
            all.any(|known| known.candidate.shapes == one.candidate.shapes)
        };
        let dropped = |one: &&Accepted| !one.candidate.motion && !is_named(one);
        let back = self.accepted.iter().filter(dropped);
        let known = back.flat_map(Accepted::amounts);
        known.map(|(atom, x)| (atom, -x)).collect()
    }

    /// Without what a position would be twice as wrong by if it were the opposite along the circle, where there is such; without anything
    /// that goes with the angle, where one of those has a vague size: they hide each other.
    pub(crate) fn sure(&self, system: &System) -> Option<Self> {
        let with_angle = |a: &Accepted| a.candidate.domain.home() == Domain::Angle;
        let vague = (self.accepted.iter()).any(|a| with_angle(a) && self.is_vague(a));
        let sure =
            |a: &&Accepted| a.other_order.is_none() && !a.hidden && !(vague && with_angle(a));
        let sure: Vec<Accepted> = self.accepted.iter().filter(sure).cloned().collect();
        (sure.len() < self.accepted.len()).then(|| self.of(sure, system))
    }

    /// Whether the amounts of a cause have so large a standard error that it may move no position.
    fn is_vague(&self, one: &Accepted) -> bool {
        let solution = &self.fit.solution;
        let square: f64 = one.range().map(|k| solution.x[k].powi(2)).sum();
        let error: f64 = one.range().map(|k| solution.covariance[(k, k)]).sum();
        one.inflation * error > VAGUE * VAGUE * square
    }

    /// The five parameters and every accepted cause that is no motion, with what they are beyond what is known.
    pub(crate) fn sensor_amounts(&self) -> Vec<(usize, f64)> {
        let own = self.base.shapes.len();
        let x = &self.fit.solution.x;
        let mut sum = amounts(&self.fit.shapes[..own], &x[..own]);
        for one in self.accepted.iter().filter(|a| !a.candidate.motion) {
            let beyond: Vec<f64> = x[one.range()]
                .iter()
                .zip(&one.x)
                .map(|(x, x0)| x - x0)
                .collect();
            sum.extend(amounts(&one.candidate.shapes, &beyond));
        }
        sum
    }
}
