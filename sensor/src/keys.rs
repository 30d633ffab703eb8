//! Keys and names that are not known, and the ones that are nearest to them.

use toml::de::Error;

/// Share of its letters that a name may be off a known one which is meant.
const ALIKE: f64 = 0.5;

/// What the reader says, and what may have been meant.
pub(crate) fn with_nearest(error: &Error) -> String {
    let message = error.message();
    match nearest(message) {
        Some(name) => format!("{message}; did you mean `{name}`?"),
        None => message.to_owned(),
    }
}

/// Of "unknown field `x`, expected one of `a`, `b`", the expected name nearest to x.
fn nearest(message: &str) -> Option<&str> {
    if !message.contains("unknown") {
        return None;
    }
    let mut names = message.split('`').skip(1).step_by(2);
    let wrong = names.next()?;
    names
        .map(|name| (strsim::normalized_damerau_levenshtein(wrong, name), name))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_nearest_of_the_expected_names() {
        let said = |words: &str| nearest(words).map(str::to_owned);
        assert_eq!(
            said("unknown field `delay`, expected one of `depth`, `delay_s`").as_deref(),
            Some("delay_s")
        );
        assert_eq!(
            said("unknown field `lbs`, expected one of `bits`, `lsb`").as_deref(),
            Some("lsb")
        );
        assert_eq!(said("unknown field `x`, expected `delay_s`"), None);
        assert_eq!(said("missing field `delay_s`"), None);
    }
}
