//! The open set: how much a name holds of what any shape of its domain, or around it, explains.

use crate::causes::candidate::{Candidate, Domain};
use crate::causes::{self, Catalogue};
use crate::doubt;
use crate::finding::Cause;
use crate::model::{Fit, System, atoms_of};
use crate::noise::flicker::records::Records;
use crate::numerics::statistics::{at_most_of_noise, by_chance};
use crate::select::beside::Beside;
use crate::select::both;
use crate::select::score::{CLEAR, KINDS, SHOWN, Scored, worth};
use crate::shapes::generic::{self, HOLDS};
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::explains_only;

/// Share that it has to hold of what grows with the size of the speed: there a law has no shapes of its own.
const LAW: f64 = 0.97;
/// Share that what depends on the angle and what depends on the code have to hold together.
const TWO_HOLD: f64 = 0.9;
/// Most causes that stand beside another: a sensor may have harmonics of every order.
const MOST_BESIDE: usize = 8;

/// Share that a name has to hold of what is near it. A table of an ADC's errors has more entries than are looked at, a
/// sensor's harmonics and a graduation's errors are many, and an axis that vibrates does so for more than one reason; a
/// capacitor remembers; steps and bursts are mostly slow, too.
fn least(candidate: &Candidate) -> f64 {
    match candidate.domain {
        Domain::Code | Domain::Motion | Domain::Angle => HOLDS,
        Domain::Speed if candidate.name == Cause::AcCoupling => HOLDS,
        Domain::Revolution if candidate.name == Cause::GraduationError => HOLDS,
        Domain::Speed => 0.85,
        Domain::Time | Domain::Line => 0.9,
        Domain::Revolution => 0.95,
    }
}

/// Domains whose causes a basis of this one holds in part: what depends on a channel's code depends on the angle, and a slow
/// line is a slow change.
fn akin(domain: Domain) -> Option<Domain> {
    match domain {
        Domain::Code => Some(Domain::Angle),
        Domain::Angle => Some(Domain::Code),
        Domain::Time => Some(Domain::Line),
        _ => None,
    }
}

/// How far a name holds.
pub(crate) struct Held {
    /// Why it does not hold enough.
    pub(crate) refusal: Option<String>,
    /// Generic shapes that tell.
    pub(crate) beyond: Vec<Shape>,
    /// Slow noise of the channels explains it as well: nothing is left that has no name.
    pub(crate) is_noise: bool,
}

/// What is near a cause.
struct Near {
    /// What it would be if it were not what its name says.
    around: Vec<Shape>,
    /// What may stand beside it.
    steady: Vec<Shape>,
    /// What grows with the size of the speed in any way.
    sizes: Vec<Shape>,
}

impl Held {
    /// `share` of what any shape explains, and of what grows with the size of the speed in any way.
    fn new(candidate: &Candidate, share: f64, sizes: f64, beyond: Vec<Shape>) -> Self {
        let refusal = if sizes < LAW {
            Some("it grows with speed by another law".to_owned())
        } else if share < least(candidate) {
            Some(explains_only(share))
        } else {
            None
        };
        Self {
            refusal,
            beyond,
            is_noise: false,
        }
    }
}

