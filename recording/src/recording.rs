//! A recording: its columns, and what is known about it.

use std::io::BufRead;
use std::path::Path;

use crate::cells::Digits;
use crate::checks::{self, Channel};
use crate::declared::{Declared, Metadata, Overrides};
use crate::error::{Error, ErrorKind, Place};
use crate::estimate::{self, Column};
use crate::{reader, reference, table, time};

/// A column that is kept by name and otherwise ignored.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherColumn {
    /// Name in the header.
    pub name: String,
    /// One value per sample; NaN where the cell is no number.
    pub values: Vec<f64>,
}

/// Measured samples of a sensor. All columns have one value per sample, and at least
/// [`crate::MIN_SAMPLES`] of them, all finite (those of `other` excepted).
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Time of each sample in seconds. It never runs back; it stands still only where a row repeats
    /// time and sample of the row before.
    pub time_s: Vec<f64>,
    /// Cosine channel, in volts or ADC counts.
    pub cos: Vec<f64>,
    /// Sine channel, in the unit of `cos`.
    pub sin: Vec<f64>,
    /// Electrical angle from a better instrument in radians, continuous; either direction.
    pub reference_rad: Option<Vec<f64>>,
    /// Temperature in degrees Celsius.
    pub temperature_c: Option<Vec<f64>>,
    /// Columns without a meaning here.
    pub other: Vec<OtherColumn>,
    /// What is known about the recording as a whole.
    pub metadata: Metadata,
    /// Sentences that every output made from this recording must carry.
    pub notes: Vec<String>,
}

/// A file to read, and its name for messages.
fn open(path: &Path) -> Result<(impl BufRead, String), Error> {
    let name = path.display().to_string();
    let file =
        std::fs::File::open(path).map_err(|e| Error::new(Place::file(&name), ErrorKind::Io(e)))?;
    Ok((std::io::BufReader::with_capacity(1 << 16, file), name))
}

/// Columns as they were read.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    pub(crate) time_s: Option<Vec<f64>>,
    pub(crate) cos: Vec<f64>,
    pub(crate) sin: Vec<f64>,
    pub(crate) reference_rad: Option<Vec<f64>>,
    pub(crate) temperature_c: Option<Vec<f64>>,
    pub(crate) other: Vec<OtherColumn>,
    pub(crate) cos_digits: Digits,
    pub(crate) sin_digits: Digits,
    pub(crate) cos_name: String,
    pub(crate) sin_name: String,
}

impl Recording {
    /// Reads a CSV file.
    ///
    /// # Errors
    /// Where the file cannot be read or is not a usable recording, with the place in the file.
    pub fn read(path: &Path, overrides: &Overrides) -> Result<Self, Error> {
        let (source, name) = open(path)?;
        Self::read_from(source, &name, overrides)
    }

    /// As [`Recording::read`], and constant channels of a scale that stands still are a recording, too.
    ///
    /// # Errors
    /// As for [`Recording::read`], less [`ErrorKind::Standstill`].
    pub fn read_even_at_rest(path: &Path, overrides: &Overrides) -> Result<Self, Error> {
        let (source, name) = open(path)?;
        let (columns, declared) = reader::read(source, &name, overrides)?;
        Self::assemble(columns, declared, &Place::file(&name), true)
    }

    /// Reads CSV text; `name` stands in messages in place of a file name.
    ///
    /// # Errors
    /// As for [`Recording::read`].
    pub fn read_from(
        source: impl BufRead,
        name: &str,
        overrides: &Overrides,
    ) -> Result<Self, Error> {
        let (columns, declared) = reader::read(source, name, overrides)?;
        Self::assemble(columns, declared, &Place::file(name), false)
    }

