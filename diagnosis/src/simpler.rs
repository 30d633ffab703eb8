//! Wider causes that got a name for what a simpler one does. A harmonic of the scale is a bend of the channels at one phase;
//! beside something that is not known yet it explains more than the bend does. Once everything is known, the simpler one is
//! named if it explains as much, the numbers of either paid for, and says that the other would, too.

use crate::beside::Beside;
use crate::cause::Candidate;
use crate::causes::Catalogue;
use crate::library::Shape;
use crate::model::{Fit, System};
use crate::score::score;
use crate::selection::{Accepted, Selection};
use crate::statistics::price;

/// Puts the simpler cause in the place of each wider one that holds it and explains no more.
pub(crate) fn simpler(system: &System, catalogue: &Catalogue, found: &mut Selection) {
    // What stands in for something without a name would make up for anything.
    if !found.unnamed.is_empty() {
        return;
    }
    for i in 0..found.accepted.len() {
        let wide = &found.accepted[i];
        // What is off the signals already stays what it is.
        if wide.x.iter().any(|x| *x != 0.0) {
            continue;
        }
        let simple = catalogue.candidates.iter().filter(|c| {
            let own = &wide.candidate;
            let other = c.domain == own.domain && c.name != own.name && !c.as_drift;
            other && c.shapes.len() < own.shapes.len()
        });
        let swaps = simple.filter_map(|c| Some((c.clone(), swapped(system, found, wide, c)?)));
        let best = swaps.max_by(|a, b| a.1.solution.gain().total_cmp(&b.1.solution.gain()));
        if let Some((candidate, fit)) = best {
            replace(found, i, candidate, fit);
        }
    }
}

/// The fit with a simpler cause in the place of a wide one, if that holds it and explains no more.
fn swapped(system: &System, found: &Selection, wide: &Accepted, simple: &Candidate) -> Option<Fit> {
    let mut others: Vec<Shape> = found.fit.shapes.clone();
    others.drain(wide.range());
    let beside = Beside::new(&system.total, &others);
    // It has to be one that can be.
    score(&beside, simple.clone())?;
    if !beside.holds(&wide.candidate.shapes, &simple.shapes) {
        return None;
    }
    let mut shapes = found.fit.shapes.clone();
    shapes.splice(wide.range(), simple.shapes.iter().cloned());
    let fit = system.fit(shapes);
    let samples: f64 = system.context.weight.iter().sum();
    let fewer = wide.candidate.shapes.len() - simple.shapes.len();
    let price = price(samples.max(1.0)) * fewer as f64;
    (found.fit.solution.gain() - fit.solution.gain() <= price).then_some(fit)
}

fn replace(found: &mut Selection, i: usize, candidate: Candidate, fit: Fit) {
    let wide = &found.accepted[i];
    let (first, fewer) = (
        wide.first,
        wide.candidate.shapes.len() - candidate.shapes.len(),
    );
    // Of an order that may be another, it is the one that a bend with fewer numbers has.
    let confounded = vec![wide.candidate.name.to_owned()];
    for other in &mut found.accepted {
        if other.first > first {
            other.first -= fewer;
        }
    }
    found.accepted[i] = Accepted {
        first,
        confounded,
        ..Accepted::new(candidate)
    };
    found.fit = fit;
}
