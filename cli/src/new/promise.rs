//! What a draft promises of its sensor, and whether that holds what was measured.

use nonius_quantity::digits;

use super::draft::short;

/// A largest error of the sensor.
pub(super) struct Promise {
    /// As it is written, in the unit of its key.
    pub(super) value: f64,
    basis: Basis,
}

/// What a promise stands on.
enum Basis {
    /// Nothing that was measured; the unit.
    Example(&'static str),
    /// It holds what was measured, with something to spare.
    Held { measured: f64, spare: &'static str },
    /// It holds what was measured; with more to spare it would be more than a chip may promise.
    Most { measured: f64 },
    /// Less than what was measured: a chip may promise no more than this.
    Missed { measured: f64, most: f64 },
}

impl Promise {
    pub(super) fn example(value: f64, unit: &'static str) -> Self {
        let basis = Basis::Example(unit);
        Self { value, basis }
    }

    /// What is wanted, to hold what was measured and something to `spare`, where a chip may promise it.
    pub(super) fn of(measured: f64, wanted: f64, most: f64, spare: &'static str) -> Self {
        let basis = if measured.abs() > most {
            Basis::Missed { measured, most }
        } else if wanted > most {
            Basis::Most { measured }
        } else {
            Basis::Held { measured, spare }
        };
        let value = short(wanted.min(most));
        Self { value, basis }
    }

    /// Where it does not hold what was measured: how much that is, and the way out.
    pub(super) fn missed(&self) -> Option<String> {
        match self.basis {
            Basis::Missed { measured, most } => Some(beyond(measured, most)),
            _ => None,
        }
    }

    /// The comment beside it in the file.
    pub(super) fn comment(&self) -> String {
        let seen = |measured| format!("measured: {}", digits(measured, 4));
        match self.basis {
            Basis::Example(unit) => unit.into(),
            Basis::Held { measured, spare } => format!("{}; {spare}", seen(measured)),
            Basis::Most { measured } => {
                format!("{}; as much to spare as a chip may promise", seen(measured))
            }
            Basis::Missed { measured, most } => {
                format!("NOT ENOUGH: {}", beyond(measured, most))
            }
        }
    }
}

/// What no chip can promise, and what to do.
fn beyond(measured: f64, most: f64) -> String {
    let measured = digits(measured, 4);
    format!(
        "measured {measured}, and no chip is promised to hold more than {most}: adjust the sensor"
    )
}
