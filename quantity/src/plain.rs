//! Numbers without an error.

use crate::prefix::prefix;

/// So many digits, and no zeros behind them when it is written.
#[must_use]
pub fn digits(value: f64, n: usize) -> f64 {
    let after = n.saturating_sub(1);
    format!("{value:.after$e}").parse().unwrap_or(value)
}

/// A number with three digits and a prefix.
#[must_use]
pub fn engineering(value: f64, unit: &str) -> String {
    // Rounded first: 999.96 is 1.00 k.
    let value = digits(value, 3);
    if value == 0.0 || !value.is_finite() {
        return format!("{value} {unit}");
    }
    let (prefix, power) = prefix(value, true);
    let scaled = value / 10f64.powi(power);
    let digits = (2 - scaled.abs().log10().floor() as i32).clamp(0, 3) as usize;
    format!("{scaled:.digits$} {prefix}{unit}")
}

/// A speed in scale periods per second: three digits, a prefix above a thousand, plain below 1, where "65.5 m" would be read as
/// metres.
#[must_use]
pub fn periods_per_second(value: f64) -> String {
    let value = digits(value, 3);
    if value.abs() < 1.0 {
        return format!("{value} periods/s");
    }
    format!("{} periods/s", engineering(value, "").trim_end())
}

#[test]
fn slow_speeds_are_plain() {
    for (value, text) in [
        (0.06554, "0.0655 periods/s"),
        (-2e-5, "-0.00002 periods/s"),
        (0.0, "0 periods/s"),
        (0.9999, "1.00 periods/s"),
        (65.54, "65.5 periods/s"),
        (1e5, "100 k periods/s"),
    ] {
        assert_eq!(periods_per_second(value), text);
    }
}

#[test]
fn prefixes_are_those_of_the_si() {
    for (value, text) in [
        (0.0, "0 Hz"),
        (1.0, "1.00 Hz"),
        (19e6, "19.0 MHz"),
        (-4.3e-9, "-4.30 nHz"),
        (999.96, "1.00 kHz"),
        (0.9999, "1.00 Hz"),
        (1e-18, "0.001 fHz"),
    ] {
        assert_eq!(engineering(value, "Hz"), text);
    }
}
