//! One word length of a chip: what it is, who chose it, what it may be.

use std::borrow::Cow;

use serde::Serialize;

use super::refuse::refuse;
use super::{Design, DesignError, Words, budget};
use crate::spec::{Overrides, Spec};

/// A word length of this chip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Word {
    /// Its key in `design.toml`, with the section.
    pub key: String,
    /// Bits, fraction bits or log2, as the key says.
    pub value: i64,
    /// True where the design says it, false where the analysis chose it.
    pub overridden: bool,
    /// The smallest that it may be, with the other words as they are.
    pub lowest: i64,
    /// The largest.
    pub highest: i64,
    /// What it is.
    pub meaning: &'static str,
}

/// A word length and its ends.
pub(super) struct Limits {
    pub(super) key: &'static str,
    pub(super) value: i64,
    pub(super) lowest: i64,
    pub(super) highest: i64,
    /// Why these are its ends.
    pub(super) why: Cow<'static, str>,
    /// Why this chip has no such word.
    pub(super) absent: Option<&'static str>,
}

/// No word has more bits, and no range is further from 1: what is beyond is refused before anything is made of it.
const WIDEST: i64 = 64;

/// Refuses what is no word length whatever the chip.
pub(super) fn plausible(spec: &Spec) -> Result<(), DesignError> {
    for key in Overrides::KEYS {
        let range = key.ends_with("_range_log2");
        let lowest = if range { -WIDEST } else { 1 };
        match spec.formats.given(key) {
            Some(n) if !(lowest..=WIDEST).contains(&n) => {
                return refuse(
                    format!("formats.{key}"),
                    n,
                    format!("{lowest} … {WIDEST}, and less as the other words are"),
                    "no chip has such a word",
                );
            }
            _ => {}
        }
    }
    Ok(())
}

/// Refuses a word of the user's that this chip does not have.
pub(super) fn present(spec: &Spec, list: &[Limits]) -> Result<(), DesignError> {
    let absent = |l: &&Limits| l.absent.is_some() && spec.formats.given(l.key).is_some();
    match list.iter().find(absent) {
        None => Ok(()),
        Some(l) => refuse(
            format!("formats.{}", l.key),
            spec.formats.given(l.key).unwrap_or_default(),
            "leave it out",
            format!(
                "this chip has no such word: {}",
                l.absent.unwrap_or_default()
            ),
        ),
    }
}

/// Refuses a word of the user's outside its ends.
pub(super) fn inside(spec: &Spec, list: &[Limits]) -> Result<(), DesignError> {
    let outside = |l: &&Limits| {
        let given = spec.formats.given(l.key);
        given.is_some_and(|n| !(l.lowest..=l.highest).contains(&n))
    };
    match list.iter().find(outside) {
        None => Ok(()),
        Some(l) => refuse(
            format!("formats.{}", l.key),
            spec.formats.given(l.key).unwrap_or_default(),
            format!("{} … {}", l.lowest, l.highest),
            &l.why,
        ),
    }
}

/// What the words of the budget may be, each with those before it as they are.
pub(super) fn of_budget(words: &Words, spec: &Spec) -> Vec<Limits> {
    let values = [
        ("signal_fraction", words.signal_fraction),
        ("phase_bits", words.phase_bits),
        ("sine_phase_bits", words.sine_phase_bits),
        ("sine_rows_log2", words.sine_rows_log2),
        ("harmonic_rows_log2", words.harmonic_rows_log2),
        ("accumulator_fraction", words.accumulator_fraction),
    ];
    let harmonics = spec.correction.harmonics.is_empty();
    let absent = |key: &str| match key {
        "harmonic_rows_log2" if harmonics => Some("there are no correction.harmonics"),
        "accumulator_fraction" if spec.calibration.parameters == 0 => {
            Some("calibration.parameters is 0")
        }
        _ => None,
    };
    values
        .into_iter()
        .map(|(key, value)| {
            let (lowest, highest) = budget::limits(key, words);
            Limits {
                key,
                value: value.into(),
                lowest: lowest.into(),
                highest: highest.into(),
                why: "the chip cannot be built with it".into(),
                absent: absent(key),
            }
        })
        .collect()
}

impl Design {
    /// Every word length that the analysis chose or the design gives, in the order of [`Overrides::KEYS`]; words that this
    /// chip does not have are left out.
    #[must_use]
    pub fn word_lengths(&self) -> Vec<Word> {
        let mut list = of_budget(&self.words, &self.spec);
        list.extend(self.followers.limits(&self.words, &self.spec));
        let place = |l: &Limits| Overrides::KEYS.iter().position(|key| *key == l.key);
        list.sort_by_key(place);
        list.into_iter()
            .filter(|l| l.absent.is_none())
            .map(|l| Word {
                key: format!("formats.{}", l.key),
                value: l.value,
                overridden: self.spec.formats.given(l.key).is_some(),
                lowest: l.lowest,
                highest: l.highest,
                meaning: Overrides::meaning(l.key).unwrap_or_default(),
            })
            .collect()
    }
}
