//! Wider causes that got a name for what a simpler one does. A harmonic of the scale is a bend of the channels at one phase;
//! beside something that is not known yet it explains more than the bend does. Once everything is known, the simpler one is
//! named if it explains as much, the numbers of either paid for, and says that the other would, too. And a drift of many
//! numbers, which was the best single name for two errors of speed together, goes where both of them are known.

use crate::causes::Catalogue;
use crate::causes::candidate::{Candidate, Domain};
use crate::finding::Cause;
use crate::model::{Fit, System};
use crate::select::beside::Beside;
use crate::select::rivals;
use crate::select::score::{Scored, score};
use crate::select::selection::{Accepted, Selection};

/// So many times as large as a wide cause a simple one may be that is the same: a bend is three times its third harmonic, most of which is
/// the channel's gain.
const LARGER: f64 = 10.0;

/// Drops names to which the others leave nothing, then puts the simpler cause in the place of each wider one that holds it
/// and explains no more. Whether one of these was off the signals, which have to be looked at anew then: the amounts of a large one depend
/// on the ellipse, which is another. In the `last` look those stay what they are.
pub(crate) fn simpler(
    system: &System,
    catalogue: &Catalogue,
    found: &mut Selection,
    last: bool,
) -> bool {
    // What stands in for something without a name would make up for anything.
    if !found.unnamed.is_empty() {
        return false;
    }
    let mut large = false;
    found.drop_idle(system);
    rivals_anew(system, catalogue, found);
    for i in 0..found.accepted.len() {
        let wide = &found.accepted[i];
        // What is off the signals already stays what it is, but for waves of the channels: those are the same taken off.
        if wide.is_taken_off() && (last || wide.candidate.adds.is_none()) {
            continue;
        }
        let simple = catalogue.candidates.iter().filter(|c| {
            let own = &wide.candidate;
            let other = c.domain == own.domain && c.name != own.name && !c.as_drift;
            other && c.name.is_listed() && c.shapes.len() < own.shapes.len()
        });
        let swaps = simple.filter_map(|c| Some((c.clone(), swapped(system, found, wide, c)?)));
        let best = swaps.max_by(|a, b| a.1.solution.gain().total_cmp(&b.1.solution.gain()));
        if let Some((candidate, fit)) = best {
            large |= wide.is_taken_off();
            replace(found, i, candidate, fit);
        }
    }
    large
}

/// Looks anew for what an error of speed cannot be told from, where that is known by now to be there as well: what was like two causes
/// together is like another beside one of them. Of the two that are alike then, the one that explains more is named.
fn rivals_anew(system: &System, catalogue: &Catalogue, found: &mut Selection) {
    for i in 0..found.accepted.len() {
        let names: Vec<Cause> = found.accepted.iter().map(|a| a.candidate.name).collect();
        let one = &found.accepted[i];
        let is_there = |rival: &Cause| names.contains(rival);
        let speed = one.candidate.domain == Domain::Speed;
        if !speed || !one.confounded.iter().any(is_there) || one.is_taken_off() {
            continue;
        }
        let without = system.fit(found.fit.others(&one.range()));
        let beside = Beside::new(&system.total, &without.shapes);
        let Some(own) = score(&beside, one.candidate.clone()) else {
            continue;
        };
        let others = catalogue.candidates.iter().filter(|c| {
            let as_many = c.shapes.len() == own.candidate.shapes.len();
            let other = c.name.is_listed() && !names.contains(&c.name);
            c.domain == Domain::Speed && as_many && other
        });
        let others: Vec<Scored> = others.filter_map(|c| score(&beside, c.clone())).collect();
        let all: Vec<&Scored> = others.iter().collect();
        let rivals = rivals::among(system, &without, &beside, &own, &all);
        let rival = |s: &&Scored| rivals.contains(&s.candidate.name);
        let best = others.iter().filter(rival);
        match best.max_by(|a, b| a.gain.total_cmp(&b.gain)) {
            Some(best) if best.gain > own.gain => {
                let shapes = found.fit.with_in_place(one.range(), &best.candidate.shapes);
                replace(found, i, best.candidate.clone(), system.fit(shapes));
            }
            best => {
                let rival = best.map(|s| s.candidate.name);
                found.accepted[i].confounded = rival.into_iter().collect();
            }
        }
    }
}

/// The fit with a simpler cause in the place of a wide one, if that holds it and explains no more.
fn swapped(system: &System, found: &Selection, wide: &Accepted, simple: &Candidate) -> Option<Fit> {
    let beside = Beside::new(&system.total, &found.fit.others(&wide.range()));
    // It has to be one that can be, and not so much larger that the gains make up for most of it.
    let simple_size = score(&beside, simple.clone())?.size;
    let all = &wide.candidate.shapes;
    let wide_size = beside.size(all, &beside.solve(all).x);
    if simple_size > LARGER * wide_size || !beside.holds(all, &simple.shapes) {
        return None;
    }
    let fit = system.fit(found.fit.with_in_place(wide.range(), &simple.shapes));
    let fewer = wide.candidate.shapes.len() - simple.shapes.len();
    let price = system.price() * fewer as f64;
    (found.fit.solution.gain() - fit.solution.gain() <= price).then_some(fit)
}

fn replace(found: &mut Selection, i: usize, candidate: Candidate, fit: Fit) {
    let wide = &found.accepted[i];
    let (first, fewer) = (
        wide.first,
        wide.candidate.shapes.len() - candidate.shapes.len(),
    );
    // Of an order that may be another, it is the one that a bend with fewer numbers has.
    let confounded = vec![wide.candidate.name];
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
