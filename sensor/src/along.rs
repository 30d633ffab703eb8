//! A motion that is given: `motion.csv` as it is read, and the angle between its rows.

use std::f64::consts::TAU;

use csv::{ReaderBuilder, StringRecord, Trim};
use nonius_quantity::counted;
use thiserror::Error;

use crate::motion::Motion;
use crate::sensor::Sensor;

/// Columns, in their order.
const COLUMNS: [&str; 3] = ["time_s", "position_periods", "speed_periods_per_s"];
/// No number is larger: of a larger position, `f64` has hardly a fraction of a period left.
const LARGEST: f64 = 1e12;
/// Samples that a motion has at most: a simulation has some hundred bytes of each.
const MOST: f64 = 10_000_000.0;

/// What is wrong with a `motion.csv`.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MotionError {
    /// Another header.
    #[error("{file}:1: the header is `{found}`; expected `{expected}`", expected = COLUMNS.join(","))]
    Header {
        /// Name of the file.
        file: String,
        /// What stands there.
        found: String,
    },
    /// A row that is none.
    #[error("{file}:{line}: {message}; expected three numbers in every row")]
    Row {
        /// Name of the file.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// What it has instead.
        message: String,
    },
    /// A cell that is no number, not finite, or too large.
    #[error(
        "{file}:{line}: '{cell}' in the column '{column}'; expected a finite number, at most 1e12"
    )]
    Number {
        /// Name of the file.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// What stands there.
        cell: String,
    },
    /// A time that is not later than the one before.
    #[error(
        "{file}:{line}: time_s goes from {previous} to {time}; expected a later time: sort the rows, and give each time once"
    )]
    Time {
        /// Name of the file.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// Time of the row before, seconds.
        previous: f64,
        /// Time of the row, seconds.
        time: f64,
    },
    /// No motion.
    #[error("{file}: {} below the header; expected at least two, the start and the end of the motion", counted(*.rows, "row"))]
    Short {
        /// Name of the file.
        file: String,
        /// Rows below the header.
        rows: usize,
    },
    /// More samples than memory is for.
    #[error(
        "{file}: {seconds} s at adc.sample_rate_hz = {rate} are {samples:.3e} samples; at most {MOST:.0e} are simulated: leave rows out at its start or end, or leave out motion.file in sensor.toml"
    )]
    Long {
        /// Name of the file.
        file: String,
        /// From the first row to the last.
        seconds: f64,
        /// Samples per second.
        rate: f64,
        /// How many they would be.
        samples: f64,
    },
}

/// A place on the way.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Row {
    /// Seconds.
    time: f64,
    /// Periods.
    position: f64,
    /// Periods per second.
    speed: f64,
}

/// Between two rows: the cubic that has their positions and speeds, periods; `after` seconds after the first.
fn between(from: Row, to: Row, after: f64) -> f64 {
    let whole = to.time - from.time;
    // Where the sample rate is no whole part of the time, the last sample rests at the end.
    let x = (after / whole).clamp(0.0, 1.0);
    let y = 1.0 - x;
    let places = from.position + (to.position - from.position) * x * x * (3.0 - 2.0 * x);
    places + whole * x * y * (from.speed * y - to.speed * x)
}

impl Motion {
    /// Along the text of a `motion.csv`, of the name `file` for messages, sampled by the sensor's ADC from its first time to its
    /// last. Between rows the angle is the cubic that has their positions and speeds: rows at the knots of a cubic spline are
    /// that spline.
    ///
    /// # Errors
    /// [`MotionError`] names file, place and what was expected.
    pub fn along(sensor: &Sensor, text: &str, file: &str) -> Result<Self, MotionError> {
        let rows = rows(text, file)?;
        let short = || MotionError::Short {
            file: file.into(),
            rows: rows.len(),
        };
        let [first, .., last] = rows[..] else {
            return Err(short());
        };
        let rate = sensor.adc.sample_rate_hz;
        let seconds = last.time - first.time;
        let samples = (seconds * rate).round() + 1.0;
        if samples > MOST {
            return Err(MotionError::Long {
                file: file.into(),
                seconds,
                rate,
                samples,
            });
        }
        let (mut time_s, mut alpha) = (vec![], vec![]);
        let mut pairs = rows.windows(2).peekable();
        for k in 0..samples as usize {
            let since = k as f64 / rate;
            while pairs.len() > 1 && pairs.next_if(|p| p[1].time - first.time <= since).is_some() {}
            let Some([from, to]) = pairs.peek() else {
                break;
            };
            let position = between(*from, *to, since - (from.time - first.time));
            time_s.push(first.time + since);
            alpha.push(TAU * position);
        }
        Ok(Self { time_s, alpha })
    }
}

/// The rows of a text, checked.
fn rows(text: &str, file: &str) -> Result<Vec<Row>, MotionError> {
    let wrong = |error: csv::Error| MotionError::Row {
        file: file.into(),
        line: error.position().map_or(0, csv::Position::line),
        message: error.to_string(),
    };
    let mut reader = ReaderBuilder::new()
        .trim(Trim::All)
        .flexible(true)
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(wrong)?;
    if header != COLUMNS.as_slice() {
        return Err(MotionError::Header {
            file: file.into(),
            found: header
                .iter()
                .collect::<Vec<_>>()
                .join(",")
                .chars()
                .take(60)
                .collect(),
        });
    }
    let mut rows: Vec<Row> = vec![];
    for record in reader.records() {
        let (row, line) = row(&record.map_err(wrong)?, file)?;
        if let Some(previous) = rows.last().map(|r| r.time).filter(|t| *t >= row.time) {
            return Err(MotionError::Time {
                file: file.into(),
                line,
                previous,
                time: row.time,
            });
        }
        rows.push(row);
    }
    Ok(rows)
}

/// A row, and the line that it stands in.
fn row(record: &StringRecord, file: &str) -> Result<(Row, u64), MotionError> {
    let line = record.position().map_or(0, csv::Position::line);
    if record.len() != COLUMNS.len() {
        return Err(MotionError::Row {
            file: file.into(),
            line,
            message: counted(record.len(), "cell"),
        });
    }
    let number = |column: usize| {
        let cell = record.get(column).unwrap_or_default();
        let value = cell.parse().ok();
        let value = value.filter(|v: &f64| v.abs() <= LARGEST);
        value.ok_or_else(|| MotionError::Number {
            file: file.into(),
            line,
            column: COLUMNS[column],
            cell: cell.into(),
        })
    };
    let row = Row {
        time: number(0)?,
        position: number(1)?,
        speed: number(2)?,
    };
    Ok((row, line))
}
