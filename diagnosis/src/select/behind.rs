//! What goes with speed, decided anew once more is known of the channels. A delay or a filter sees the whole channel, its bends too: where
//! it was named before those, what it does to them was part of what was weighed, and may have named it.

use nonius_recording::Recording;

use crate::causes::cause::Domain;
use crate::context::Context;
use crate::model::exact::{NAMED, Start, followed, look, seen_together};
use crate::select::beside::Beside;
use crate::select::choice::best;
use crate::select::contender::{Contender, contender};
use crate::select::score::{Scored, score};
use crate::select::selection::Accepted;
use crate::select::{begin, both, starts};

/// What is known of a recording, with another choice of what goes with speed where the last cause of `known` changes that; `None`
/// where it does not.
pub(crate) fn decided_anew(
    (context, carried): &(Context, Vec<Accepted>),
    recording: &Recording,
) -> Option<(Context, Vec<Accepted>)> {
    let (bend, earlier) = carried.split_last()?;
    bend.candidate.adds?;
    let with_speed = |a: &Accepted| a.candidate.domain == Domain::Speed;
    let at = earlier.iter().position(with_speed)?;
    let mut known = carried.clone();
    let (system, _) = look(context, &mut known, recording);
    if seen_together(&system, &known[at], known.last()?) < NAMED {
        return None;
    }
    drop(system);
    let mut others = carried.clone();
    others.remove(at);
    let start = Start::of(context, others);
    let without = followed(context, &start, recording, None);
    let mut carried = start.carried;
    let (mut system, catalogue) = look(&without, &mut carried, recording);
    let mut found = begin(&mut system, &catalogue, carried);
    let beside = Beside::all_that_moves(&system, &found.fit.shapes);
    let all = catalogue.candidates.iter();
    let mut scored: Vec<Scored> = all
        .filter(|c| c.domain == Domain::Speed)
        .filter_map(|c| score(&beside, c.clone()))
        .collect();
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
    if scored.is_empty() {
        return None;
    }
    let left = system.residual(&found.fit);
    let Contender::Named(mut cause, others) =
        contender(&mut system, &catalogue, &found.fit, &left, scored)
    else {
        return None;
    };
    cause.first = found.fit.shapes.len();
    let fit = system.fit(both(&found.fit.shapes, &cause.candidate.shapes));
    let before = std::mem::replace(&mut found.fit, fit);
    found.accepted.push(*cause);
    let starts = starts(&system, &before, &found, others);
    drop(system);
    let new = best(&without, starts, recording)?;
    let name = |a: Option<&Accepted>| a.map(|a| a.candidate.name);
    (name(new.1.last()) != name(earlier.get(at))).then_some(new)
}
