//! Whether a weak error of speed is what a drift's polynomials leave of its curve. What crosses over late is a gain that goes with
//! the speed, and that is slow itself: beside a drift of any curve it may say nothing new.

use crate::beside::Beside;
use crate::cause::Domain;
use crate::doubt::{gain_of, unnamed};
use crate::generic;
use crate::library::Shape;
use crate::model::{System, atoms_of};
use crate::score::CLEAR;
use crate::select::both;
use crate::selection::Selection;
use crate::statistics::log_tail;
use crate::unexplained::Unnamed;

/// A cause that adds less than this probability to such curves says nothing new.
const NOTHING_NEW: f64 = 1e-3;

/// Takes back the names of weak errors of speed to which drifts of other curves leave nothing.
pub(crate) fn of_drifts(system: &mut System, found: &mut Selection) -> Vec<Unnamed> {
    let sure = |domain: Domain, found: &Selection| -> Vec<usize> {
        let of = |i: &usize| {
            let one = &found.accepted[*i];
            !one.doubted && one.candidate.domain == domain
        };
        (0..found.accepted.len()).filter(of).collect()
    };
    let drifts = sure(Domain::Time, found);
    let mut list = vec![];
    if drifts.is_empty() {
        return list;
    }
    for i in sure(Domain::Speed, found) {
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
    let among =
        |shapes: &[Shape]| -> Vec<Shape> { shapes.iter().map(|s| s.among(&atoms)).collect() };
    let (adds, rank) = Beside::new(&whole, &among(&known)).gain(&among(&own));
    log_tail(2.0 * adds, rank.max(1)) < NOTHING_NEW.ln()
}
