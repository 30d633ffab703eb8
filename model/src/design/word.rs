//! One word length of a chip: what it is, who chose it, what it may be.

use serde::Serialize;

use super::limits::{self, Limits};
use super::refuse::refuse;
use super::{Design, DesignError};
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

impl Design {
    /// Every word length that the analysis chose or the design gives, in the order of [`Overrides::KEYS`]; words that this
    /// chip does not have are left out.
    #[must_use]
    pub fn word_lengths(&self) -> Vec<Word> {
        let mut list = limits::all(&self.words, &self.followers, &self.spec);
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
