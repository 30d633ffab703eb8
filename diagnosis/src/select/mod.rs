//! Which causes are in a recording: the one that explains most first, rivals named, unknown shapes left unnamed.

mod ahead;
pub(crate) mod beside;
pub(crate) mod choice;
pub(crate) mod contender;
mod examined;
pub(crate) mod held;
pub(crate) mod locked;
pub(crate) mod rivals;
pub(crate) mod rounds;
pub(crate) mod score;
pub(crate) mod search;
pub(crate) mod selection;
pub(crate) mod speed_anew;

use crate::causes::Catalogue;
use crate::model::exact::{self, Start};
use crate::model::tuned::tuned;
use crate::model::{Fit, System, atoms_of};
use crate::select::rounds::Anew;
use crate::select::search::search;
use crate::select::selection::{Accepted, Selection};
use crate::shapes::library::Shape;

/// Shapes of one list, then of the other.
pub(crate) fn both(a: &[Shape], b: &[Shape]) -> Vec<Shape> {
    a.iter().chain(b).cloned().collect()
}

/// The five parameters, and the causes that are known.
pub(crate) fn begin(
    system: &mut System,
    catalogue: &Catalogue,
    carried: Vec<Accepted>,
) -> Selection {
    let base = system.fit(catalogue.parameters.clone());
    let mut accepted = carried;
    accepted.retain(|a| !a.candidate.shapes.is_empty());
    let mut fit = base.clone();
    for one in &mut accepted {
        one.first = fit.shapes.len();
        fit = system.fit(both(&fit.shapes, &one.candidate.shapes));
    }
    let mut found = Selection::of_fits(base, fit, accepted);
    tune(system, catalogue, &mut found);
    found
}

/// Fits the inner numbers of what is accepted anew: what stands beside it has changed.
fn tune(system: &mut System, catalogue: &Catalogue, found: &mut Selection) {
    for one in &mut found.accepted {
        let range = one.range();
        let others = found.fit.others(&range);
        let gain = found.fit.solution.gain() - system.fit(others.clone()).solution.gain();
        // What all samples tell where they are tried, as far as a part of them shows it.
        let gain = gain * (system.every() / system.tried()) as f64;
        tuned(system, &others, one, gain);
        found.fit = system.fit(found.fit.with_in_place(range, &one.candidate.shapes));
    }
    // Functions that were made for the known causes and that no shape uses.
    keep_used(system, catalogue.atoms, found);
}

/// Whether the tangents do not do for causes in a fit.
pub(crate) fn astray(system: &System, fit: &Fit, accepted: &[Accepted]) -> bool {
    !accepted.is_empty() && !exact::tangents_do(system, fit, accepted, exact::NAMED)
}

/// Where to look anew from, if the tangents do not do for what is known.
pub(crate) fn anew(system: &System, found: &Selection) -> Option<Start> {
    let astray = astray(system, &found.fit, &found.accepted);
    astray.then(|| exact::start(system, &found.fit, &found.accepted))
}

/// Accepts causes one after the other, beside those that are known; ends where the tangents do not do, as far as it may. In a long
/// recording, what is large is found in a part of it first.
pub(crate) fn select(
    system: &mut System,
    catalogue: &Catalogue,
    carried: Vec<Accepted>,
    may: Anew,
) -> Selection {
    let found = begin(system, catalogue, carried);
    if system.context.is_too_short() {
        return found;
    }
    let known = found.accepted.len();
    let mut found = search(system, catalogue, found, (known, may));
    if system.every() == 1 {
        return found;
    }
    if let [start] = found.again.as_mut_slice() {
        // The amounts that all samples give need not be looked at anew for their errors in a part of them.
        system.try_on_all();
        let fit = system.fit_tried(found.fit.shapes.clone());
        *start = exact::start(system, &fit, &found.accepted);
    }
    if !found.again.is_empty() {
        return found;
    }
    // What was found in a part has its numbers from all of it, and then the rest is looked for there.
    system.try_on_all();
    let mut found = begin(system, catalogue, found.accepted);
    found.fit = system.fit_tried(found.fit.shapes);
    if may.with(found.accepted.len() > known)
        && let Some(start) = anew(system, &found)
    {
        found.again = vec![start];
        return found;
    }
    system.complete();
    found.refit(system);
    let with_inner = found.accepted.iter().filter(|a| a.has_inner());
    if with_inner.count() > 1 {
        // Each was fitted beside others that were not yet.
        tune(system, catalogue, &mut found);
    }
    search(system, catalogue, found, (known, may))
}

/// Drops the functions that were only tried.
fn keep_used(system: &mut System, fixed: usize, found: &mut Selection) {
    let used = atoms_of(&found.fit.shapes);
    let map = system.retain(|i| i < fixed || used.binary_search(&i).is_ok());
    for shape in &mut found.fit.shapes {
        *shape = shape.mapped(&map);
    }
    for one in &mut found.accepted {
        one.candidate.shapes = found.fit.shapes[one.range()].to_vec();
    }
}
