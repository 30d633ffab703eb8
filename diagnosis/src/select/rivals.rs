//! Which other causes a name cannot be told from: those to which it adds nothing, decided from the data.

use crate::causes::Catalogue;
use crate::causes::candidate::{Candidate, Domain};
use crate::finding::Cause;
use crate::model::{Fit, System};
use crate::numerics::statistics::{at_most_of_noise, by_chance};
use crate::select::beside::Beside;
use crate::select::both;
use crate::select::score::{CLEAR, RIVALS, Scored};
use crate::shapes::library::Shape;

/// A cause that adds less than this probability says nothing new.
pub(crate) const NOTHING_NEW: f64 = 1e-3;
/// The same of a clear one that explains no more alone than the other does; of a weak one this would be most.
const HARDLY_NEW: f64 = 1e-5;
/// Log-likelihood by which a rival is beaten, if others are left: twenty to one.
const BEATEN: f64 = 3.0;

/// Causes of other names to which the best adds nothing, and that need no more parameters or are as probable with them. Of several, those that it beats by
/// twenty to one are none, where that leaves one.
pub(crate) fn among(
    system: &System,
    fit: &Fit,
    beside: &Beside,
    best: &Scored,
    others: &[&Scored],
) -> Vec<Cause> {
    let mut found: Vec<(Cause, f64)> = vec![];
    for other in others {
        let name = other.candidate.name;
        if name == best.candidate.name {
            continue;
        }
        // Far behind, or bought with more parameters: no rival. Of a weak cause one that is as probable with them is.
        let bought = other.freedom > best.freedom + 1 + other.candidate.given();
        let as_probable = best.gain < CLEAR && other.log_p < best.log_p + BEATEN;
        if other.gain < RIVALS * best.gain || (bought && !as_probable) {
            continue;
        }
        let own = (other.gain, other.freedom);
        let shapes = &other.candidate.shapes;
        let of_radius = || as_much_of_the_radius(system, fit, best, other);
        let as_much = best.gain - other.gain < BEATEN || of_radius();
        let least = if as_much && best.gain > CLEAR {
            HARDLY_NEW
        } else {
            NOTHING_NEW
        };
        let more = adds(beside, &best.candidate, shapes, own, least).or_else(|| {
            let unseen = as_much && only_along_the_circle(system, fit, &best.candidate, shapes);
            unseen.then_some(0.0)
        });
        if let Some(adds) = more {
            // Of several choices of one name the nearest counts.
            match found.iter_mut().find(|(known, _)| *known == name) {
                Some((_, nearest)) => *nearest = nearest.min(adds),
                None => found.push((name, adds)),
            }
        }
    }
    let near: Vec<(Cause, f64)> = found.iter().copied().filter(|f| f.1 < BEATEN).collect();
    let left = if near.len() == 1 { near } else { found };
    left.into_iter().map(|(name, _)| name).collect()
}

/// Share of the gain that tangents of what is large are off by.
pub(crate) const INEXACT: f64 = 0.01;

/// Share of the gain that vibration may have in it, where what explains less does as much to the radius.
const VIBRATION: f64 = 0.15;

/// The order of the scale period that a harmonic may have as well. Of order n, turning backwards, it does to the radius what one of order
/// n + 2 does that turns forwards: along the circle they are opposite, and the motion may hide that. Of a `clear` one without a reference the
/// tangents are not as exact as what it explains, and what they prefer is no proof.
pub(crate) fn other_order(
    (system, fit): (&System, &Fit),
    beside: &Beside,
    (best, clear): (&Scored, bool),
    others: &[&Scored],
) -> Option<usize> {
    let own = &best.candidate;
    own.order?;
    let alike = others.iter().filter(|other| {
        let less = best.gain - other.gain;
        let known = (other.gain, other.freedom);
        let adds_nothing =
            || adds(beside, own, &other.candidate.shapes, known, NOTHING_NEW).is_some();
        other.candidate.order.is_some()
            && (less < BEATEN && adds_nothing()
                || clear && less < INEXACT * best.gain
                || as_much_of_the_radius(system, fit, best, other))
    });
    let nearest = alike.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    nearest.candidate.order
}

/// Whether harmonics of two orders explain as much as a bend: of what that does along the circle nothing shows then. A harmonic has
/// its [`other_order`].
pub(crate) fn opposite(best: &Scored, others: &[&Scored]) -> bool {
    let own = &best.candidate;
    let alike = others
        .iter()
        .filter(|s| best.gain - s.gain < INEXACT * best.gain);
    let mut orders: Vec<usize> = alike.filter_map(|s| s.candidate.order).collect();
    orders.sort_unstable();
    orders.dedup();
    own.domain == Domain::Angle && own.order.is_none() && orders.len() > 1
}

/// How much a cause adds to shapes that explain so much with so many numbers, where that is no less probable than `least`: the best of
/// many choices of one cause adds more by chance.
fn adds(
    beside: &Beside,
    cause: &Candidate,
    shapes: &[Shape],
    (gain, freedom): (f64, usize),
    least: f64,
) -> Option<f64> {
    let (together, rank) = beside.gain(&both(shapes, &cause.shapes));
    let (adds, more) = (together - gain, rank.saturating_sub(freedom));
    (by_chance(adds, 1.0, more, cause.trials) > least.ln()).then_some(adds)
}

