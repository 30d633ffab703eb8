//! The shortest words whose errors together keep to the budget.

use super::budget::{self, Budget};
use super::followers::adds;
use super::formats::level_bits;
use super::lengths::Lengths;
use super::limits::absent;
use super::refuse::{number, refuse};
use super::{DesignError, Loop, word};
use crate::spec::{Overrides, Spec};

/// What is said in five digits is accepted.
const ROUNDED: f64 = 1.0001;

/// Where a word of the user's misses the budget, the others add no more than this.
const MUCH_AS_GOOD: f64 = 1.05;

/// Words that decide what others cost, and the largest share of what those before it leave of the budget's square, with all others
/// as long as may be. A row more adds a sixteenth: what that frees for the others, at most 0.875 / 0.5 of what they had for each
/// table, must stay below four, which is a bit of each.
const FIRST: [(&str, f64); 3] = [
    ("signal_fraction", 0.75),
    ("sine_rows_log2", 0.5),
    ("harmonic_rows_log2", 0.5),
];

/// Chooses the words that keep the sum of all errors within what is allowed, each so short that one bit less would not.
///
/// The [`FIRST`] take their share. From the longest on, the others get shorter by a bit at a time, always the one that adds least,
/// until that is more than is left: then it is for each. Which one adds least does not hang on what is allowed, so with the same
/// signals and rows more accuracy stops sooner on the same way; and twice the accuracy shortens no word, whatever these are then.
pub(super) fn choose(spec: &Spec, tracking: &Loop) -> Result<(Lengths, Budget), DesignError> {
    let kept = |all: &Lengths| budget::of(all, spec, tracking);
    let adds_up = |all: &Lengths| kept(all).arithmetic();
    let least = kept(&longest(spec, tracking));
    // What is missed with the longest words is missed because of a word that the user chose: then the others are as
    // long as adds little to that.
    let enough = if spec.formats == Overrides::default() {
        least.allowed
    } else {
        least.allowed.max(MUCH_AS_GOOD * least.arithmetic())
    };
    if least.arithmetic() > enough {
        return too_fine(spec, &least);
    }
    let free = |spec: &Spec, key: &str| {
        adds(key) && spec.formats.given(key).is_none() && absent(key, spec).is_none()
    };
    let first = FIRST.into_iter().filter(|(key, _)| free(spec, key));
    let settled = first.fold(spec.clone(), |spec, (key, share)| {
        let all = longest(&spec, tracking);
        let others = adds_up(&all).powi(2);
        let most = others + share * (enough.powi(2) - others);
        let (low, high) = all.ends(key, &spec);
        let each = (low..=high).map(|bits| saying(&spec, key, bits));
        // Where what the user says of others can be, if anywhere.
        let (beside, not): (Vec<Spec>, Vec<Spec>) = each
            .partition(|spec| word::inside(spec, &longest(spec, tracking).limits(spec)).is_ok());
        let mut may = if beside.is_empty() { not } else { beside };
        let fits = |spec: &Spec| adds_up(&longest(spec, tracking)).powi(2) <= most;
        let first = may.iter().position(fits);
        may.swap_remove(first.unwrap_or(may.len() - 1))
    });
    let mut all = longest(&settled, tracking);
    loop {
        let limits = all.limits(spec);
        let may = limits
            .iter()
            .filter(|l| free(&settled, l.key) && l.value > l.lowest);
        let shorter = may.map(|l| all.with(l.key, all.word(l.key) - 1));
        let each = shorter.map(|all| (adds_up(&all), all));
        match each.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((sum, shorter)) if sum <= enough => all = shorter,
            _ => break,
        }
    }
    let all = within(&all, spec);
    Ok((all, kept(&all)))
}

/// With this word of `key`, and the others as long as fits it.
fn saying(spec: &Spec, key: &str, bits: u32) -> Spec {
    let mut spec = spec.clone();
    // There is such a key, and any word can be said of it.
    let _ = spec.formats.set(key, Some(bits.into()));
    spec
}

/// As the user says, else as long as a chip may have it.
fn longest(spec: &Spec, tracking: &Loop) -> Lengths {
    Lengths::keys().fold(Lengths::default(), |all, key| {
        let (low, high) = all.ends(key, spec);
        let chosen = match key {
            _ if absent(key, spec).is_some() => low,
            "lock_level_bits" => level_bits(tracking),
            // One multiplier serves all: none wider than a signal.
            "gain_bits" | "cross_bits" | "bend_bits" | "cubic_bits" | "coefficient_bits"
            | "rate_high_bits" => high.min(all.words.signal_fraction + 2).max(low),
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
        format!(
            "at least {}",
            number(longest.arithmetic() / spec.accuracy.arithmetic_share * ROUNDED)
        ),
        format!(
            "accuracy.arithmetic_share leaves {:.3e} periods rms of it to the arithmetic, which adds {:.3e} with the \
             longest words that a chip may have; most of it: {}",
            longest.allowed,
            longest.arithmetic(),
            most.map_or("", |term| term.source),
        ),
    )
}
