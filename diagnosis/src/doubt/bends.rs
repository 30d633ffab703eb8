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

/// A bend beside steps of the ADC may be the smooth part of the same converter's error, and nothing tells, unless the data has named
/// another rival; a harmonic, which holds every bend, is less likely than that.
pub(super) fn may_be_the_converters(found: &mut Selection) {
    let converter = Cause::AdcNonlinearity;
    let sure = found.accepted.iter_mut().filter(|one| !one.doubted);
    let (steps, others): (Vec<_>, Vec<_>) = sure.partition(|one| one.candidate.name == converter);
    if steps.is_empty() {
        return;
    }
    let alone = |one: &Accepted| one.confounded.iter().all(|r| *r == Cause::SpatialHarmonic);
    for one in others {
        if one.candidate.name.is_a_bend() && alone(one) {
            one.confounded = vec![converter];
        }
    }
}

/// Takes three saturations and more back, or a strong one with two other strong bends, where none is most of what they explain. Two
/// saturations alone may be those of two channels.
pub(super) fn of_no_one_kind(system: &System, found: &mut Selection) -> Option<Unnamed> {
    let named = |name: Cause| -> Vec<usize> {
        let own = |one: &Accepted| !one.doubted && one.candidate.name == name;
        let all = found.accepted.iter().enumerate();
        all.filter(|(_, one)| own(one)).map(|(i, _)| i).collect()
    };
    let [saturations, others @ ..] = &BENDS.map(named);
    let bends = [saturations.as_slice(), &others.concat()].concat();
    if saturations.is_empty() {
        return None;
    }
    let everything = found.of(found.accepted.clone(), system);
    let gain = |own: &[usize]| all_gain_of(system, &everything, own);
    let no_one_is_most = |own: &[usize]| {
        let most = alone(system, &everything, own).fold(0.0, f64::max);
        own.len() > 2 && most < HOLDS * gain(own)
    };
    let is_strong = |own: &&Vec<usize>| !own.is_empty() && gain(own) > STRONG * gain(&bends);
    let kinds = || is_strong(&saturations) && others.iter().filter(is_strong).count() > 1;
    let own = if no_one_is_most(saturations) {
        saturations
    } else if no_one_is_most(&bends) && kinds() {
        &bends
    } else {
        return None;
    };
    let all = gain(own);
    own.iter().for_each(|i| found.accepted[*i].doubted = true);
    let but = "several bends together follow what none of them does, as a converter's smooth error may be";
    Some(unnamed(Domain::Angle, Cause::Saturation, all, but))
}
