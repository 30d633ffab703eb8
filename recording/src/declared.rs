//! What a recording says about itself: `# key: value` lines and the command line.

use serde::Serialize;

use crate::adc::AdcPair;
use crate::columns::nearest;
use crate::error::{Error, ErrorKind, Place, shorten};
use crate::table::LARGEST;

/// Keys that have a meaning.
const KEYS: [&str; 7] = [
    "sample_rate_hz",
    "adc_bits",
    "full_scale",
    "adc_min",
    "adc_max",
    "scale_period_m",
    "periods_per_revolution",
];
/// Number of bits an ADC may have.
pub(crate) const BITS: std::ops::RangeInclusive<u32> = 2..=32;

/// What the command line says about a recording. It wins over the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overrides {
    /// `--sample-rate`, in hertz, above 0. `time_s` wins over it.
    pub sample_rate_hz: Option<f64>,
    /// `--adc-bits`, 2 to 32.
    pub adc_bits: Option<u32>,
    /// `--full-scale`, in the unit of the columns, above 0: the ADC spans −full_scale … +full_scale.
    pub full_scale: Option<f64>,
    /// `--periods-per-revolution`, 1 or more.
    pub periods_per_revolution: Option<u32>,
    /// `--cos`: name of the column in place of `cos`.
    pub cos_column: Option<String>,
    /// `--sin`: name of the column in place of `sin`.
    pub sin_column: Option<String>,
    /// `--time`: name of the column in place of `time_s`; its unit is that of its name, as in `Time (ms)`, or of a row of
    /// units below the header, else seconds.
    pub time_column: Option<String>,
}

/// What is known about a recording as a whole.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Metadata {
    /// Samples per second, from `time_s` where that column is there.
    pub sample_rate_hz: f64,
    /// The converters of the two channels.
    pub adc: AdcPair,
    /// Length of one scale period in metres.
    pub scale_period_m: Option<f64>,
    /// Scale periods in one revolution.
    pub periods_per_revolution: Option<u32>,
    /// Other `# key: value` lines, as they stand.
    pub other: Vec<(String, String)>,
}

/// The range of an ADC, in the unit of the columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) min: f64,
    pub(crate) max: f64,
}

/// What was declared, checked.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Declared {
    pub(crate) sample_rate_hz: Option<f64>,
    pub(crate) adc_bits: Option<u32>,
    pub(crate) span: Option<Span>,
    pub(crate) scale_period_m: Option<f64>,
    pub(crate) periods_per_revolution: Option<u32>,
    pub(crate) other: Vec<(String, String)>,
    pub(crate) notes: Vec<String>,
}

/// The `# key: value` lines, as they stand.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    known: Vec<(&'static str, String, Place)>,
    declared: Declared,
}

impl Lines {
    /// Takes the text behind `#`. Text without a colon is a comment.
    pub(crate) fn take(&mut self, text: &str, place: Place) -> Result<(), Error> {
        let Some((key, value)) = text.split_once(':') else {
            return Ok(());
        };
        // Spreadsheets pad every line with separators and may quote it.
        let value = value.trim_matches(|c: char| c.is_whitespace() || ",;\"".contains(c));
        let key = key.trim();
        let Some(known) = KEYS.into_iter().find(|k| k.eq_ignore_ascii_case(key)) else {
            if let Some(meant) = nearest(key, KEYS.into_iter()) {
                let line = place.line.unwrap_or_default();
                self.declared.notes.push(format!(
                    "'{key}' in line {line} is not a known key and was ignored; was {meant} meant?"
                ));
            }
            self.declared.other.push((key.to_owned(), value.to_owned()));
            return Ok(());
        };
        if let Some((key, first, _)) = self.known.iter().find(|(k, ..)| *k == known) {
            let (first, second) = (first.clone(), value.to_owned());
            let kind = ErrorKind::MetadataTwice { key, first, second };
            return Err(Error::new(place, kind));
        }
        self.known.push((known, value.to_owned(), place));
        Ok(())
    }

