//! What a candidate explains of what is left, and whether it can be that at all.

use crate::causes::candidate::{Candidate, Domain, Sign};
use crate::finding::Cause;
use crate::model::{Fit, System, atoms_of};
use crate::numerics::solve::Solution;
use crate::numerics::statistics::by_chance;
use crate::select::beside::Beside;
use crate::shapes::library::Shape;

/// Global probability below which a cause is shown.
pub(crate) const SHOWN: f64 = 1e-3;
/// Kinds of cause that are tried.
pub(crate) const KINDS: f64 = 22.0;
/// So many times the number on its grid, an amount that is that number may be.
const GRID: f64 = 3.0;
/// Most that a cause of which little is seen does, in amplitudes rms.
const LARGEST: f64 = 0.1;
/// Share of that from which on one is nearly as large.
const NEARLY: f64 = 0.3;
/// Share of the power of what it does that is little.
const SEEN: f64 = 0.05;
/// Gain in log-likelihood (an SNR of 4) that a cause has to have beyond how it was when the recording began.
pub(crate) const ITSELF: f64 = 8.0;
/// Gain in log-likelihood (an SNR of 24) from which on a cause is clear.
pub(crate) const CLEAR: f64 = 300.0;
/// Share of the best gain below which another cause is no rival.
pub(crate) const RIVALS: f64 = 0.6;

/// A candidate beside what is known.
pub(crate) struct Scored {
    pub(crate) candidate: Candidate,
    pub(crate) gain: f64,
    pub(crate) freedom: usize,
    pub(crate) log_p: f64,
    /// All that it does, what five parameters and motion can do as well included, in units of the noise.
    pub(crate) size: f64,
}

impl Scored {
    /// ln of the probability that noise with so many times the variance of even noise explains as much by chance.
    pub(crate) fn by_chance(&self, inflation: f64) -> f64 {
        let trials = self.candidate.trials * KINDS;
        by_chance(self.gain, inflation, self.freedom, trials)
    }

    /// Log-likelihood that it explains, each number at its price.
    pub(crate) fn paid(&self, price: f64) -> f64 {
        self.gain - price * self.freedom as f64
    }
}

/// Share of the largest of a cause's amounts that another may be below zero and be none.
const SMALL: f64 = 0.1;

/// Whether a cause can have the amounts of a solution.
fn possible(candidate: &Candidate, solution: &Solution) -> bool {
    can_be(candidate, &solution.x, |i| {
        solution.covariance[(i, i)].sqrt()
    })
}

/// Whether a cause can have these amounts, with these standard errors.
pub(crate) fn can_be(candidate: &Candidate, own: &[f64], error: impl Fn(usize) -> f64) -> bool {
    match candidate.sign {
        Sign::Any => true,
        Sign::Positive => {
            let most = own.iter().copied().fold(f64::MIN, f64::max);
            // Of a large one a threshold that is not fitted yet leaves more than the noise does.
            let below_zero = |(i, x): (usize, &f64)| *x < -4.0 * error(i) && *x < -SMALL * most;
            most > 0.0 && !own.iter().enumerate().any(below_zero)
        }
        Sign::Known(least) => candidate.inner().is_none_or(|f| {
            let near = own[0] > least && own[0] < f * GRID;
            // A fitted number may have left its place on the grid.
            let (low, high) = (least.min(f), least.max(f));
            near || (own[0] - own[0].clamp(low, high)).abs() < 4.0 * error(0)
        }),
    }
}

/// Whether more of a cause is seen than how it was when the recording began.
fn shows(beside: &Beside, candidate: &Candidate, gain: f64) -> bool {
    candidate.given() == 0 || gain - beside.gain(&candidate.shapes[1..]).0 > ITSELF
}

pub(crate) fn score(beside: &Beside, candidate: Candidate) -> Option<Scored> {
    let solution = beside.solve(&candidate.shapes);
    let (gain, freedom) = (solution.gain(), solution.rank);
    if freedom == 0 || !gain.is_finite() {
        return None;
    }
    if !possible(&candidate, &solution) || !shows(beside, &candidate, gain) {
        return None;
    }
    if candidate.domain != Domain::Motion
        && !beside.in_radius(&candidate.shapes, &solution.x, freedom, candidate.by_radius)
    {
        return None;
    }
    let log_p = by_chance(gain, 1.0, freedom, candidate.trials * KINDS);
    let size = beside.size(&candidate.shapes, &solution.x);
    Some(Scored {
        candidate,
        gain,
        freedom,
        log_p,
        size,
    })
}

/// Drops causes that cannot be so large. Where little of it is seen, as of a delay at a speed that hardly changes, the rest would
/// have to be made up for by opposite errors of offset, gain and phase. Not so of a high pass: it turns and shrinks both
/// channels alike, which nobody sees. Returns harmonics of the scale period among them: of those the motion may hide a half, which the fit
/// makes of any size, and another may be the half that is seen.
pub(crate) fn retain_likely(system: &System, list: &mut Vec<Scored>) -> Vec<Scored> {
    let samples: f64 = system.context.weight.iter().sum();
    let large = LARGEST * (2.0 * samples).sqrt() / system.noise();
    let kept = list.iter().filter(|s| is_likely(s, large));
    let best = kept.min_by(|a, b| a.log_p.total_cmp(&b.log_p));
    // One that is hardly smaller has no more right to be than they have.
    let gain = best.filter(|s| !is_likely(s, NEARLY * large));
    let gain = gain.map(|s| s.gain);
    let likely =
        |s: &Scored| is_likely(s, large) || gain.is_some_and(|gain| s.gain > RIVALS * gain);
    let (kept, mut dropped) = std::mem::take(list).into_iter().partition(likely);
    *list = kept;
    dropped.retain(|s| s.candidate.order.is_some());
    dropped
}

/// The same for one that is large from a size on.
fn is_likely(scored: &Scored, large: f64) -> bool {
    if scored.candidate.name == Cause::AcCoupling {
        return true;
    }
    // At constant speed, a line at the signals' own frequency is an offset or a gain of them, and hardly seen.
    let hidden = matches!(
        scored.candidate.domain,
        Domain::Speed | Domain::Angle | Domain::Line
    );
    !hidden || scored.size < large || 2.0 * scored.gain > SEEN * scored.size.powi(2)
}

/// Of candidates with functions of their own, those that explain something, or could rival a gain of `most`.
pub(crate) fn worth(
    system: &mut System,
    fit: &Fit,
    list: Vec<Candidate>,
    most: f64,
) -> Vec<Scored> {
    let all = list.iter().flat_map(|c| &c.shapes).chain(&fit.shapes);
    let atoms = atoms_of(&all.cloned().collect::<Vec<_>>());
    let whole = system.among(&atoms);
    let among = |shapes: &[Shape]| Shape::all_among(shapes, &atoms);
    let known = among(&fit.shapes);
    let beside = Beside::new(&whole, &known).where_it_moves(system, &known, &atoms);
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
