//! Whether a weak error of speed, or weak noise that is slow, is what a drift's polynomials leave of its curve. What crosses
//! over late is a gain that goes with the speed, and that is slow itself: beside a drift of any curve it may say nothing new.

use crate::causes::candidate::Domain;
use crate::doubt::{TRACE, gain_of, so_small, unnamed};
use crate::finding::Cause;
use crate::model::{System, atoms_of};
use crate::numerics::statistics::log_tail;
use crate::select::beside::Beside;
use crate::select::both;
use crate::select::rivals::NOTHING_NEW;
use crate::select::score::CLEAR;
use crate::select::search::SLOW_CAUSES;
use crate::select::selection::Selection;
use crate::shapes::generic;
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::Unnamed;

/// The causes of a domain whose names hold.
fn sure(found: &Selection, domain: Domain) -> Vec<usize> {
    let holds = |i: &usize| {
        let one = &found.accepted[*i];
        !one.doubted && one.candidate.domain == domain
    };
    (0..found.accepted.len()).filter(holds).collect()
}

/// Takes back the names of weak errors of speed to which drifts of other curves leave nothing.
pub(crate) fn of_drifts(system: &mut System, found: &mut Selection) -> Vec<Unnamed> {
    let drifts = sure(found, Domain::Time);
    let mut list = vec![];
    if drifts.is_empty() {
        return list;
    }
    for i in sure(found, Domain::Speed) {
        let gain = gain_of(system, found, &[i]);
        if gain < CLEAR && !is_new(system, found, i, &drifts) {
            let one = &mut found.accepted[i];
            one.doubted = true;
            let but = "a drift of another curve explains it as well";
            list.push(unnamed(Domain::Speed, one.candidate.name, gain, but));
        }
    }
    list
}

/// Why slow noise of so much gain in log-likelihood beside something slow has no name: it is so weak that it may be what the model
/// of that leaves.
pub(crate) fn instead_of_noise(system: &System, found: &Selection, gain: f64) -> Option<Unnamed> {
    let slow = |i: &usize| SLOW_CAUSES.contains(&found.accepted[*i].candidate.name);
    let also = sure(found, Domain::Speed).into_iter().filter(slow);
    let drifts = sure(found, Domain::Time).into_iter().chain(also);
    let gains = drifts.map(|i| (gain_of(system, found, &[i]), i));
    let (most, i) = gains.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (gain < TRACE * most).then(|| {
        let but = so_small(gain, most, found.accepted[i].candidate.name);
        unnamed(Domain::Time, Cause::FlickerNoise, gain, &but)
    })
}

/// Whether a cause adds something where the curves of drifts may be any.
fn is_new(system: &mut System, found: &Selection, which: usize, drifts: &[usize]) -> bool {
    let mark = system.samples.library.atoms.len();
    let mut curves: Vec<Shape> = vec![];
    for i in drifts {
        let candidate = &found.accepted[*i].candidate;
        let library = &mut system.samples.library;
        curves.extend(generic::around(system.context, candidate, library));
    }
    let own = system.sure(&found.accepted[which].candidate.shapes);
    let known = both(&found.shapes_but(&[which]), &curves);
    let known = system.sure(&known);
    let atoms = atoms_of(&both(&known, &own));
    let whole = system.among(&atoms);
    system.retain(|i| i < mark);
    let among = |shapes: &[Shape]| Shape::all_among(shapes, &atoms);
    let (adds, rank) = Beside::new(&whole, &among(&known)).gain(&among(&own));
    log_tail(2.0 * adds, rank.max(1)) < NOTHING_NEW.ln()
}
