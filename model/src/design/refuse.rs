//! How a field is refused: its value and its limit, in short.

use std::borrow::Cow;

use super::DesignError;

/// Characters from which on a number is shown in short.
const LONG: usize = 20;

/// A refusal of what `field` says.
pub(super) fn refuse<T>(
    field: impl Into<Cow<'static, str>>,
    value: impl ToString,
    limit: impl ToString,
    reason: impl ToString,
) -> Result<T, DesignError> {
    let field = field.into();
    let (value, limit, reason) = (value.to_string(), limit.to_string(), reason.to_string());
    // 1e300 has no use for its digits.
    let long = value.parse().ok().filter(|_| value.len() > LONG);
    let value = long.map_or(value, number);
    Err(DesignError::Field {
        field,
        value,
        limit,
        reason,
    })
}

/// Refuses a number outside `low` … `high`, and what is no number.
pub(super) fn between(
    field: impl Into<Cow<'static, str>>,
    value: f64,
    low: f64,
    high: f64,
    reason: &str,
) -> Result<(), DesignError> {
    if value.is_finite() && value >= low && value <= high {
        return Ok(());
    }
    refuse(field, number(value), limits(low, high), reason)
}

/// Both ends in short, rounded to what is allowed.
pub(super) fn limits(low: f64, high: f64) -> String {
    format!("{} … {}", inwards(low, true), inwards(high, false))
}

/// In short, and not below.
pub(super) fn at_least(low: f64) -> String {
    format!("at least {}", inwards(low, true))
}

/// In short, and not above.
pub(super) fn at_most(high: f64) -> String {
    format!("at most {}", inwards(high, false))
}

fn inwards(end: f64, up: bool) -> String {
    let short = number(end).parse().unwrap_or(end);
    if short == end || (short > end) == up {
        return number(end);
    }
    let last = 10f64.powf(end.abs().log10().floor() - 4.0);
    number(if up { short + last } else { short - last })
}

/// Short, whatever its size.
pub(super) fn number(value: f64) -> String {
    let plain = value.to_string();
    if plain.len() <= 9 {
        return plain;
    }
    let rounded = format!("{value:.4e}").parse().unwrap_or(value);
    let plain = rounded.to_string();
    if plain.len() <= 9 {
        plain
    } else {
        format!("{rounded:e}")
    }
}
