//! Words of `[formats]` that a test says.

use nonius_model::design::{Design, Word};
use nonius_model::spec::Spec;

/// The key of a word within `[formats]`.
pub(crate) fn key(word: &Word) -> &str {
    word.key
        .strip_prefix("formats.")
        .expect("a word of [formats]")
}

/// Says a word that there is.
pub(crate) fn say(spec: &mut Spec, key: &str, value: i64) {
    assert!(spec.formats.set(key, Some(value)), "{key}");
}

/// The same chip, with every word said.
pub(crate) fn all_said(design: &Design) -> Spec {
    let mut spec = design.spec.clone();
    for word in design.word_lengths() {
        say(&mut spec, key(&word), word.value);
    }
    spec
}

/// `said` but for `value` of `key`; words of others that cannot stay with it are left to the analysis. `None` where there is no
/// such chip.
pub(crate) fn with(said: &Spec, key: &str, value: i64) -> Option<Design> {
    let mut spec = said.clone();
    say(&mut spec, key, value);
    loop {
        let refused = match Design::new(&spec) {
            Ok(design) => return Some(design),
            Err(refused) => refused,
        };
        let other = refused.field().strip_prefix("formats.")?;
        if other == key || spec.formats.given(other).is_none() || !spec.formats.set(other, None) {
            return None;
        }
    }
}
