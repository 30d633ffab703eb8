//! Which of the causes that explain most is accepted: one that holds what any shape of its domain explains, and that no
//! more than one other explains as well.

use nonius_quantity::agree;

use crate::causes::candidate::{Candidate, Domain, Sign};
use crate::causes::{self, Catalogue};
use crate::drifts::channels::Channels;
use crate::drifts::courses;
use crate::drifts::stairs;
use crate::finding::Cause;
use crate::model::exact;
use crate::model::{Fit, Residual, System};
use crate::numerics::statistics::price;
use crate::select::ahead;
use crate::select::beside::Beside;
use crate::select::held::holds;
use crate::select::locked;
use crate::select::rivals;
use crate::select::score::{ITSELF, RIVALS, Scored, score};
use crate::select::selection::Accepted;
use crate::select::{astray, both};
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::{Unnamed, What, like};

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

/// What cannot be named.
#[derive(Default)]
pub(crate) struct Nameless {
    pub(crate) unnamed: Unnamed,
    pub(crate) domain: Option<Domain>,
    /// Name of what looks most like it.
    pub(crate) name: Option<Cause>,
    /// Shapes that hold it.
    pub(crate) shapes: Vec<Shape>,
    /// Log-likelihood that it explains where noise of the channels shows, its numbers paid for, or that steps do.
    pub(crate) paid: f64,
    /// Slow noise of the channels explains it as well.
    pub(crate) is_noise: bool,
}

