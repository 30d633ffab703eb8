//! Curves of the code, as a converter has them that errs smoothly, which no bend of the catalogue follows: several together do.

use crate::causes::candidate::Domain;
use crate::doubt::{all_gain_of, alone, unnamed};
use crate::finding::Cause;
use crate::model::System;
use crate::select::selection::{Accepted, Selection};
use crate::shapes::generic::HOLDS;
use crate::unnamed::unexplained::Unnamed;

/// What any curve of the code is made of.
const BENDS: [Cause; 4] = [
    Cause::Saturation,
    Cause::AdcNonlinearity,
    Cause::EvenNonlinearity,
    Cause::OddNonlinearity,
];
/// Share of what all explain from which on one is not what the others leave.
const STRONG: f64 = 0.1;

/// Takes several saturations back none of which is most of what they explain, and a strong saturation with two other strong
/// bends none of which is most of it.
pub(super) fn of_no_one_kind(system: &System, found: &mut Selection) -> Option<Unnamed> {
    let named = |name: Cause| -> Vec<usize> {
        let own = |one: &Accepted| !one.doubted && one.candidate.name == name;
        let all = found.accepted.iter().enumerate();
        all.filter(|(_, one)| own(one)).map(|(i, _)| i).collect()
    };
    let saturations = named(Cause::Saturation);
    if saturations.is_empty() {
        return None;
    }
    let kinds: Vec<Vec<usize>> = BENDS.into_iter().map(named).collect();
    let bends = kinds.concat();
    let everything = found.of(found.accepted.clone(), system);
    let gain = |own: &[usize]| all_gain_of(system, &everything, own);
    let no_one = |own: &[usize]| {
        let most = alone(system, &everything, own).fold(0.0, f64::max);
        most < HOLDS * gain(own)
    };
    let strong = || {
        let least = STRONG * gain(&bends);
        let is_strong = |own: &[usize]| !own.is_empty() && gain(own) > least;
        let kinds = kinds.iter().filter(|own| is_strong(own)).count();
        kinds > 2 && is_strong(&saturations)
    };
    let own = if saturations.len() > 1 && no_one(&saturations) {
        saturations
    } else if bends.len() > 2 && strong() && no_one(&bends) {
        bends
    } else {
        return None;
    };
    let gain = gain(&own);
    own.iter().for_each(|i| found.accepted[*i].doubted = true);
    let but = "several bends together follow what none of them does, as a converter's smooth error may be";
    Some(unnamed(Domain::Angle, Cause::Saturation, gain, but))
}
