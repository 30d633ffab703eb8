//! One word length of a chip: what it is, who chose it, what it may be.

use serde::Serialize;

use super::lengths::Lengths;
use super::limits::{self, Limits};
use super::refuse::refuse;
use super::{Design, DesignError, Loop, shortest};
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
const WIDEST_WORD: i64 = 64;

/// What a word of `key` may be whatever the chip.
fn plausible_ends(key: &str) -> (i64, i64) {
    let range = key.ends_with("_range_log2");
    (if range { -WIDEST_WORD } else { 1 }, WIDEST_WORD)
}

fn is_plausible(key: &str, n: i64) -> bool {
    let (lowest, highest) = plausible_ends(key);
    (lowest..=highest).contains(&n)
}

/// Refuses what is no word length whatever the chip.
pub(super) fn plausible(spec: &Spec, tracking: &Loop) -> Result<(), DesignError> {
    for key in Overrides::KEYS {
        match spec.formats.given(key) {
            Some(n) if !is_plausible(key, n) => {
                let ends = accepted(spec, key, tracking);
                let (lowest, highest) = ends.unwrap_or_else(|| plausible_ends(key));
                return refuse(
                    format!("formats.{key}"),
                    n,
                    format!("{lowest} … {highest}"),
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

/// The first word of the user's outside its ends.
pub(super) fn outside<'a>(spec: &Spec, list: &'a [Limits]) -> Option<&'a Limits> {
    list.iter().find(|l| {
        let given = spec.formats.given(l.key);
        given.is_some_and(|n| !(l.lowest..=l.highest).contains(&n))
    })
}

/// Refuses a word of the user's outside its ends.
pub(super) fn inside(spec: &Spec, list: &[Limits], tracking: &Loop) -> Result<(), DesignError> {
    let Some(l) = outside(spec, list) else {
        return Ok(());
    };
    let (lowest, highest) = accepted(spec, l.key, tracking).unwrap_or((l.lowest, l.highest));
    refuse(
        format!("formats.{}", l.key),
        spec.formats.given(l.key).unwrap_or_default(),
        format!("{lowest} … {highest}"),
        &l.why,
    )
}

/// What may be said of `key` beside the other words that are said; those that are not are chosen to fit it.
fn accepted(spec: &Spec, key: &str, tracking: &Loop) -> Option<(i64, i64)> {
    let saying = |value: Option<i64>| {
        let mut spec = spec.clone();
        spec.formats.set(key, value).then_some(spec)
    };
    let limits_of = |spec: &Spec| {
        let all_plausible = Overrides::KEYS.iter().all(|key| {
            let given = spec.formats.given(key);
            given.is_none_or(|n| is_plausible(key, n))
        });
        let chosen = all_plausible.then(|| shortest::choose(spec, tracking))?;
        Some(limits::all(&chosen.ok()?.0, spec))
    };
    let works = |value: i64| {
        let said = saying(Some(value)).filter(|_| is_plausible(key, value));
        said.is_some_and(|spec| {
            limits_of(&spec).is_some_and(|list| outside(&spec, &list).is_none())
        })
    };
    let beside = limits_of(&saying(None)?)?;
    let own = beside.iter().find(|l| l.key == key && l.absent.is_none())?;
    let (mut lowest, mut highest) = (own.lowest, own.highest);
    while works(lowest - 1) {
        lowest -= 1;
    }
    while works(highest + 1) {
        highest += 1;
    }
    Some((lowest, highest))
}

impl Design {
    /// Every word length that the analysis chose or the design gives, in the order of [`Overrides::KEYS`]; words that this
    /// chip does not have are left out.
    #[must_use]
    pub fn word_lengths(&self) -> Vec<Word> {
        let lengths = Lengths {
            words: self.words,
            followers: self.followers,
        };
        let mut list = limits::all(&lengths, &self.spec);
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
