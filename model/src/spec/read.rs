//! Reading `design.toml`, with errors that name the place and the way out.

use thiserror::Error;
use toml::de::{DeTable, DeValue};

use super::large::too_large;
use super::place::{Place, field_at};
use super::{Overrides, Spec};

/// What is wrong with a `design.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SpecError {
    /// Not TOML, a missing key, or a value of the wrong kind.
    #[error("{file}:{message}")]
    Form {
        /// Name of the file.
        file: String,
        /// Line, column and what was expected.
        message: String,
    },
    /// A key that does not exist.
    #[error("{file}:{place}: unknown key `{key}`{hint}")]
    UnknownKey {
        /// Name of the file.
        file: String,
        /// Where the key stands.
        place: Place,
        /// The key with its section.
        key: String,
        /// The nearest known one.
        hint: String,
    },
}

const TOP: &[&str] = &[
    "name",
    "description",
    "sensor",
    "adc",
    "loop",
    "calibration",
    "correction",
    "accuracy",
    "chip",
    "formats",
];

/// Sections and their keys.
const KEYS: &[(&str, &[&str])] = &[
    (
        "sensor",
        &[
            "amplitude",
            "amplitude_tolerance",
            "offset_max",
            "phase_error_max_deg",
            "noise_rms",
            "bend_max",
            "speed_max_periods_per_s",
            "scale_period_m",
            "periods_per_revolution",
        ],
    ),
    (
        "adc",
        &["bits", "full_scale", "middle", "coding", "sample_rate_hz"],
    ),
    (
        "loop",
        &["method", "type", "bandwidth_hz", "damping", "pole"],
    ),
    (
        "calibration",
        &[
            "parameters",
            "method",
            "start",
            "forgetting",
            "completion",
            "completion_gamma",
            "lag",
            "gamma_first",
            "gamma_last",
            "gear_periods",
            "restart_residual",
            "hold_residual",
            "hold_periods",
            "recall",
        ],
    ),
    ("correction", &["channel_skew_s", "harmonics"]),
    (
        "correction.harmonics",
        &[
            "order",
            "amplitude_cos",
            "phase_cos",
            "amplitude_sin",
            "phase_sin",
        ],
    ),
    ("accuracy", &["rms_periods", "arithmetic_share"]),
    ("chip", &["multipliers", "clock_hz", "count_bits"]),
    ("formats", Overrides::KEYS),
];

/// Every section of a design, and a key that may stand in it.
pub fn keys() -> impl Iterator<Item = (&'static str, &'static str)> {
    let pairs = |&(section, keys): &(&'static str, &'static [&'static str])| {
        keys.iter().map(move |&key| (section, key))
    };
    KEYS.iter().flat_map(pairs)
}

fn known(section: &str) -> Option<&'static [&'static str]> {
    KEYS.iter()
        .find(|(name, _)| *name == section)
        .map(|(_, keys)| *keys)
}

impl Spec {
    /// Reads the text of a `design.toml`; `file` is its name for error messages.
    ///
    /// # Errors
    /// [`SpecError`] names file, line, column and what to write instead.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, SpecError> {
        let form = |e: toml::de::Error| SpecError::Form {
            file: file.into(),
            message: place(text, &e),
        };
        let table = DeTable::parse(text).map_err(form)?;
        unknown_keys(table.get_ref(), text, file)?;
        toml::from_str(text).map_err(form)
    }
}

fn place(text: &str, error: &toml::de::Error) -> String {
    let message = error.message();
    match error.span() {
        Some(span) => {
            let place = Place::of_byte(text, span.start);
            if let Some(large) = too_large(text, span.clone(), message) {
                return format!("{place}: {large}");
            }
            let of =
                field_at(text, span.start).map_or_else(String::new, |field| format!("{field}: "));
            format!("{place}: {of}{}", plain(message))
        }
        None => format!("1:1: {}", plain(message)),
    }
}

/// Without the names that Rust has for kinds of values.
fn plain(message: &str) -> String {
    let message = match message.split_once("expected struct ") {
        Some((before, _)) => format!("{before}expected a section"),
        None => message.to_owned(),
    };
    message
        .replace("expected u32", "expected a whole number, 0 or more")
        .replace("expected i32", "expected a whole number")
        .replace("expected f64", "expected a number")
        .replace("floating point `", "`")
        .replace("integer `", "`")
        .replace("` as i128", "`")
        .replace("` as u128", "`")
}

fn unknown_keys(table: &DeTable, text: &str, file: &str) -> Result<(), SpecError> {
    check(table, TOP, None, text, file)?;
    for (section, value) in table {
        let section: &str = section.get_ref();
        let Some(names) = known(section) else {
            continue;
        };
        let DeValue::Table(inner) = value.get_ref() else {
            let place = Place::of_byte(text, value.span().start);
            return Err(SpecError::Form {
                file: file.into(),
                message: format!(
                    "{place}: {section}: expected a section, [{section}], with its keys"
                ),
            });
        };
        check(inner, names, Some(section), text, file)?;
        for (key, value) in inner {
            let list = format!("{section}.{}", key.get_ref());
            let (Some(names), DeValue::Array(entries)) = (known(&list), value.get_ref()) else {
                continue;
            };
            for (n, entry) in (1..).zip(entries.iter()) {
                if let DeValue::Table(entry) = entry.get_ref() {
                    check(entry, names, Some(&format!("{list}[{n}]")), text, file)?;
                }
            }
        }
    }
    Ok(())
}

fn check(
    table: &DeTable,
    names: &[&str],
    section: Option<&str>,
    text: &str,
    file: &str,
) -> Result<(), SpecError> {
    let mut unknown = table
        .keys()
        .filter(|key| !names.contains(&key.get_ref().as_ref()));
    let Some(found) = unknown.next() else {
        return Ok(());
    };
    let key: &str = found.get_ref();
    let best = names
        .iter()
        .map(|n| (strsim::jaro_winkler(key, n), *n))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.7);
    let hint = match best {
        Some((_, name)) => format!("; did you mean `{name}`?"),
        None => format!("; known here: {}", names.join(", ")),
    };
    Err(SpecError::UnknownKey {
        file: file.into(),
        place: Place::of_byte(text, found.span().start),
        key: section.map_or_else(|| key.to_owned(), |s| format!("{s}.{key}")),
        hint,
    })
}
