//! A look two causes ahead. What is late, what is slow and what couples do much alike: of two that are there together, a third
//! may explain more alone than either. It is not named where two others explain clearly more than it does with any second;
//! and where another does as much beside the same second, nothing tells the two.

use crate::causes;
use crate::causes::candidate::Domain;
use crate::context::Context;
use crate::finding::Cause;
use crate::select::beside::Beside;
use crate::select::score::{Scored, can_be};

/// Log-likelihood by which two others have to explain more, beside the share of it that tangents may be off.
const CLEARLY: f64 = 8.0;
const OFF: f64 = 0.005;
/// Log-likelihood that does not tell one from another.
const ALIKE: f64 = 3.0;

/// What two causes together say of the first.
#[derive(Default)]
pub(crate) struct Ahead {
    /// Two others explain clearly more than it does with any second.
    pub(crate) outdone: bool,
    /// What does as much in its place.
    pub(crate) rival: Option<Cause>,
}

/// What two causes explain together, each number at its price.
type Pair<'a> = (f64, [&'a Scored; 2]);

fn best<'a>(pairs: impl Iterator<Item = Pair<'a>>) -> Option<Pair<'a>> {
    pairs.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Looks at all pairs of causes that go with the speed.
pub(crate) fn look(
    context: &Context,
    beside: &Beside,
    own: &Scored,
    rest: &[&Scored],
    price: f64,
) -> Ahead {
    if own.candidate.domain != Domain::Speed {
        return Ahead::default();
    }
    let another = |o: &&Scored| o.candidate.domain == Domain::Speed && name(o) != name(own);
    let others: Vec<&Scored> = rest.iter().copied().filter(another).collect();
    let alone = own.paid(price);
    let with = others.iter().filter_map(|o| pair(beside, [own, o], price));
    let with = best(with).map_or(alone, |p| p.0.max(alone));
    let without = others.iter().enumerate().flat_map(|(i, a)| {
        let told = others[i + 1..].iter().filter(|b| name(b) != name(a));
        told.filter_map(|b| pair(beside, [a, b], price))
    });
    let Some((without, names)) = best(without) else {
        return Ahead::default();
    };
    // The one of the two that explains more alone stands in its place.
    let other = names.into_iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
    let alike = with > alone + CLEARLY && without > with - ALIKE;
    Ahead {
        // Where the speed hardly changes, two of them make up for anything.
        outdone: causes::speed_varies_much(context) && without > with + CLEARLY + OFF * with,
        rival: other.filter(|_| alike).map(name),
    }
}

fn name(of: &Scored) -> Cause {
    of.candidate.name
}

/// Two causes, if they can be there together.
fn pair<'a>(beside: &Beside, both: [&'a Scored; 2], price: f64) -> Option<Pair<'a>> {
    let shapes = both.map(|s| s.candidate.shapes.as_slice()).concat();
    let solution = beside.solve(&shapes);
    let (first, second) = solution.x.split_at(both[0].candidate.shapes.len());
    let error = |i: usize| solution.covariance[(i, i)].sqrt();
    let possible = can_be(&both[0].candidate, first, error)
        && can_be(&both[1].candidate, second, |i| error(first.len() + i));
    let worth = solution.gain() - price * solution.rank as f64;
    possible.then_some((worth, both))
}