/// Whether the axis vibrates and another bend or harmonic explains nearly as much as the best, and of the radius no less: what either does along
/// the circle is where the vibration is.
pub(crate) fn as_much_of_the_radius(
    system: &System,
    fit: &Fit,
    best: &Scored,
    other: &Scored,
) -> bool {
    let waves = |s: &Scored| s.candidate.adds.is_some();
    let nearly = other.gain > (1.0 - VIBRATION) * best.gain;
    if !(system.vibrates() && waves(best) && waves(other) && nearly) {
        return false;
    }
    let beside = Beside::new(&system.total, &system.sure(&fit.shapes));
    let of_radius = |s: &Scored| beside.gain(&system.sure(&s.candidate.shapes)).0;
    of_radius(best) - of_radius(other) < BEATEN
}

/// Whether the radius does not show what a cause adds to shapes: where the axis vibrates, that may be what its prediction does
/// not hold.
fn only_along_the_circle(system: &System, fit: &Fit, cause: &Candidate, shapes: &[Shape]) -> bool {
    let known = both(&fit.shapes, shapes);
    let beside = Beside::all_that_moves(system, &known);
    let solution = beside.solve(&cause.shapes);
    !beside.in_radius(&cause.shapes, &solution.x, solution.rank, 1.0)
}

/// A cause that would be seen along the circle alone, and so is not looked for or hides there.
pub(crate) fn hidden(
    system: &System,
    beside: &Beside,
    best: &Scored,
    catalogue: &Catalogue,
) -> Option<Cause> {
    along_the_circle(beside, best, catalogue)
        .or_else(|| of_the_place(system, beside, best, catalogue))
}

/// What a static error of the sensor does that the radius does not show: two bends that make up for each other there, beside
/// other gains. To that, cogging of an order of the scale period adds nothing.
fn along_the_circle(beside: &Beside, best: &Scored, catalogue: &Catalogue) -> Option<Cause> {
    let own = &best.candidate;
    if own.domain != Domain::Motion || own.name == Cause::Vibration {
        return None;
    }
    let alike = |c: &&Candidate| {
        let harmonic = c.domain == Domain::Angle && c.exact.is_none();
        harmonic && adds(beside, own, &c.shapes, beside.gain(&c.shapes), NOTHING_NEW).is_some()
    };
    let alike = catalogue.candidates.iter().filter(alike);
    let fewest = alike.min_by_key(|c| c.shapes.len());
    fewest.map(|c| c.name)
}

/// Within less than a turn nobody looks for errors of the graduation, and what repeats with the scale period may be one: a reference
/// shows it along the circle alone.
fn of_the_place(
    system: &System,
    beside: &Beside,
    best: &Scored,
    catalogue: &Catalogue,
) -> Option<Cause> {
    let own = &best.candidate;
    let context = system.context;
    let place = context.phi.is_some() && context.against_reference.is_some();
    let looked_for = |c: &Candidate| c.name == Cause::GraduationError;
    if own.domain != Domain::Angle || !place || catalogue.candidates.iter().any(looked_for) {
        return None;
    }
    let all: Vec<usize> = (0..system.samples.library.atoms.len()).collect();
    let along: Vec<bool> = system.radial(&all).iter().map(|radial| !radial).collect();
    // Offsets may make up for what it does to the radius.
    let parts: Vec<Shape> = own.shapes.iter().map(|s| s.only(&along)).collect();
    let needs_radius = best.gain - beside.gain(&parts).0 > at_most_of_noise(best.freedom);
    (!needs_radius).then_some(Cause::GraduationError)
}

/// A cause of the same kind that has more numbers, explains more with them, and to which the best adds nothing: it is dearer and so
/// goes second, but nothing tells that it is not the one.
pub(crate) fn richer(beside: &Beside, best: &Scored, others: &[&Scored]) -> Option<Cause> {
    let own = &best.candidate;
    let as_well = |other: &&&Scored| {
        let c = &other.candidate;
        let richer = c.domain == own.domain && c.name != own.name && other.freedom > best.freedom;
        let known = (other.gain, other.freedom);
        richer
            && other.gain >= best.gain
            && adds(beside, own, &c.shapes, known, NOTHING_NEW).is_some()
            // A harmonic holds every bend, and is told by [`wider`].
            && c.order.is_none()
    };
    let most = others.iter().filter(as_well);
    let most = most.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    Some(most.candidate.name)
}

/// A cause of the same place that has more parameters and is this one for some of their values, as a harmonic of the scale
/// is a bend of the channels at one phase: the simpler one goes first, but nothing in a recording tells them apart.
pub(crate) fn wider(beside: &Beside, best: &Scored, others: &[&Scored]) -> Option<Cause> {
    let holds = |other: &&&Scored| {
        let c = &other.candidate;
        let own = best.candidate.domain;
        // What repeats with the revolution or really moves may be one order of the scale period, too.
        let domain = c.domain == own
            || c.domain == Domain::Angle && matches!(own, Domain::Revolution | Domain::Motion);
        let wider = domain && other.freedom > best.freedom;
        wider && c.name != best.candidate.name && beside.holds(&c.shapes, &best.candidate.shapes)
    };
    others.iter().find(holds).map(|other| other.candidate.name)
}
