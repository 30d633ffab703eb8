//! Which of the causes that explain most is accepted: one that holds what any shape of its domain explains, and that no
//! more than one other explains as well.

use crate::causes::Catalogue;
use crate::causes::candidate::{Candidate, Domain, Sign};
use crate::drifts::courses;
use crate::drifts::stairs;
use crate::finding::Cause;
use crate::model::tuned::tuned;
use crate::model::{Fit, Residual, System};
use crate::select::beside::Beside;
use crate::select::examined::{Examined, Nameless};
use crate::select::locked;
use crate::select::rivals::{self, INEXACT};
use crate::select::score::{CLEAR, ITSELF, RIVALS, Scored, score};
use crate::select::selection::Accepted;
use crate::select::{astray, both};

/// Gain in log-likelihood (an SNR of 300) from which on a choice between causes is made where tangents are exact.
const LARGE: f64 = 45_000.0;
/// The same (an SNR of 95) of what goes with the speed: a delay and low passes are one to first order.
const LARGE_WITH_SPEED: f64 = 4_500.0;
/// Most others that are tried there.
const OTHERS: usize = 3;
/// Share of the best gain from which on another cause may stand in for one that does not hold.
const NEARLY: f64 = 0.8;
/// Share from which on a drift explains as much as what may be one.
const AS_WELL: f64 = 0.95;

/// The cause to accept and others that may turn out better where tangents are exact, or what cannot be named in its
/// domain and what looks most like it.
pub(crate) enum Contender {
    Named(Box<Accepted>, Vec<Accepted>),
    Unnamed(Nameless),
}

/// The best cause that holds; one that explains nearly as much may hold where the first does not. `left` is what the fit leaves;
/// `only_rivals` are not named themselves, but may be what another cannot be told from.
pub(crate) fn contender(
    system: &mut System,
    catalogue: &Catalogue,
    fit: &Fit,
    left: &Residual,
    (mut scored, only_rivals): (Vec<Scored>, &[Scored]),
) -> Contender {
    order(system, fit, &mut scored);
    let most = scored[0].gain;
    let large = match scored[0].candidate.domain {
        Domain::Speed => LARGE_WITH_SPEED,
        _ => LARGE,
    };
    let mut large = most * system.every() as f64 > large;
    let mut named: Vec<Accepted> = vec![];
    let mut nameless = None;
    let mut tried: Vec<(Cause, Domain, Option<usize>)> = vec![];
    let mut stepped = None;
    let without_reference = system.context.against_reference.is_none();
    for (i, best) in scored.iter().enumerate() {
        let one = &best.candidate;
        // Against a reference harmonics of two orders are not alike.
        let order = one.order.filter(|_| without_reference);
        let one = (one.name, one.domain, order);
        let near = |s: &&Scored| s.gain >= NEARLY * most;
        let nearly = || scored.iter().filter(near);
        if tried.contains(&one) || !near(&best) || is_a_drift(best, nearly) {
            continue;
        }
        if stepped.is_some_and(|drift: usize| !stairs::stands_in(system, fit, &scored, drift, i)) {
            continue;
        }
        tried.push(one);
        let rest: Vec<&Scored> = scored[..i].iter().chain(&scored[i + 1..]).collect();
        let alike: Vec<&Scored> = rest.iter().copied().chain(only_rivals).collect();
        let examined = Examined::of(system, catalogue, fit, left, (best, &rest, &alike));
        if examined.steps.is_some() {
            stepped.get_or_insert(i);
        }
        match examined.refusal() {
            None => {
                examined.forget(system);
                let with_speed = examined.own.candidate.domain == Domain::Speed;
                let cause = examined.accepted(system.context);
                // At a speed that hardly changes most of what it does is in the ellipse, and its second order is not.
                large |= named.is_empty() && with_speed && beyond(system, fit, &cause);
                // Which order it is may show once the motion is followed beside each.
                large |= cause.other_order.is_some() && best.gain > CLEAR;
                named.push(cause);
                if !large || named.len() > OTHERS {
                    break;
                }
            }
            Some(why) if nameless.is_none() => {
                nameless = Some(examined.nameless(system, fit, &why))
            }
            Some(_) => examined.forget(system),
        }
    }
    if named.is_empty() {
        // Where nothing was tried, there was nothing to try.
        return Contender::Unnamed(nameless.unwrap_or_default());
    }
    let best = named.remove(0);
    Contender::Named(Box::new(best), named)
}

