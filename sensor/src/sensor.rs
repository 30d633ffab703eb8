//! `sensor.toml` as it is read.

use std::path::PathBuf;

use serde::Deserialize;
use thiserror::Error;

use crate::cause::Cause;
use crate::keys::with_nearest;

/// What is wrong with a `sensor.toml`.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SensorError {
    /// Not TOML, a missing or unknown key, a value of the wrong kind, a cause that cannot be simulated.
    #[error("{file}:{message}")]
    Form {
        /// Name of the file.
        file: String,
        /// Line, column and what was expected.
        message: String,
    },
    /// A number that no sensor has.
    #[error("{file}: {field} = {value}: {reason}")]
    Value {
        /// Name of the file.
        file: String,
        /// Section and key.
        field: String,
        /// What it says.
        value: f64,
        /// What it may say.
        reason: &'static str,
    },
}

/// A sensor, its ADC, and how it is moved.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sensor {
    /// Equation (4) and white noise.
    pub signals: Signals,
    /// The ADC behind it.
    pub adc: Adc,
    /// How it was moved.
    pub motion: Moved,
    /// What else stands in the signals.
    #[serde(default, rename = "cause")]
    pub causes: Vec<Cause>,
}

/// Equation (4): y_c = a_c cos α + b_c, y_s = a_s sin(α − β) + b_s.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signals {
    /// Amplitude of cos, in the unit of the ADC's range.
    pub a_c: f64,
    /// Offset of cos, likewise.
    pub b_c: f64,
    /// Amplitude of sin, likewise.
    pub a_s: f64,
    /// Offset of sin, likewise.
    pub b_s: f64,
    /// Phase error β, radians.
    pub beta: f64,
    /// White noise of each channel, rms, as a fraction of its amplitude.
    pub noise_rms: f64,
}

/// The ADC: codes are `centre + lsb · n`, n in two's complement of `bits`; those of sin are others where it has a grid of its own.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adc {
    /// Resolution.
    pub bits: u32,
    /// One code, in the unit of the signals.
    pub lsb: f64,
    /// Value of code 0.
    pub centre: f64,
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// The codes of sin, where a channel was scaled after the ADC.
    #[serde(default)]
    pub sin: Option<Grid>,
}

/// Values that codes stand for.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// One code, in the unit of the signals.
    pub lsb: f64,
    /// Value of code 0.
    pub centre: f64,
}

impl Adc {
    /// The codes of channel `which`: 0 is cos, 1 is sin.
    #[must_use]
    pub fn grid(&self, which: usize) -> Grid {
        let both = Grid {
            lsb: self.lsb,
            centre: self.centre,
        };
        self.sin.filter(|_| which == 1).unwrap_or(both)
    }
}

/// How it was moved: along a file; where none is named, to and fro, as far and as fast.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Moved {
    /// The motion, for [`crate::Motion::along`]: a path from the folder of `sensor.toml`.
    #[serde(default)]
    pub file: Option<PathBuf>,
    /// Way there and back, scale periods.
    pub periods_travelled: f64,
    /// Highest speed, scale periods per second.
    pub speed_max_periods_per_s: f64,
    /// Scale periods in one revolution.
    #[serde(default)]
    pub periods_per_revolution: Option<u32>,
}

/// Every number of a cause is one.
fn finite(text: &str, file: &str) -> Result<(), SensorError> {
    let table: toml::Table = text.parse().unwrap_or_default();
    let causes = table.get("cause").and_then(toml::Value::as_array);
    let keys = causes
        .into_iter()
        .flatten()
        .filter_map(toml::Value::as_table);
    for (key, value) in keys.flatten() {
        if let Some(value) = value.as_float().filter(|v| !v.is_finite()) {
            return Err(SensorError::Value {
                file: file.into(),
                field: format!("cause.{key}"),
                value,
                reason: "a cause is as large as a number",
            });
        }
    }
    Ok(())
}

impl Sensor {
    /// Reads the text of a `sensor.toml`; `file` is its name for error messages.
    ///
    /// # Errors
    /// [`SensorError`] names file, place and what was expected.
    pub fn from_toml(text: &str, file: &str) -> Result<Self, SensorError> {
        let sensor: Self = toml::from_str(text).map_err(|error| {
            let at = error.span().map_or_else(String::new, |span| {
                let before = text.get(..span.start).unwrap_or_default();
                let line = before.matches('\n').count() + 1;
                let column = before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1;
                format!("{line}:{column}: ")
            });
            SensorError::Form {
                file: file.into(),
                message: format!("{at}{}", with_nearest(&error)),
            }
        })?;
        sensor.check(file)?;
        finite(text, file)?;
        Ok(sensor)
    }

    fn check(&self, file: &str) -> Result<(), SensorError> {
        let (s, a, m) = (&self.signals, &self.adc, &self.motion);
        let positive = |v: f64| v.is_finite() && v > 0.0;
        let sin = a.grid(1);
        let rules: [(&str, f64, bool, &'static str); 14] = [
            (
                "signals.a_c",
                s.a_c,
                positive(s.a_c),
                "an amplitude is positive",
            ),
            (
                "signals.a_s",
                s.a_s,
                positive(s.a_s),
                "an amplitude is positive",
            ),
            (
                "signals.b_c",
                s.b_c,
                s.b_c.is_finite(),
                "an offset is a number",
            ),
            (
                "signals.b_s",
                s.b_s,
                s.b_s.is_finite(),
                "an offset is a number",
            ),
            (
                "signals.beta",
                s.beta,
                s.beta.abs() < 1.5,
                "a phase error is below a quarter turn",
            ),
            (
                "signals.noise_rms",
                s.noise_rms,
                (0.0..10.0).contains(&s.noise_rms),
                "noise is not negative",
            ),
            (
                "adc.bits",
                a.bits.into(),
                (2..=32).contains(&a.bits),
                "2 to 32 bits",
            ),
            ("adc.lsb", a.lsb, positive(a.lsb), "a code has a size"),
            (
                "adc.centre",
                a.centre,
                a.centre.is_finite(),
                "the middle is a number",
            ),
            (
                "adc.sin.lsb",
                sin.lsb,
                positive(sin.lsb),
                "a code has a size",
            ),
            (
                "adc.sin.centre",
                sin.centre,
                sin.centre.is_finite(),
                "the middle is a number",
            ),
            (
                "adc.sample_rate_hz",
                a.sample_rate_hz,
                positive(a.sample_rate_hz),
                "samples per second",
            ),
            (
                "motion.periods_travelled",
                m.periods_travelled,
                positive(m.periods_travelled) && m.periods_travelled < 1e9,
                "a way of at most 1e9 periods",
            ),
            (
                "motion.speed_max_periods_per_s",
                m.speed_max_periods_per_s,
                positive(m.speed_max_periods_per_s),
                "a speed is positive",
            ),
        ];
        for (field, value, holds, reason) in rules {
            if !holds {
                return Err(SensorError::Value {
                    file: file.into(),
                    field: field.into(),
                    value,
                    reason,
                });
            }
        }
        for cause in &self.causes {
            let (Cause::OffsetDrift(drift) | Cause::GainDrift(drift)) = cause else {
                continue;
            };
            if let Some((key, value, reason)) = drift.wrong() {
                return Err(SensorError::Value {
                    file: file.into(),
                    field: format!("cause.{key}"),
                    value,
                    reason,
                });
            }
        }
        Ok(())
    }
}
