//! The direction in which a scale came to where it is: written apart from `sensor/src/side.rs`, which plays what is named by it.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::context::Context;

/// Way back, radians of the scale period, from which on a scale has turned: an axis that shakes, and noise of the angle, turn back and
/// forth by less.
const BACK: f64 = TAU / 100.0;
/// Share of the samples for which a scale rests before it moves, from which on it shows on which side of a hysteresis it came there.
const RESTS: f64 = 0.002;

/// The direction in which the scale came to where it is, 1 or −1, sample by sample; and, of a recording that begins at rest, what that is
/// if the scale came to the rest the other way.
pub(super) fn directions(context: &Context) -> Vec<Vec<f64>> {
    let alpha = &context.drive_angle();
    let back = sides(alpha, -1.0);
    let moves = back.iter().position(|side| *side != back[0]);
    let rests = moves.is_some_and(|k| k as f64 > RESTS * alpha.len() as f64);
    std::iter::once(sides(alpha, 1.0))
        .chain(rests.then_some(back))
        .collect()
}

/// At rest the direction before goes on, until the scale has gone back. Before any motion it is the first that comes times `start`.
fn sides(alpha: &[f64], start: f64) -> Vec<f64> {
    let ways = alpha.iter().map(|a| a - alpha[0]);
    let way = ways.into_iter().find(|way| way.abs() > BACK);
    let mut side = start * way.map_or(1.0, f64::signum);
    let mut sides = Vec::with_capacity(alpha.len());
    let mut seen = 0;
    while let Some(turn) = turn(alpha, seen, side) {
        sides.resize(turn.last + 1, side);
        (seen, side) = (turn.seen, -side);
    }
    sides.resize(alpha.len(), side);
    sides
}

/// Where a scale turned, in samples: the last on the way out, and the one at which that is seen.
struct Turn {
    last: usize,
    seen: usize,
}

/// The first turn after a sample at which the scale goes that way.
fn turn(alpha: &[f64], from: usize, side: f64) -> Option<Turn> {
    let mut farthest = from;
    let behind = |k: usize, farthest: usize| (alpha[farthest] - alpha[k]) * side;
    let seen = (from..alpha.len()).find(|k| {
        if behind(*k, farthest) <= 0.0 {
            farthest = *k;
        }
        behind(*k, farthest) > BACK
    })?;
    // It may have rested there: it turned where it last went on.
    let went_on = |j: &usize| behind(j + 1, *j) <= 0.0;
    let stood = (farthest..seen).rev().find(went_on);
    let began = begins(farthest..seen, |k| behind(k, farthest));
    let last = stood.map_or(farthest, |j| j + 1).max(began);
    Some(Turn { last, seen })
}

/// The first of the samples at which a scale can have begun to go back, given how far back it is at each: a curve that follows an axis
/// which shakes creeps before that. With constant acceleration it would have gone a tenth of the way at 0.32 of the time; where that grows, at 0.46.
fn begins(samples: Range<usize>, back: impl Fn(usize) -> f64) -> usize {
    /// Time before a tenth of the way, of the time after it.
    const BEFORE: f64 = 0.9;
    let slight = |j: &usize| back(*j) <= BACK / 10.0;
    let end = samples.end;
    let slight = samples.rev().find(slight).unwrap_or(0);
    slight.saturating_sub((BEFORE * (end - slight) as f64) as usize)
}

#[cfg(test)]
mod tests {
    use super::{BACK, sides};

    #[test]
    fn what_shakes_turns_where_it_goes_back() {
        let places = [0.0, 2.0, 2.01, 1.99, 2.01, 4.0, 3.99, 3.98, 2.5, 2.4];
        let alpha = places.map(|p| p * BACK);
        // By a tenth of what counts it may only shake.
        let expected = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0];
        assert_eq!(sides(&alpha, 1.0), expected);
    }

    #[test]
    fn what_came_the_other_way_turns_when_it_moves() {
        let alpha = [0.0, 0.1, 0.0, 2.0, 4.0, 3.0, 2.0].map(|p| p * BACK);
        let expected = [-1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0];
        assert_eq!(sides(&alpha, -1.0), expected);
    }

    #[test]
    fn what_creeps_at_rest_turns_where_it_begins_to_move() {
        // Forwards, a rest in which a curve creeps back by less than a tenth of what counts, and back with a constant acceleration.
        let forwards = (0..100).map(|k| f64::from(k) * BACK);
        let rest = (0..900).map(|k| (99.0 - f64::from(k) * 1e-5) * BACK);
        let back = (0..200).map(|k| (98.991 - f64::from(k).powi(2) * 1e-4) * BACK);
        let alpha: Vec<f64> = forwards.chain(rest).chain(back).collect();
        let sides = sides(&alpha, 1.0);
        let turn = sides.iter().position(|s| *s < 0.0).expect("it turns");
        assert!((950..1010).contains(&turn), "{turn}");
        assert!(sides[turn..].iter().all(|s| *s < 0.0));
    }
}
