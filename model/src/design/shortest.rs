//! The shortest words whose errors together keep to the budget.

use super::budget::{self, Budget};
use super::followers::adds;
use super::formats::{bits, level_bits, power_of};
use super::lengths::Lengths;
use super::limits::{absent, of_lengths};
use super::ranges::multiplied_top;
use super::refuse::{at_least, number, refuse};
use super::{DesignError, Loop, word};
use crate::spec::{Overrides, Spec};

/// Where a word of the user's misses the budget, the others make the sum no larger than by this.
const MUCH_AS_GOOD: f64 = 1.05;

/// Words that decide what others cost, and the largest share of what those before it leave of the budget's square, with all others
/// as long as may be. A row more adds a sixteenth: what that frees for the others, at most 0.875 / 0.5 of what they had for each
/// table, must stay below four, which is a bit of each.
const FIRST: [(&str, f64); 3] = [
    ("signal_fraction", 0.75),
    ("sine_rows_log2", 0.5),
    ("harmonic_rows_log2", 0.5),
];

/// log2 of the largest that a parameter is in most chips.
const USUAL_POWER: i32 = 2;

/// Chooses the words that keep the sum of all errors within what is allowed, each so short that one bit less would not.
///
/// The [`FIRST`] take their share. From the longest on, the others get shorter by a bit at a time, always the one that adds least,
/// until that is more than is left: then it is for each. Which one adds least does not hang on what is allowed, so with the same
/// signals and rows more accuracy stops sooner on the same way; and twice the accuracy shortens no word, whatever these are then.
pub(super) fn choose(spec: &Spec, tracking: &Loop) -> Result<(Lengths, Budget), DesignError> {
    let enough = enough(spec, tracking)?;
    let first = FIRST.iter().filter(|(key, _)| is_free(key, spec));
    let settled = first.fold(spec.clone(), |said, (key, share)| {
        with_share(&said, tracking, (key, *share), enough)
    });
    let shortest = within(&shortened(&settled, tracking, enough), spec);
    Ok((shortest, budget::of(&shortest, spec, tracking)))
}

/// The analysis chooses the word of `key`, by what it adds.
fn is_free(key: &str, spec: &Spec) -> bool {
    adds(key) && spec.formats.given(key).is_none() && absent(key, spec).is_none()
}

/// What these words add, periods rms.
fn added(lengths: &Lengths, spec: &Spec, tracking: &Loop) -> f64 {
    budget::of(lengths, spec, tracking).arithmetic()
}

/// What arithmetic may add: as much as is allowed, which is refused where the longest words add more. Where they do because of a
/// word that the user chose, a little more than they add.
fn enough(spec: &Spec, tracking: &Loop) -> Result<f64, DesignError> {
    let least = budget::of(&longest(spec, tracking), spec, tracking);
    let (allowed, added) = (least.allowed, least.arithmetic());
    if spec.formats != Overrides::default() {
        return Ok(allowed.max(MUCH_AS_GOOD * added));
    }
    if added > allowed {
        return too_fine(spec, &least);
    }
    Ok(allowed)
}

/// With the shortest word of `key` that, beside the longest of the others, takes no more than `share` of what these leave of the
/// square of `enough`; else with the longest.
fn with_share(spec: &Spec, tracking: &Loop, (key, share): (&str, f64), enough: f64) -> Spec {
    let all = longest(spec, tracking);
    let others = added(&all, spec, tracking).powi(2);
    let most = others + share * (enough.powi(2) - others);
    let (low, high) = all.ends(key, spec);
    let each = (low..=high).map(|word| {
        let mut spec = spec.clone();
        // There is such a key, and it can be any such number.
        let _ = spec.formats.set(key, Some(word.into()));
        let all = longest(&spec, tracking);
        (spec, all)
    });
    // Where what the user says of others can be, if anywhere.
    let (beside, not): (Vec<_>, Vec<_>) =
        each.partition(|(spec, all)| word::outside(spec, &of_lengths(all, spec)).is_none());
    let mut may = if beside.is_empty() { not } else { beside };
    let fits = |(spec, all): &(Spec, Lengths)| added(all, spec, tracking).powi(2) <= most;
    let shortest = may.iter().position(fits);
    may.swap_remove(shortest.unwrap_or(may.len() - 1)).0
}

/// From the longest words of `spec` on, the one that adds least shortened by a bit at a time, while they add no more than `enough`.
fn shortened(spec: &Spec, tracking: &Loop, enough: f64) -> Lengths {
    let mut all = longest(spec, tracking);
    loop {
        let limits = of_lengths(&all, spec);
        let may = limits
            .iter()
            .filter(|l| is_free(l.key, spec) && l.value > l.lowest);
        let each = may.map(|l| {
            let shorter = all.with(l.key, all.word(l.key) - 1);
            (added(&shorter, spec, tracking), shorter)
        });
        match each.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((sum, shorter)) if sum <= enough => all = shorter,
            _ => return all,
        }
    }
}

/// As the user says, else as long as a chip may have it.
fn longest(spec: &Spec, tracking: &Loop) -> Lengths {
    Lengths::keys().fold(Lengths::default(), |all, key| {
        let (low, high) = all.ends(key, spec);
        let chosen = match key {
            _ if absent(key, spec).is_some() => low,
            "lock_level_bits" => level_bits(tracking),
            // One multiplier serves all: none wider than a signal, or as fine as there where its range is wider.
            "gain_bits" | "cross_bits" | "bend_bits" | "cubic_bits" | "coefficient_bits"
            | "rate_high_bits" => {
                let above = bits(power_of(multiplied_top(key, spec)) - USUAL_POWER);
                high.min(all.words.signal_fraction + 2 + above).max(low)
            }
            _ => high,
        };
        let given = spec.formats.given(key).and_then(|n| u32::try_from(n).ok());
        all.with(key, given.unwrap_or(chosen))
    })
}

/// What was worth its bits beside longer words and is not beside those settled is cut: no such bit was used.
fn within(all: &Lengths, spec: &Spec) -> Lengths {
    let chosen = Lengths::keys().filter(|key| spec.formats.given(key).is_none());
    chosen.fold(*all, |all, key| {
        let (low, high) = all.ends(key, spec);
        all.with(key, all.word(key).min(high).max(low))
    })
}

fn too_fine<T>(spec: &Spec, longest: &Budget) -> Result<T, DesignError> {
    let most = longest.terms.iter();
    let most = most.max_by(|a, b| a.rms_periods.total_cmp(&b.rms_periods));
    refuse(
        "accuracy.rms_periods",
        number(spec.accuracy.rms_periods),
        at_least(longest.arithmetic() / spec.accuracy.arithmetic_share),
        format!(
            "accuracy.arithmetic_share leaves {:.3e} periods rms of it to the arithmetic, which adds {:.3e} with the \
             longest words that are of use; most of it: {}",
            longest.allowed,
            longest.arithmetic(),
            most.map_or("", |term| term.source),
        ),
    )
}
