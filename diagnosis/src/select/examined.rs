//! A cause beside all that explain something: what else explains it, whether it holds, and why it cannot be named.

use nonius_quantity::agree;

use crate::causes::candidate::Domain;
use crate::causes::{self, Catalogue};
use crate::context::Context;
use crate::drifts::channels::Channels;
use crate::drifts::stairs;
use crate::finding::Cause;
use crate::model::tuned::tuned;
use crate::model::{Fit, Residual, System};
use crate::select::ahead;
use crate::select::beside::Beside;
use crate::select::both;
use crate::select::held::{Held, holds};
use crate::select::locked;
use crate::select::rivals;
use crate::select::score::{CLEAR, Scored};
use crate::select::selection::Accepted;
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::{Unnamed, What, like};

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

/// A cause, its numbers fitted, and what speaks against its name.
pub(crate) struct Examined {
    cause: Accepted,
    /// What it explains where its numbers are fitted.
    pub(crate) own: Scored,
    /// Causes to which it adds nothing.
    rivals: Vec<Cause>,
    /// Another of its kind that explains it with more numbers.
    richer: Option<Cause>,
    /// One that is this cause for some of its numbers.
    wider: Option<Cause>,
    /// The harmonic that explains it as well.
    other_order: Option<usize>,
    /// Of a bend, the motion hides what it does along the circle.
    hidden: bool,
    held: Held,
    /// Log-likelihood that steps explain in its place, where they do.
    pub(crate) steps: Option<f64>,
    /// Two other causes together explain more.
    outdone: bool,
    /// Why a line at its frequency says nothing of what it is.
    locked: Option<&'static str>,
    /// It goes to and fro too few times.
    crawling: bool,
    /// Its frequency wanders.
    wandering: bool,
    /// Functions that the system had before the examination.
    mark: usize,
}

impl Examined {
    /// Examines a cause; `rest` are the others that explain something, `alike` are those and what it may be that is not named itself; `left`
    /// is what the fit leaves.
    pub(crate) fn of(
        system: &mut System,
        catalogue: &Catalogue,
        fit: &Fit,
        left: &Residual,
        (best, rest, alike): (&Scored, &[&Scored], &[&Scored]),
    ) -> Self {
        let mut cause = Accepted::new(best.candidate.clone());
        tuned(system, &fit.shapes, &mut cause, best.gain);
        system.extend();
        let beside = Beside::new(&system.total, &fit.shapes);
        let own = Scored {
            gain: beside.gain(&cause.candidate.shapes).0,
            candidate: cause.candidate.clone(),
            ..*best
        };
        let price = system.price();
        let ahead = ahead::look(system.context, &beside, &own, rest, price);
        let mut rivals = rivals::among(system, fit, &beside, &own, rest);
        if rivals.is_empty() {
            rivals.extend(ahead.rival);
        }
        if rivals.is_empty() {
            rivals.extend(rivals::hidden(system, &beside, &own, catalogue));
        }
        if own.candidate.as_drift {
            rivals.retain(|name| *name != Cause::OffsetDrift);
            rivals.push(Cause::OffsetDrift);
        }
        let listed = |name: &Cause| name.is_listed();
        let richer = rivals::richer(&beside, &own, rest).filter(listed);
        let wider = rivals::wider(&beside, &own, alike).filter(listed);
        let clear = own.gain > CLEAR && system.context.against_reference.is_none();
        let other_order = rivals::other_order((system, fit), &beside, (&own, clear), alike);
        let hidden = clear && rivals::opposite(&own, alike);
        let mark = system.samples.library.atoms.len();
        let held = holds(system, catalogue, fit, &own, rest);
        let steps = match own.candidate.domain {
            Domain::Time => stairs::instead_of_drift(system, fit, &own, rest),
            // Slow noise looks like steps, and is known.
            Domain::Speed if held.refusal.is_none() && system.flicker.is_none() => {
                stairs::instead_of_speed(system, fit, &own, rest)
            }
            _ => None,
        };
        Self {
            locked: locked::why(system.context, &own),
            crawling: causes::crawls(system.context, &own.candidate),
            wandering: causes::is_one_of_many(system.context, left, &own.candidate),
            outdone: ahead.outdone,
            cause,
            own,
            rivals,
            richer,
            wider,
            other_order,
            hidden,
            held,
            steps,
            mark,
        }
    }

    /// Why it cannot be named, where it cannot.
    pub(crate) fn refusal(&self) -> Option<String> {
        if !self.own.candidate.name.is_listed() {
            return Some("the catalogue has no such cause".to_owned());
        }
        if let Some(why) = self.locked {
            return Some(why.to_owned());
        }
        if self.crawling {
            return Some("it goes to and fro less than four times".to_owned());
        }
        if self.wandering {
            return Some("many crests beside it are as high: its frequency wanders".to_owned());
        }
        if self.steps.is_some() {
            return Some("steps explain it as well".to_owned());
        }
        if self.held.refusal.is_some() {
            return self.held.refusal.clone();
        }
        if self.outdone {
            return Some("two other causes together explain more".to_owned());
        }
        if self.rivals.len() <= 1 && self.rivals.iter().all(|name| name.is_listed()) {
            return None;
        }
        let rivals: Vec<String> = self.rivals.iter().map(|r| r.plain()).collect();
        let explain = agree(rivals.len(), "explains", "explain");
        Some(format!("{} {explain} it as well", rivals.join(" and ")))
    }

    /// Drops the functions that the examination needed.
    pub(crate) fn forget(&self, system: &mut System) {
        system.retain(|atom| atom < self.mark);
    }

    /// The cause under its name, with those that it is confounded with.
    pub(crate) fn accepted(self, context: &Context) -> Accepted {
        let mut rivals = self.rivals;
        if rivals.is_empty() {
            rivals.extend(self.richer.or(self.wider));
        } else if context.periods_per_revolution == Some(1) {
            // One order is the other, and a harmonic of the scale is the likeliest.
            rivals.extend(self.wider.filter(|name| !rivals.contains(name)));
        }
        Accepted {
            confounded: rivals,
            other_order: self.other_order,
            hidden: self.hidden,
            ..self.cause
        }
    }

    /// The cause without its name, and `why`.
    pub(crate) fn nameless(self, system: &mut System, fit: &Fit, why: &str) -> Nameless {
        let own = self.own;
        let one = &own.candidate;
        // What crawls says nothing against faster lines.
        let domain = if self.crawling {
            Domain::Time
        } else {
            one.domain
        };
        let hertz = one.inner().filter(|_| domain == Domain::Line);
        // What a drift leaves of steps can look like anything, too.
        let steps = self.steps.unwrap_or_default();
        system.extend();
        Nameless {
            unnamed: Unnamed {
                log_p: own.log_p,
                gain: own.gain.max(steps),
                what: What::Error(domain, hertz, like(one.name, why)),
            },
            domain: Some(domain),
            name: Some(one.name),
            paid: paid_where_noise_shows(system, fit, &one.shapes, own.freedom as f64).max(steps),
            shapes: both(&one.shapes, &self.held.beyond),
            is_noise: self.held.is_noise,
        }
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
    gain - system.price() * numbers
}
