//! Units as instruments write them: in a row of their own below the header, or in the name of a column.

use crate::cells::{Cells, number};
use crate::columns::{Header, Role};
use crate::error::ErrorKind;

/// Units of time, and their lengths in seconds.
const TIMES: [(&[&str], f64); 4] = [
    (&["s", "sec", "second", "seconds"], 1.0),
    (&["ms", "msec", "millisecond", "milliseconds"], 1e-3),
    (
        &["us", "µs", "μs", "usec", "microsecond", "microseconds"],
        1e-6,
    ),
    (&["ns", "nsec", "nanosecond", "nanoseconds"], 1e-9),
];
/// Units of a signal. A converter's codes have one, too.
const SIGNALS: [&str; 22] = [
    "a",
    "ma",
    "ua",
    "µa",
    "v",
    "volt",
    "volts",
    "mv",
    "millivolt",
    "millivolts",
    "uv",
    "µv",
    "μv",
    "kv",
    "value",
    "ampl",
    "amplitude",
    "lsb",
    "code",
    "codes",
    "count",
    "counts",
];

/// What stands before a unit in a name.
const SPLIT: [char; 5] = ['_', ' ', '/', '(', '['];

/// A unit without the brackets around it, in small letters.
fn plain(text: &str) -> String {
    let inside = text.trim().trim_start_matches(['(', '[']);
    inside.trim_end_matches([')', ']']).trim().to_lowercase()
}

/// Seconds in a unit of time.
fn seconds(unit: &str) -> Option<f64> {
    let unit = plain(unit);
    let known = TIMES.iter().find(|(names, _)| names.contains(&&*unit));
    known.map(|(_, seconds)| *seconds)
}

/// A unit of a signal.
fn signal(unit: &str) -> Option<String> {
    Some(plain(unit)).filter(|unit| SIGNALS.contains(&unit.as_str()))
}

/// Seconds in the unit that the name of a column ends with: `Time (ms)`, `Time [s]`, `t/ms`, `time_us`.
pub(crate) fn of_name(name: &str) -> Option<f64> {
    let last = name.rsplit(SPLIT).next()?;
    seconds(last).filter(|_| last.len() < name.len())
}

/// Refuses signals whose names say two units.
pub(crate) fn one_of_names(header: &Header) -> Result<(), ErrorKind> {
    let unit = |role| {
        // A letter behind a dash below the line is a channel: `enc_a`.
        let last = header.name(role)?.rsplit(&SPLIT[1..]).next()?;
        signal(last)
    };
    match (unit(Role::Cos), unit(Role::Sin)) {
        (Some(first), Some(second)) if first != second => {
            Err(ErrorKind::TwoUnits { first, second })
        }
        _ => Ok(()),
    }
}

/// What a row of units says.
pub(crate) struct Units {
    /// Seconds in the unit of time, where there is a column of times.
    pub(crate) seconds: Option<f64>,
}

impl Units {
    /// Reads a line as a row of units; nothing where it is none.
    ///
    /// # Errors
    /// Where the signals have different ones, with the byte of the second.
    pub(crate) fn of(line: &str, header: &Header) -> Result<Option<Self>, (usize, ErrorKind)> {
        let (mut time, mut signals) = (None, vec![]);
        for (cell, role) in Cells::new(line, header.separator).zip(&header.roles) {
            let Ok(cell) = cell else { return Ok(None) };
            if !role.is_unused() && number(&cell.text, header.has_decimal_comma()).is_some() {
                return Ok(None);
            }
            match role {
                Role::Time => time = seconds(&cell.text),
                Role::Cos | Role::Sin => signals.extend(signal(&cell.text).map(|u| (cell.at, u))),
                _ => {}
            }
        }
        let [(_, first), (at, second)] = &signals[..] else {
            return Ok(None);
        };
        if header.roles.contains(&Role::Time) && time.is_none() {
            return Ok(None);
        }
        if first != second {
            let (first, second) = (first.clone(), second.clone());
            return Err((*at, ErrorKind::TwoUnits { first, second }));
        }
        Ok(Some(Self { seconds: time }))
    }
}

#[cfg(test)]
mod tests {
    use super::of_name;

    #[test]
    fn a_name_ends_with_its_unit() {
        for (name, seconds) in [
            ("Time (ms)", Some(1e-3)),
            ("Time [s]", Some(1.0)),
            ("time_us", Some(1e-6)),
            ("t [µs]", Some(1e-6)),
            ("t/ms", Some(1e-3)),
            ("time", None),
            ("s", None),
            ("ms", None),
            ("in1", None),
        ] {
            assert_eq!(of_name(name), seconds, "{name}");
        }
    }
}
