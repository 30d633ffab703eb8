//! What goes with speed, decided anew once more is known of the channels. A delay or a filter sees the whole channel, its bends too: where
//! it was named before those, what it does to them was part of what was weighed, and may have named it.

use nonius_recording::Recording;

use crate::causes::candidate::{Candidate, Domain};
use crate::context::Context;
use crate::finding::Cause;
use crate::model::exact::{NAMED, Start, followed, look, seen_together};
use crate::select::beside::Beside;
use crate::select::choice::best;
use crate::select::contender::{Contender, contender};
use crate::select::score::{Scored, score};
use crate::select::search::{ONCE, starts};
use crate::select::selection::Accepted;
use crate::select::{begin, both};

/// Where the last cause that is carried bends the channels, and one that goes with speed changes with that: what is known of the recording
/// with another choice of the one that it changes most. `None` where it stays what it was.
pub(crate) fn decided_anew(
    context: &Context,
    carried: &[Accepted],
    recording: &Recording,
) -> Option<(Context, Vec<Accepted>)> {
    let (bend, earlier) = carried.split_last()?;
    bend.candidate.adds.as_ref()?;
    let (at, seen) = most_changed(context, carried, recording)?;
    if seen < NAMED {
        return None;
    }
    let mut others = carried.to_vec();
    others.remove(at);
    let start = Start::of(context, others.clone());
    let without = followed(context, &start, recording, None);
    let mut beside_it = start.carried;
    let (mut system, catalogue) = look(&without, &mut beside_it, recording);
    let mut found = begin(&mut system, &catalogue, beside_it);
    let beside = Beside::all_that_moves(&system, &found.fit.shapes);
    let is_there = |name: Cause| others.iter().any(|one| one.candidate.name == name);
    let all = catalogue.candidates.iter();
    let mut scored: Vec<Scored> = all
        .filter(|c| goes_with_speed(c) && !(ONCE.contains(&c.name) && is_there(c.name)))
        .filter_map(|c| score(&beside, c.clone()))
        .collect();
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
    if scored.is_empty() {
        return None;
    }
    let left = system.residual(&found.fit);
    let Contender::Named(mut cause, rivals) =
        contender(&mut system, &catalogue, &found.fit, &left, (scored, &[]))
    else {
        return None;
    };
    cause.first = found.fit.shapes.len();
    let fit = system.fit(both(&found.fit.shapes, &cause.candidate.shapes));
    let before = std::mem::replace(&mut found.fit, fit);
    found.accepted.push(*cause);
    let mut choices = starts(&system, &before, &found, rivals);
    // Far from where the channel is late, tangents of what stands beside it say nothing: that is as it was.
    for choice in &mut choices {
        for (one, known) in choice.carried.iter_mut().zip(&others) {
            let of = |a: &Accepted| (a.candidate.name, a.candidate.id);
            if of(one) == of(known) {
                one.x.clone_from(&known.x);
                one.candidate.exact.clone_from(&known.candidate.exact);
                one.inner_error.clone_from(&known.inner_error);
            }
        }
    }
    drop(system);
    let new = best(&without, choices, recording)?;
    let (was, is) = (earlier[at].candidate.name, new.1.last()?.candidate.name);
    // The same name may be another channel's.
    (was != is || is == Cause::BandwidthMismatch).then_some(new)
}

fn goes_with_speed(candidate: &Candidate) -> bool {
    candidate.domain == Domain::Speed
}

/// The cause of speed that the last one that is carried changes most, and by what detection SNR.
fn most_changed(
    context: &Context,
    carried: &[Accepted],
    recording: &Recording,
) -> Option<(usize, f64)> {
    if !carried.iter().any(|a| goes_with_speed(&a.candidate)) {
        return None;
    }
    let mut entered = carried.to_vec();
    let (system, _) = look(context, &mut entered, recording);
    let (bend, earlier) = entered.split_last()?;
    let all = earlier.iter().enumerate();
    all.filter(|(_, a)| goes_with_speed(&a.candidate))
        .map(|(at, a)| (at, seen_together(&system, a, bend)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
}