    /// The values, checked, with those of the command line in place of the file's.
    pub(crate) fn finish(self, comma: bool, overrides: &Overrides) -> Result<Declared, Error> {
        let from = |key| Value::new(self.known.iter().find(|(k, ..)| *k == key), comma);
        let given = |key, value| Value {
            key,
            value,
            place: Place::command_line(),
            text: None,
        };
        let rate = from("sample_rate_hz")?.positive(RATE)?;
        let file_bits = from("adc_bits")?.whole(&BITS, BITS_EXPECTED)?;
        let bits = given("--adc-bits", overrides.adc_bits.map(f64::from));
        let file_ppr = from("periods_per_revolution")?.whole(&PERIODS, PERIODS_EXPECTED)?;
        let ppr = overrides.periods_per_revolution.map(f64::from);
        let ppr = given("--periods-per-revolution", ppr).whole(&PERIODS, PERIODS_EXPECTED)?;
        let full_scale = from("full_scale")?.positive(FULL_SCALE)?;
        let (min, max) = (from("adc_min")?, from("adc_max")?);
        let file_span = span(full_scale, &min, &max)?;
        let full_scale = given("--full-scale", overrides.full_scale).positive(FULL_SCALE)?;
        let option = given("--sample-rate", overrides.sample_rate_hz);
        let period = from("scale_period_m")?.positive("a length in metres above 0, up to 1e30")?;
        Ok(Declared {
            sample_rate_hz: option.positive(RATE)?.or(rate),
            adc_bits: bits.whole(&BITS, BITS_EXPECTED)?.or(file_bits),
            span: full_scale.map(|f| Span { min: -f, max: f }).or(file_span),
            scale_period_m: period,
            periods_per_revolution: ppr.or(file_ppr),
            ..self.declared
        })
    }
}

const BITS_EXPECTED: &str = "a whole number from 2 to 32";
const RATE: &str = "a rate in hertz above 0, up to 1e30";
const FULL_SCALE: &str = "a number above 0, up to 1e30, in the unit of the columns";
const PERIODS: std::ops::RangeInclusive<u32> = 1..=u32::MAX;
const PERIODS_EXPECTED: &str = "a whole number from 1 to 4294967295";

/// A number with what is needed to complain about it.
struct Value {
    key: &'static str,
    value: Option<f64>,
    place: Place,
    text: Option<String>,
}

impl Value {
    fn new(line: Option<&(&'static str, String, Place)>, comma: bool) -> Result<Self, Error> {
        let Some((key, text, place)) = line else {
            let (value, place, text) = (None, Place::default(), None);
            return Ok(Self {
                key: "",
                value,
                place,
                text,
            });
        };
        let value = crate::cells::number(text, comma).unwrap_or(f64::NAN);
        let (place, text) = (place.clone(), Some(text.clone()));
        let this = Self {
            key,
            value: Some(value),
            place,
            text,
        };
        if value.is_nan() {
            Err(this.error("a number"))
        } else if value.abs() > LARGEST {
            Err(this.error("a number from -1e30 to 1e30"))
        } else {
            Ok(this)
        }
    }

    fn positive(&self, expected: &'static str) -> Result<Option<f64>, Error> {
        match self.value {
            Some(v) if !(1e-30..=LARGEST).contains(&v) => Err(self.error(expected)),
            v => Ok(v),
        }
    }

    fn whole(
        &self,
        range: &std::ops::RangeInclusive<u32>,
        expected: &'static str,
    ) -> Result<Option<u32>, Error> {
        let inside = |v: f64| v.fract() == 0.0 && range.contains(&(v as u32)) && v >= 0.0;
        match self.value {
            Some(v) if !inside(v) || v > f64::from(u32::MAX) => Err(self.error(expected)),
            v => Ok(v.map(|v| v as u32)),
        }
    }

    fn error(&self, expected: &'static str) -> Error {
        let number = || self.value.map_or_else(String::new, |v| v.to_string());
        let value = self.text.as_deref().map_or_else(number, shorten);
        let kind = ErrorKind::Metadata {
            key: self.key,
            value,
            expected,
        };
        Error::new(self.place.clone(), kind)
    }
}

fn span(full_scale: Option<f64>, min: &Value, max: &Value) -> Result<Option<Span>, Error> {
    let place = if max.value.is_some() {
        &max.place
    } else {
        &min.place
    };
    let refuse = |what| Err(Error::new(place.clone(), ErrorKind::AdcRange { what }));
    match (full_scale, min.value, max.value) {
        (None, None, None) => Ok(None),
        (Some(f), None, None) => Ok(Some(Span { min: -f, max: f })),
        (Some(_), _, _) => refuse("there are full_scale and adc_min or adc_max"),
        (None, Some(_), None) => refuse("adc_max is missing"),
        (None, None, Some(_)) => refuse("adc_min is missing"),
        (None, Some(min), Some(max)) if max - min > 1e-30 => Ok(Some(Span { min, max })),
        (None, Some(_), Some(_)) => refuse("adc_max is not above adc_min"),
    }
}
