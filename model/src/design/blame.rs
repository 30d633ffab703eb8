//! Which key leads to a signal that does not fit: the word of the user's without which every signal does.

use super::refuse::number;
use super::{Design, DesignError, Refused};
use crate::graph::RangeError;
use crate::spec::{Overrides, Spec};

fn fits(spec: &Spec) -> bool {
    !matches!(Design::recorded(spec), Err(Refused::Range(_)))
}

/// The refusal with its key: a word of the user's alone, or with those before it; else the accuracy that the words
/// follow from.
pub(super) fn of_range(spec: &Spec, error: RangeError) -> DesignError {
    let range = |field: String, value: String| DesignError::Range {
        field: field.into(),
        value,
        error: Box::new(error.clone()),
    };
    let given = || {
        let keys = Overrides::KEYS.iter();
        keys.filter_map(|key| Some((*key, spec.formats.given(key)?)))
    };
    let mut without_all = spec.clone();
    let mut together = None;
    for (key, value) in given() {
        let mut without = spec.clone();
        let _ = without.formats.set(key, None);
        let _ = without_all.formats.set(key, None);
        if fits(&without) {
            return range(format!("formats.{key}"), value.to_string());
        }
        if together.is_none() && fits(&without_all) {
            together = Some((key, value));
        }
    }
    if let Some((key, value)) = together {
        return range(format!("formats.{key}"), value.to_string());
    }
    // Every word follows from it, and every design has it.
    range(
        "accuracy.rms_periods".into(),
        number(spec.accuracy.rms_periods),
    )
}