    /// A recording from samples in memory, for example of a simulated sensor: times in seconds, and
    /// both channels in one unit.
    ///
    /// # Errors
    /// Where the columns differ in length, hold a value that is not finite, or are not a usable
    /// recording. The line in the place is the sample, counted from 1.
    pub fn from_samples(
        time_s: Vec<f64>,
        cos: Vec<f64>,
        sin: Vec<f64>,
        overrides: &Overrides,
    ) -> Result<Self, Error> {
        let place = |k: usize| Place::line("samples", k as u64 + 1);
        let lengths = vec![time_s.len(), cos.len(), sin.len()];
        if lengths.iter().any(|l| *l != cos.len()) {
            return Err(Error::new(
                Place::file("samples"),
                ErrorKind::Lengths { lengths },
            ));
        }
        let mut clock = time::Clock::default();
        for k in 0..cos.len() {
            for (column, value) in [("time_s", time_s[k]), ("cos", cos[k]), ("sin", sin[k])] {
                let cell = || (column.to_owned(), value.to_string());
                table::in_range(value, cell).map_err(|kind| Error::new(place(k), kind))?;
            }
            clock
                .check(time_s[k], cos[k], sin[k])
                .map_err(|kind| Error::new(place(k), kind))?;
        }
        let columns = Columns {
            time_s: Some(time_s),
            cos,
            sin,
            cos_name: "cos".to_owned(),
            sin_name: "sin".to_owned(),
            ..Columns::default()
        };
        let declared = crate::declared::Lines::default().finish(false, overrides)?;
        Self::assemble(columns, declared, &Place::file("samples"), false)
    }

    fn assemble(
        mut columns: Columns,
        mut declared: Declared,
        place: &Place,
        even_at_rest: bool,
    ) -> Result<Self, Error> {
        let refuse = |kind| Error::new(place.clone(), kind);
        let channel = |values, column, option| Channel {
            values,
            column,
            option,
        };
        match checks::usable(
            &channel(&columns.cos, &columns.cos_name, "--cos"),
            &channel(&columns.sin, &columns.sin_name, "--sin"),
        ) {
            Err(ErrorKind::Standstill { .. }) if even_at_rest => {}
            checked => checked.map_err(refuse)?,
        }
        let mut notes = std::mem::take(&mut declared.notes);
        let (time_s, sample_rate_hz) = match (columns.time_s, declared.sample_rate_hz) {
            (Some(time), given) => {
                let rate = time::rate(&time).map_err(refuse)?;
                notes.extend(given.and_then(|given| time::disagreement(given, rate)));
                notes.extend(time::uneven(&time, 1.0 / rate));
                (time, rate)
            }
            (None, Some(rate)) => (
                (0..columns.cos.len()).map(|k| k as f64 / rate).collect(),
                rate,
            ),
            (None, None) => return Err(refuse(ErrorKind::NoRate)),
        };
        let cos = Column {
            values: &columns.cos,
            digits: columns.cos_digits,
        };
        let sin = Column {
            values: &columns.sin,
            digits: columns.sin_digits,
        };
        let adc = estimate::describe(&cos, &sin, &declared, &mut notes);
        if let Some(angle) = &mut columns.reference_rad {
            reference::unwrap(angle, declared.periods_per_revolution);
        }
        Ok(Self {
            time_s,
            cos: columns.cos,
            sin: columns.sin,
            reference_rad: columns.reference_rad,
            temperature_c: columns.temperature_c,
            other: columns.other,
            metadata: Metadata {
                sample_rate_hz,
                adc,
                scale_period_m: declared.scale_period_m,
                periods_per_revolution: declared.periods_per_revolution,
                other: declared.other,
            },
            notes,
        })
    }

    /// Number of samples, [`crate::MIN_SAMPLES`] or more.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.cos.len()
    }

    /// The ADC's signed codes of each sample, cos and sin.
    pub fn codes(&self) -> impl ExactSizeIterator<Item = (i64, i64)> + '_ {
        let adc = self.metadata.adc;
        let code = move |(c, s): (&f64, &f64)| (adc.cos.code(*c), adc.sin.code(*s));
        self.cos.iter().zip(&self.sin).map(code)
    }

    /// The column of that name among the ignored ones.
    #[must_use]
    pub fn other(&self, name: &str) -> Option<&[f64]> {
        let named = self.other.iter().find(|column| column.name == name);
        named.map(|column| column.values.as_slice())
    }
}
