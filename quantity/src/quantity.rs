//! A measured number: value, standard error, unit.

use crate::plain::digits;
use crate::prefix::prefix;

/// Digits of a number whose error allows more, or says nothing about them.
const DIGITS: i32 = 4;
/// Digits of an error.
const OF_ERROR: i32 = 2;
/// Most digits of anything.
const MOST: i32 = 12;

/// How a number is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit<'a> {
    /// With prefixes below and above one: Hz.
    Prefixed(&'a str),
    /// With prefixes below one alone: nobody writes kiloseconds.
    Small(&'a str),
    /// Without prefix; empty for a number without unit.
    Plain(&'a str),
    /// A fraction, in per cent.
    Percent,
}

/// A number with its standard error, which is zero where it is exact and not finite where it is not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity<'a> {
    value: f64,
    error: f64,
    unit: Unit<'a>,
}

/// The power of ten of the first digit of a number that is rounded to so many.
fn first_digit(value: f64, digits: i32) -> i32 {
    let after = (digits - 1).max(0) as usize;
    let text = format!("{:.after$e}", value.abs());
    let power = text.split_once('e').and_then(|(_, p)| p.parse().ok());
    power.unwrap_or(0)
}

/// Divides by a power of ten: exactly, where that can be.
fn over(value: f64, power: i32) -> f64 {
    if power < 0 {
        value * 10f64.powi(-power)
    } else {
        value / 10f64.powi(power)
    }
}

/// So many units of a power of ten, as a decimal number.
fn decimal(count: f64, power: i32) -> String {
    // Not −0.
    let value = over(count, -power) + 0.0;
    format!("{value:.*}", (-power).max(0) as usize)
}

impl<'a> Quantity<'a> {
    /// A number as it is known.
    #[must_use]
    pub fn new(value: f64, error: f64, unit: Unit<'a>) -> Self {
        Self { value, error, unit }
    }

    /// So many digits of a number without an error.
    #[must_use]
    pub fn rounded(value: f64, n: usize, unit: Unit<'a>) -> Self {
        Self::new(digits(value, n), 0.0, unit)
    }

    /// The error, where it says something.
    fn known_error(&self) -> Option<f64> {
        (self.error > 0.0 && self.error.is_finite()).then_some(self.error)
    }

    /// The unit with the prefix for a number of this size, and the power of ten that it stands for.
    fn unit_of(&self, size: f64) -> (String, i32) {
        match self.unit {
            Unit::Prefixed(unit) | Unit::Small(unit) => {
                let (name, power) = prefix(size, matches!(self.unit, Unit::Prefixed(_)));
                (format!("{name}{unit}"), power)
            }
            Unit::Plain(unit) => (unit.into(), 0),
            Unit::Percent => ("%".into(), -2),
        }
    }

    /// As a table has it: value ± error, with two digits of the error, and the unit for a column of its own.
    #[must_use]
    pub fn apart(&self) -> (String, String) {
        let Some(error) = self.known_error().filter(|_| self.value.is_finite()) else {
            return self.short();
        };
        let size = self.value.abs().max(error);
        let last = first_digit(error, OF_ERROR) - OF_ERROR + 1;
        let last = last.max(first_digit(size, MOST) - MOST + 1);
        let [value, error, size] = [self.value, error, size].map(|v| over(v, last).round());
        let (unit, power) = self.unit_of(over(size, -last));
        let text = format!(
            "{} ± {}",
            decimal(value, last - power),
            decimal(error, last - power)
        );
        (text, unit)
    }

    /// The value in no more digits than its error allows, and no more than four.
    fn short(&self) -> (String, String) {
        let value = self.value;
        if value == 0.0 || !value.is_finite() {
            return (value.to_string(), self.unit_of(value).0);
        }
        let last = |value: f64| {
            let most = first_digit(value, DIGITS);
            let sure = self.known_error().map_or(i32::MIN, |e| first_digit(e, 1));
            sure.max(most - DIGITS + 1)
        };
        // Rounded first: 999.96 is 1.000 k.
        let round = decimal(over(value, last(value)).round(), last(value));
        let round = round.parse().unwrap_or(value);
        let last = last(if round == 0.0 { value } else { round });
        let count = over(value, last).round();
        let (unit, power) = self.unit_of(over(count, -last));
        let mut text = decimal(count, last - power);
        if self.error == 0.0 && text.contains('.') {
            // An exact number has no zeros at its end.
            let end = text.trim_end_matches('0').trim_end_matches('.').len();
            text.truncate(end);
        }
        (text, unit)
    }

    /// In a sentence: "1.31 µs", "0.372 %".
    #[must_use]
    pub fn brief(&self) -> String {
        let (value, unit) = self.short();
        let space = if unit.is_empty() { "" } else { " " };
        format!("{value}{space}{unit}")
    }
}

/// The unit with the prefix for numbers up to this size, and what they are multiplied by: for an axis.
#[must_use]
pub fn prefixed(size: f64, unit: Unit) -> (String, f64) {
    let (unit, power) = Quantity::new(size, 0.0, unit).unit_of(size);
    (unit, over(1.0, power))
}

/// Two numbers to compare, in the same digits and the same unit: three of the smaller, or as many as show that they differ.
#[must_use]
pub fn before_after(before: f64, after: f64, unit: Unit) -> (String, String) {
    const SHOWN: i32 = 3;
    const MOST_SHOWN: i32 = 5;
    const SAME: f64 = 5e-4;
    let large = before.abs().max(after.abs());
    let small = match before.abs().min(after.abs()) {
        0.0 => large,
        small => small,
    };
    let apart = (before - after).abs();
    let mut last = first_digit(small, SHOWN) - SHOWN + 1;
    // What is off by a few of the digits that are not shown is the same.
    if apart > SAME * large {
        last = last.min(first_digit(apart, 1) - 1);
    }
    last = last.max(first_digit(large, MOST_SHOWN) - MOST_SHOWN + 1);
    let (unit, power) =
        Quantity::new(large, 0.0, unit).unit_of(over(over(large, last).round(), -last));
    let text = |value: f64| {
        let value = decimal(over(value, last).round(), last - power);
        // A degree sign stands close.
        let space = if unit.is_empty() || unit == "°" {
            ""
        } else {
            " "
        };
        format!("{value}{space}{unit}")
    };
    (text(before), text(after))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn table(value: f64, error: f64, unit: Unit) -> String {
        let (text, unit) = Quantity::new(value, error, unit).apart();
        format!("{text} {unit}")
    }

    fn brief(value: f64, error: f64, unit: Unit) -> String {
        Quantity::new(value, error, unit).brief()
    }

    const S: Unit = Unit::Small("s");
    const HZ: Unit = Unit::Prefixed("Hz");

    #[test]
    fn a_table_has_two_digits_of_the_error() {
        assert_eq!(table(254.837_12, 0.012_3, HZ), "254.837 ± 0.012 Hz");
        assert_eq!(table(-4.012e-7, 3.1e-9, S), "-401.2 ± 3.1 ns");
        assert_eq!(table(1.0e-9, 3.1e-7, S), "0 ± 310 ns");
        assert_eq!(table(0.999_96, 0.001, Unit::Percent), "100.00 ± 0.10 %");
        assert_eq!(table(999.96, 1.0, HZ), "1.0000 ± 0.0010 kHz");
        assert_eq!(table(4321.0, 120.0, S), "4320 ± 120 s");
        assert_eq!(table(3.0, 0.0, Unit::Plain("")), "3 ");
        assert_eq!(table(20_000.0, 0.0, HZ), "20 kHz");
        assert_eq!(table(0.25, f64::INFINITY, S), "250.0 ms");
        assert_eq!(table(-1e-12, 0.5, Unit::Plain("rad")), "0.00 ± 0.50 rad");
    }

    #[test]
    fn a_sentence_has_the_digits_that_are_sure() {
        assert_eq!(brief(1.314e-6, 1.2e-8, S), "1.31 µs");
        assert_eq!(brief(572.38, 0.07, HZ), "572.4 Hz");
        assert_eq!(brief(2.157, 0.0021, Unit::Plain("rad")), "2.157 rad");
        assert_eq!(brief(0.004_213, 3e-5, Unit::Percent), "0.421 %");
        assert_eq!(brief(0.004_2, 0.01, Unit::Percent), "0 %");
        assert_eq!(brief(-4e-7, 2.2e-5, Unit::Percent), "0.000 %");
        assert_eq!(brief(999.96, 1e-9, HZ), "1.000 kHz");
        assert_eq!(brief(0.0, 0.0, HZ), "0 Hz");
        assert_eq!(brief(8.0, 0.0, Unit::Plain("")), "8");
    }

    #[test]
    fn two_numbers_have_the_same_digits() {
        let of = |a: f64, b: f64, unit: Unit| {
            let (a, b) = before_after(a, b, unit);
            format!("{a} → {b}")
        };
        assert_eq!(
            of(0.234_51, 0.086_64, Unit::Plain("°")),
            "0.2345° → 0.0866°"
        );
        assert_eq!(of(0.010_064, 0.009_636, Unit::Percent), "1.006 % → 0.964 %");
        assert_eq!(of(0.001_398, 0.001_398, Unit::Percent), "0.140 % → 0.140 %");
        assert_eq!(
            of(0.086_57, 0.086_568, Unit::Plain("°")),
            "0.0866° → 0.0866°"
        );
        assert_eq!(of(0.0, 0.0, Unit::Percent), "0 % → 0 %");
    }

    fn read_back(text: &str, unit: &str, plain: &str) -> [f64; 2] {
        let prefix = unit.strip_suffix(plain).expect("the unit");
        let power = match prefix {
            "" => 0,
            p => {
                3 * ("fpnµm kMGT"
                    .chars()
                    .position(|c| p.starts_with(c))
                    .expect(p) as i32
                    - 5)
            }
        };
        let (value, error) = text.split_once(" ± ").expect("an error");
        [value, error].map(|v| v.parse::<f64>().expect("a number") * 10f64.powi(power))
    }

    proptest! {
        #[test]
        fn value_and_error_are_read_back(
            mantissa in -9.999..9.999f64, power in -12..9i32,
            of_error in 1.0..9.99f64, below in -2..6i32,
        ) {
            let value = mantissa * 10f64.powi(power);
            let error = of_error * 10f64.powi(power - below);
            let (text, unit) = Quantity::new(value, error, HZ).apart();
            let [value_read, error_read] = read_back(&text, &unit, "Hz");
            // Half of the error's second digit.
            prop_assert!((value_read - value).abs() < 0.051 * error, "{text} {unit}");
            prop_assert!((error_read - error).abs() < 0.051 * error, "{text} {unit}");
        }

        #[test]
        fn a_short_value_is_read_back_within_its_error(
            mantissa in 1.0..9.999f64, power in -12..9i32, below in 0..6i32,
        ) {
            let value = mantissa * 10f64.powi(power);
            let error = 3.0 * 10f64.powi(power - below);
            let (text, unit) = Quantity::new(value, error, HZ).short();
            let [read, _] = read_back(&format!("{text} ± 0"), &unit, "Hz");
            let digits = 5e-4 * value;
            prop_assert!((read - value).abs() < error.max(digits), "{text} {unit}");
            prop_assert!(text.chars().filter(char::is_ascii_digit).count() <= 6, "{text}");
        }
    }
}