/// Share of what generic bases explain that named shapes hold: the best one, and others of the catalogue that stand beside
/// it. One basis is that of the domain, the other is made around the best itself.
pub(crate) fn holds(
    system: &mut System,
    catalogue: &Catalogue,
    fit: &Fit,
    best: &Scored,
    others: &[&Scored],
) -> Held {
    let domain = best.candidate.domain;
    let basis = catalogue.basis(domain);
    // Where the axis vibrates only the radius tells what the sensor does.
    let sure = |system: &System, shapes: &[Shape]| {
        if domain == Domain::Motion {
            shapes.to_vec()
        } else {
            system.sure(shapes)
        }
    };
    let mut named = both(&fit.shapes, &best.candidate.shapes);
    let same = |o: &Scored| o.candidate.domain == domain;
    let mut enough = HOLDS;
    if !basis.is_empty() {
        // One of another domain that the basis holds in part, where it is told from this one; of several, with what is there already,
        // anything can be made.
        let in_time = domain == Domain::Time;
        let apart = in_time || system.context.periods_travelled() >= doubt::APART;
        let akin = |o: &Scored| apart && akin(domain) == Some(o.candidate.domain);
        if up_to(1, system, &mut named, others, akin) > 0.0 && !in_time {
            enough = TWO_HOLD;
        }
        stand_beside(system, &mut named, others, same);
    }
    let gained = |system: &System, shapes: &[Shape]| {
        let beside = Beside::new(&system.total, &sure(system, &fit.shapes));
        beside.gain(&sure(system, shapes)).0
    };
    let held = gained(system, &named[fit.shapes.len()..]);
    // Slow noise is in all that can be slow.
    let slow = doubt::SLOW_DOMAINS.contains(&domain);
    let noise = slow.then(|| Records::of(system)).flatten();
    let less_noise =
        |system: &mut System, known: &[Shape], shapes: &[Shape], beyond: (f64, usize)| {
            let noise = noise.as_ref();
            let allowed = noise.map_or(0.0, |n| n.allowed(system, known, shapes));
            (beyond.0 - allowed, beyond.1)
        };
    let [known, any] = [&named[..], basis].map(|list| sure(system, list));
    let beyond = Beside::new(&system.total, &known).gain(&any);
    let share = share(held, less_noise(system, &known, &any, beyond));
    if share < enough {
        return Held::new(&best.candidate, share, 1.0, basis.to_vec());
    }
    // Other causes may be there too, and no name answers for them.
    let (own, line) = (best.candidate.name, domain == Domain::Line);
    stand_beside(system, &mut named, others, |o| {
        line && same(o) && o.candidate.name != own
    });
    stand_beside(system, &mut named, others, |o| !same(o));
    let library = &mut system.samples.library;
    let near = Near {
        around: generic::around(system.context, &best.candidate, library),
        steady: generic::steady(system.context, &best.candidate, library),
        sizes: generic::at_any_speed(system.context, &best.candidate, library),
    };
    let held = gained(system, &best.candidate.shapes);
    let shares = |system: &mut System, named: &[Shape]| {
        let [known, free, any, sizes] =
            [named, &near.steady, &near.around, &near.sizes].map(|list| sure(system, list));
        let atoms = atoms_of(&[known.as_slice(), &any, &free, &sizes].concat());
        let whole = system.among(&atoms);
        let among = |shapes: &[Shape]| Shape::all_among(shapes, &atoms);
        let beside = Beside::new(&whole, &among(&known));
        let more = beside.gain(&among(&free)).0;
        let beyond = beside.gain(&among(&sizes));
        let sizes = self::share(held, less_noise(system, &known, &sizes, beyond));
        let known = both(&known, &free);
        let beyond = Beside::new(&whole, &among(&known)).gain(&among(&any));
        let own = self::share(held + more, less_noise(system, &known, &any, beyond));
        (own, sizes)
    };
    let (mut own, sizes) = shares(system, &named);
    if domain == Domain::Time && own < least(&best.candidate) {
        // A line may be small beside a drift, and large beside what the drift leaves. A weak one, or more of them, may be slow noise.
        let lines = lines_beside(system, fit, best);
        let lines: Vec<&Scored> = lines.iter().collect();
        if up_to(1, system, &mut named, &lines, |line| line.gain > CLEAR) > 0.0 {
            own = shares(system, &named).0;
        }
    }
    let mut found = Held::new(&best.candidate, own, sizes, near.around);
    if let Some(noise) = noise {
        let shapes = sure(system, &best.candidate.shapes);
        let inflation = noise.inflation(system, &sure(system, &fit.shapes), &shapes);
        let trials = best.candidate.trials * KINDS;
        found.is_noise = by_chance(held, inflation, best.freedom, trials) > SHOWN.ln();
        if found.is_noise {
            found.refusal = Some("slow noise of the channels explains it as well".to_owned());
        }
    }
    found
}

/// Lines that are to be seen in what a fit with a cause leaves.
fn lines_beside(system: &mut System, fit: &Fit, cause: &Scored) -> Vec<Scored> {
    let with = system.fit(both(&fit.shapes, &cause.candidate.shapes));
    let (residual, coloured) = (system.residual(&with), system.flicker.is_some());
    let library = &mut system.samples.library;
    let mut list = causes::shown(system.context, &residual, coloured, library);
    list.retain(|c| c.domain == Domain::Line);
    let lines = worth(system, &with, list, 0.0);
    system.extend();
    lines
}

/// Adds causes that stand beside the named ones; what they explain.
pub(crate) fn stand_beside(
    system: &System,
    named: &mut Vec<Shape>,
    others: &[&Scored],
    wanted: impl Fn(&Scored) -> bool,
) -> f64 {
    up_to(MOST_BESIDE, system, named, others, wanted)
}

/// The same, so many of them at most.
fn up_to(
    most: usize,
    system: &System,
    named: &mut Vec<Shape>,
    others: &[&Scored],
    wanted: impl Fn(&Scored) -> bool,
) -> f64 {
    let mut all = 0.0;
    for _ in 0..most {
        let beside = Beside::new(&system.total, named);
        let next = others
            .iter()
            .filter(|o| wanted(o))
            .filter_map(|o| {
                let (gain, freedom) = beside.gain(&o.candidate.shapes);
                let log_p = by_chance(gain, 1.0, freedom, o.candidate.trials * KINDS);
                (freedom > 0 && log_p < SHOWN.ln()).then_some((log_p, gain, o))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, gain, other)) = next else { break };
        named.extend(other.candidate.shapes.iter().cloned());
        all += gain;
    }
    all
}

/// What is held of it and of what is beyond.
pub(crate) fn share(held: f64, (beyond, freedom): (f64, usize)) -> f64 {
    // What as many free numbers explain of noise alone does not count against it.
    let beyond = (beyond - at_most_of_noise(freedom)).max(0.0);
    held / (held + beyond)
}