/// The best cause that holds; one that explains nearly as much may hold where the first does not. `left` is what the fit leaves.
pub(crate) fn contender(
    system: &mut System,
    catalogue: &Catalogue,
    fit: &Fit,
    left: &Residual,
    mut scored: Vec<Scored>,
) -> Contender {
    let harmonics = |s: &Scored| locked::is_of_orders(system.context, &s.candidate);
    if !scored.iter().all(harmonics) {
        scored.retain(|s| !harmonics(s));
    }
    off_the_grid(system, fit, &mut scored);
    let near = NEARLY * scored.first().map_or(0.0, |best| best.gain);
    courses::join(system, fit, &mut scored, near);
    fewer_first(&mut scored);
    let most = scored[0].gain;
    let large = match scored[0].candidate.domain {
        Domain::Speed => LARGE_WITH_SPEED,
        _ => LARGE,
    };
    let mut large = most * system.every() as f64 > large;
    let (mut first, mut named): (Option<Contender>, Option<Box<Accepted>>) = (None, None);
    let mut others = vec![];
    let mut tried: Vec<(Cause, Domain)> = vec![];
    let mut stepped = None;
    for i in 0..scored.len() {
        let best = &scored[i];
        let one = (best.candidate.name, best.candidate.domain);
        let near = |s: &Scored| s.gain >= NEARLY * most;
        if tried.contains(&one) || !near(best) {
            continue;
        }
        let drifts = |s: &Scored| {
            s.candidate.name == Cause::OffsetDrift && s.gain > AS_WELL * best.gain && near(s)
        };
        if best.candidate.as_drift && scored.iter().any(drifts) {
            continue;
        }
        // How it was when the recording began, at another corner, may be all of a high pass that is seen.
        let begins = |s: &Scored| s.candidate.as_drift && s.gain > best.gain - ITSELF && near(s);
        if best.candidate.given() > 0 && scored.iter().any(begins) {
            continue;
        }
        if stepped.is_some_and(|drift: usize| !stairs::stands_in(system, fit, &scored, drift, i)) {
            continue;
        }
        tried.push(one);
        let mut cause = Accepted::new(best.candidate.clone());
        exact::tuned(system, &fit.shapes, &mut cause, best.gain);
        system.extend();
        let beside = Beside::new(&system.total, &fit.shapes);
        let own = Scored {
            gain: beside.gain(&cause.candidate.shapes).0,
            candidate: cause.candidate.clone(),
            ..*best
        };
        let rest: Vec<&Scored> = scored[..i].iter().chain(&scored[i + 1..]).collect();
        let price = price(system.context.samples() as f64);
        let ahead = ahead::look(system.context, &beside, &own, &rest, price);
        let mut rivals = rivals::among(system, fit, &beside, &own, &rest);
        if rivals.is_empty() {
            rivals.extend(ahead.rival);
        }
        if rivals.is_empty() {
            rivals.extend(rivals::hidden(system, &beside, &own, catalogue));
        }
        let listed = |name: &Cause| name.is_listed();
        let richer = rivals::richer(&beside, &own, &rest).filter(listed);
        let wider = rivals::wider(&beside, &own, &rest).filter(listed);
        let other_order = rivals::other_order(&beside, &own, &rest);
        if own.candidate.as_drift {
            rivals.retain(|name| *name != Cause::OffsetDrift);
            rivals.push(Cause::OffsetDrift);
        }
        let mark = system.samples.library.atoms.len();
        let held = holds(system, catalogue, fit, &own, &rest);
        let steps = match own.candidate.domain {
            Domain::Time => stairs::instead_of_drift(system, fit, &own, &rest),
            // Slow noise looks like steps, and is known.
            Domain::Speed if held.refusal.is_none() && system.flicker.is_none() => {
                stairs::instead_of_speed(system, fit, &own, &rest)
            }
            _ => None,
        };
        let slow = steps.is_none();
        if !slow && stepped.is_none() {
            stepped = Some(i);
        }
        let locked = locked::why(system.context, &own);
        let crawling = causes::crawls(system.context, &own.candidate);
        let wandering = causes::is_one_of_many(system.context, left, &own.candidate);
        let nameable = own.candidate.name.is_listed()
            && rivals.iter().all(listed)
            && !(locked.is_some() || crawling || wandering);
        if nameable && slow && !ahead.outdone && rivals.len() <= 1 && held.refusal.is_none() {
            if rivals.is_empty() {
                rivals.extend(richer.or(wider));
            } else if system.context.periods_per_revolution == Some(1) {
                // One order is the other, and a harmonic of the scale is the likeliest.
                rivals.extend(wider.filter(|name| !rivals.contains(name)));
            }
            system.retain(|i| i < mark);
            cause.confounded = rivals;
            // At a speed that hardly changes most of what it does is in the ellipse, and its second order is not.
            large |= named.is_none()
                && own.candidate.domain == Domain::Speed
                && beyond(system, fit, &cause);
            cause.other_order = other_order;
            match &named {
                None => named = Some(Box::new(cause)),
                Some(_) => others.push(cause),
            }
            if large && others.len() < OTHERS {
                continue;
            }
            break;
        }
        let why = if !own.candidate.name.is_listed() {
            "the catalogue has no such cause".to_owned()
        } else if let Some(why) = locked {
            why.to_owned()
        } else if crawling {
            "it goes to and fro less than four times".to_owned()
        } else if wandering {
            "many crests beside it are as high: its frequency wanders".to_owned()
        } else if !slow {
            "steps explain it as well".to_owned()
        } else if let Some(refusal) = held.refusal {
            refusal
        } else if ahead.outdone {
            "two other causes together explain more".to_owned()
        } else {
            let rivals: Vec<String> = rivals.iter().map(|r| r.plain()).collect();
            format!(
                "{} {} it as well",
                rivals.join(" and "),
                agree(rivals.len(), "explains", "explain")
            )
        };
        // Such a line says nothing against faster ones.
        let domain = if crawling {
            Domain::Time
        } else {
            own.candidate.domain
        };
        let hertz = own.candidate.inner().filter(|_| domain == Domain::Line);
        let likeness = like(own.candidate.name, &why);
        let unnamed = Unnamed {
            log_p: own.log_p,
            // What a drift leaves of steps can look like anything, too.
            gain: own.gain.max(steps.unwrap_or_default()),
            what: What::Error(domain, hertz, likeness),
        };
        if first.is_some() {
            system.retain(|i| i < mark);
            continue;
        }
        system.extend();
        let shapes = both(&own.candidate.shapes, &held.beyond);
        let paid = paid_where_noise_shows(system, fit, &own.candidate.shapes, own.freedom as f64);
        first = Some(Contender::Unnamed(Nameless {
            unnamed,
            domain: Some(domain),
            name: Some(own.candidate.name),
            shapes,
            paid: paid.max(steps.unwrap_or_default()),
            is_noise: held.is_noise,
        }));
    }
    match (named, first) {
        (Some(cause), _) => Contender::Named(cause, others),
        (None, Some(unnamed)) => unnamed,
        // Nothing was tried: there was nothing to try.
        (None, None) => Contender::Unnamed(Nameless::default()),
    }
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
        exact::tuned(system, &fit.shapes, &mut cause, best.gain);
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
    /// Share of what the best explains.
    const AS_MUCH: f64 = 0.99;
    let Some(best) = scored.first() else { return };
    let (name, gain, freedom) = (best.candidate.name, best.gain, best.freedom);
    let other = |s: &Scored| {
        s.candidate.name != name && s.gain > AS_MUCH * gain && s.freedom + FEWER <= freedom
    };
    let others = (0..scored.len()).filter(|i| other(&scored[*i]));
    if let Some(at) = others.min_by_key(|i| scored[*i].freedom) {
        scored[..=at].rotate_right(1);
    }
}

/// Log-likelihood that a cause explains where noise of the channels is looked for, its numbers paid for: what it explains along
/// the circle as well says nothing against that noise.
pub(crate) fn paid_where_noise_shows(
    system: &System,
    fit: &Fit,
    cause: &[Shape],
    numbers: f64,
) -> f64 {
    let power = |fit: &Fit| Channels::of(system, &system.residual(fit)).power();
    let with = system.fit(both(&fit.shapes, cause));
    let gain = 0.5 * (power(fit) - power(&with)) / system.noise().powi(2);
    gain - price(system.context.samples() as f64) * numbers
}
