//! Reading `design.toml`, with errors that name the place and the way out.

use thiserror::Error;
use toml::{Table, Value};

use super::Spec;

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
    #[error("{file}:{line}: unknown key `{key}`{hint}")]
    UnknownKey {
        /// Name of the file.
        file: String,
        /// Line of the key.
        line: usize,
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
            "gamma_first",
            "gamma_last",
            "gear_periods",
            "restart_residual",
            "hold_residual",
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
    (
        "formats",
        &[
            "signal_fraction",
            "phase_bits",
            "sine_phase_bits",
            "sine_rows_log2",
            "harmonic_rows_log2",
            "accumulator_fraction",
        ],
    ),
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
    /// [`SpecError`] names file, line and what to write instead.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, SpecError> {
        let form = |e: toml::de::Error| SpecError::Form {
            file: file.into(),
            message: place(text, &e),
        };
        let table: Table = toml::from_str(text).map_err(form)?;
        unknown_keys(&table, text, file)?;
        toml::from_str(text).map_err(form)
    }
}

fn place(text: &str, error: &toml::de::Error) -> String {
    let message = error.message();
    match error.span() {
        Some(span) => {
            let before = text.get(..span.start).unwrap_or_default();
            let line = before.matches('\n').count() + 1;
            let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
            let here = text.lines().nth(line - 1).unwrap_or_default();
            let key = here.split_once('=').map_or("", |(key, _)| key.trim());
            let named =
                message.contains(&format!("`{key}`")) || key.is_empty() || key.starts_with('#');
            let of = if named {
                String::new()
            } else {
                format!("{key}: ")
            };
            format!("{line}:{column}: {of}{}", plain(message))
        }
        None => format!("1: {}", plain(message)),
    }
}

/// Without the names that Rust has for kinds of numbers.
fn plain(message: &str) -> String {
    message
        .replace("expected u32", "expected a whole number, 0 or more")
        .replace("expected f64", "expected a number")
        .replace("floating point `", "`")
        .replace("integer `", "`")
}

fn unknown_keys(table: &Table, text: &str, file: &str) -> Result<(), SpecError> {
    check(table.keys().map(String::as_str), TOP, None, text, file)?;
    for (section, value) in table {
        let (Some(names), Value::Table(inner)) = (known(section), value) else {
            continue;
        };
        let of = |inner: &Table, names: &[&str], section: &str| {
            let keys = inner.keys().map(String::as_str);
            check(keys, names, Some(section), text, file)
        };
        of(inner, names, section)?;
        for (key, value) in inner {
            let list = format!("{section}.{key}");
            let (Some(names), Value::Array(entries)) = (known(&list), value) else {
                continue;
            };
            for (n, entry) in (1..).zip(entries) {
                if let Value::Table(entry) = entry {
                    of(entry, names, &format!("{list}[{n}]"))?;
                }
            }
        }
    }
    Ok(())
}

fn check<'a>(
    keys: impl Iterator<Item = &'a str>,
    names: &[&str],
    section: Option<&str>,
    text: &str,
    file: &str,
) -> Result<(), SpecError> {
    let mut unknown = keys.filter(|k| !names.contains(k));
    let Some(key) = unknown.next() else {
        return Ok(());
    };
    let best = names
        .iter()
        .map(|n| (strsim::jaro_winkler(key, n), *n))
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .filter(|(likeness, _)| *likeness > 0.7);
    let hint = match best {
        Some((_, name)) => format!("; did you mean `{name}`?"),
        None => format!("; known here: {}", names.join(", ")),
    };
    let full = section.map_or_else(|| key.to_owned(), |s| format!("{s}.{key}"));
    let line = line_of(text, section, key);
    Err(SpecError::UnknownKey {
        file: file.into(),
        line,
        key: full,
        hint,
    })
}

/// The line of a `design.toml`, counted from 1, that gives `field` (`loop.type`, say, or `correction.harmonics[2].order` in
/// the second of them); `None` where none does.
#[must_use]
pub fn line_of_field(text: &str, field: &str) -> Option<usize> {
    let (section, key) = match field.rsplit_once('.') {
        Some((section, key)) => (Some(section), key),
        None => (None, field),
    };
    let line = line_of(text, section, key);
    let there = text.lines().nth(line - 1)?.trim();
    let header = there.trim_matches(['[', ']']).trim() == field;
    (header || there.starts_with(key)).then_some(line)
}

/// The line that defines `key` in `section`; 1 if it cannot be told (a dotted key, say).
fn line_of(text: &str, section: Option<&str>, key: &str) -> usize {
    let full = section.map_or_else(|| key.to_owned(), |s| format!("{s}.{key}"));
    let mut current: Option<String> = None;
    let mut entries: Vec<&str> = vec![];
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if let Some(header) = line.strip_prefix('[') {
            let name = header.trim_matches(['[', ']']).trim();
            if name == full {
                return number + 1;
            }
            current = Some(if header.starts_with('[') {
                entries.push(name);
                let n = entries.iter().filter(|e| **e == name).count();
                format!("{name}[{n}]")
            } else {
                name.to_owned()
            });
        } else if current.as_deref() == section && line.starts_with(key) {
            return number + 1;
        }
    }
    1
}