/// The order in which causes are examined: the likeliest first, where their numbers are fitted.
fn order(system: &mut System, fit: &Fit, scored: &mut Vec<Scored>) {
    let harmonics = |s: &Scored| locked::is_of_orders(system.context, &s.candidate);
    if !scored.iter().all(harmonics) {
        scored.retain(|s| !harmonics(s));
    }
    off_the_grid(system, fit, scored);
    let near = NEARLY * scored.first().map_or(0.0, |best| best.gain);
    courses::join(system, fit, scored, near);
    fewer_first(scored);
    bends_first(system, fit, scored);
}

/// Whether a cause is a drift, or what a drift is taken for: one of those that explain nearly as much (`nearly`) says it.
fn is_a_drift<'a, I>(cause: &Scored, nearly: impl Fn() -> I) -> bool
where
    I: Iterator<Item = &'a Scored>,
{
    let (one, gain) = (&cause.candidate, cause.gain);
    let drifts = |s: &Scored| s.candidate.name == Cause::OffsetDrift && s.gain > AS_WELL * gain;
    // How it was when the recording began, at another corner, may be all of a high pass that is seen.
    let begins = |s: &Scored| s.candidate.as_drift && s.gain > gain - ITSELF;
    one.as_drift && nearly().any(drifts) || one.given() > 0 && nearly().any(begins)
}

/// Whether tangents do not do for a cause beside a fit.
fn beyond(system: &System, fit: &Fit, cause: &Accepted) -> bool {
    let mut cause = cause.clone();
    cause.first = fit.shapes.len();
    let with = system.fit(both(&fit.shapes, &cause.candidate.shapes));
    astray(system, &with, &[cause])
}

/// A number that shows twice, as an amount and by the shapes, stands on a grid that is coarse for them, and so does one that
/// drifts are compared with: the best such cause is compared with the others where its number is fitted.
fn off_the_grid(system: &mut System, fit: &Fit, scored: &mut [Scored]) {
    let twice = |c: &Candidate| matches!(c.sign, Sign::Known(_));
    let as_drift = |c: &Candidate| c.as_drift;
    for coarse in [&twice as &dyn Fn(&Candidate) -> bool, &as_drift] {
        let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
        let all = scored
            .iter_mut()
            .filter(|s| coarse(&s.candidate) && s.gain > RIVALS * most);
        let Some(best) = all.max_by(|a, b| a.gain.total_cmp(&b.gain)) else {
            continue;
        };
        let mut cause = Accepted::new(best.candidate.clone());
        tuned(system, &fit.shapes, &mut cause, best.gain);
        let beside = Beside::new(&system.total, &fit.shapes);
        if let Some(fitted) = score(&beside, cause.candidate) {
            *best = fitted;
        }
    }
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
}

/// What needs far fewer numbers for nearly as much as the best explains goes first: many numbers bend to anything, and the
/// tangents of a large cause are off by about a hundredth.
fn fewer_first(scored: &mut [Scored]) {
    /// So many fewer.
    const FEWER: usize = 3;
    let Some(best) = scored.first() else { return };
    let (name, gain, freedom) = (best.candidate.name, best.gain, best.freedom);
    let other = |s: &Scored| {
        s.candidate.name != name && s.gain > (1.0 - INEXACT) * gain && s.freedom + FEWER <= freedom
    };
    let others = (0..scored.len()).filter(|i| other(&scored[*i]));
    if let Some(at) = others.min_by_key(|i| scored[*i].freedom) {
        scored[..=at].rotate_right(1);
    }
}

/// Where the axis vibrates, what that does along the circle is in every shape that stands there, and prefers a harmonic to the bend that
/// does the same to the radius with fewer numbers: that goes first.
fn bends_first(system: &System, fit: &Fit, scored: &mut [Scored]) {
    let Some(best) = scored.first().filter(|s| s.candidate.order.is_some()) else {
        return;
    };
    let fewer = |s: &Scored| s.candidate.name.is_a_bend() && s.freedom < best.freedom;
    let as_much = |s: &Scored| rivals::as_much_of_the_radius(system, fit, best, s);
    let bends = (0..scored.len()).filter(|i| fewer(&scored[*i]) && as_much(&scored[*i]));
    if let Some(at) = bends.max_by(|a, b| scored[*a].gain.total_cmp(&scored[*b].gain)) {
        scored[..=at].rotate_right(1);
    }
}
