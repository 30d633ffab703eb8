//! What can be wrong with a recording: what, where, what was expected, what to do.

use std::fmt;

use crate::MIN_SAMPLES;

/// Where in the input something is wrong.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Place {
    /// File name as given by the caller, or `command line`.
    pub file: String,
    /// Line, counted from 1.
    pub line: Option<u64>,
    /// Character in the line, counted from 1.
    pub column: Option<u64>,
}

impl Place {
    pub(crate) fn file(file: &str) -> Self {
        Self {
            file: file.to_owned(),
            ..Self::default()
        }
    }

    pub(crate) fn line(file: &str, line: u64) -> Self {
        Self {
            line: Some(line),
            ..Self::file(file)
        }
    }

    pub(crate) fn at(file: &str, line: u64, column: u64) -> Self {
        Self {
            column: Some(column),
            ..Self::line(file, line)
        }
    }

    pub(crate) fn command_line() -> Self {
        Self::file("command line")
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        for number in [self.line, self.column].into_iter().flatten() {
            write!(f, ":{number}")?;
        }
        Ok(())
    }
}

/// A recording that cannot be used. Its message is `file:line:column: what; what to do`.
#[derive(Debug, thiserror::Error)]
#[error("{place}: {kind}")]
pub struct Error {
    /// Where.
    pub place: Place,
    /// What, what was expected, and what to do.
    pub kind: Box<ErrorKind>,
}

impl Error {
    pub(crate) fn new(place: Place, kind: ErrorKind) -> Self {
        let kind = Box::new(kind);
        Self { place, kind }
    }
}

/// The reasons for which a recording is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(missing_docs, reason = "each message says what its fields mean")]
pub enum ErrorKind {
    #[error("cannot be read: {0}; check the path and its permissions")]
    Io(#[from] std::io::Error),
    #[error(
        "the file is empty; expected a header line with the columns cos and sin, then one line per sample"
    )]
    Empty,
    #[error("the text is not UTF-8; save the file as UTF-8")]
    NotUtf8,
    #[error("the text is UTF-16; save the file as UTF-8")]
    Utf16,
    #[error(
        "a carriage return inside a line; expected lines that end with LF or CRLF: convert the line ends"
    )]
    BareCarriageReturn,
    #[error("the line is longer than {limit} bytes; expected a CSV table with one sample per line")]
    LineTooLong { limit: usize },
    #[error("the quote that opens here is not closed on this line; close or remove it")]
    UnclosedQuote,
    #[error(
        "the columns seem to be separated by {found}; expected `,`, `;` or tabs: convert the separators"
    )]
    UnknownSeparator { found: &'static str },
    #[error(
        "numbers where the header is expected; put a line with the column names first, for example time_s,cos,sin"
    )]
    NoHeader,
    #[error("there is no column '{wanted}'{}; the columns are {}; name the right one with {option} COLUMN", if_near(.nearest), list(.present))]
    MissingColumn {
        wanted: String,
        option: &'static str,
        present: Vec<String>,
        nearest: Option<String>,
    },
    #[error("the column '{name}' is there twice; rename or remove one of the two")]
    DuplicateColumn { name: String },
    #[error("--cos and --sin both name the column '{name}'; give two different columns")]
    SameColumn { name: String },
    #[error("the column '{name}' has a fixed meaning; give another column with {option}")]
    ReservedColumn { name: String, option: &'static str },
    #[error("{found} cells where the header has {expected}; {hint}")]
    RaggedRow {
        expected: usize,
        found: usize,
        hint: &'static str,
    },
    #[error("'{cell}' in the column '{column}' is not a number; {hint}")]
    NotANumber {
        column: String,
        cell: String,
        hint: &'static str,
    },
    #[error(
        "'{cell}' in the column '{column}'; expected a finite number: repair or remove the sample"
    )]
    NotFinite { column: String, cell: String },
    #[error(
        "'{cell}' in the column '{column}' is beyond 1e30; expected volts, ADC counts, seconds or radians: check the column and its unit"
    )]
    TooLarge { column: String, cell: String },
    #[error(
        "the signals have the units '{first}' and '{second}'; expected one: record or write both in the same"
    )]
    TwoUnits { first: String, second: String },
    #[error("a line with `#` after the header; such lines may only come first: move or remove it")]
    CommentInData,
    #[error(
        "neither a column time_s nor a sample rate; name the column of times with --time COLUMN, or give --sample-rate RATE or the line `# sample_rate_hz: RATE`"
    )]
    NoRate,
    #[error("the time runs back from {previous} to {time} s; {hint}")]
    TimeBack {
        previous: f64,
        time: f64,
        hint: String,
    },
    #[error(
        "the time stands still at {time} s while the sample changes; expected a later one: write times with more digits, or leave them out and give --sample-rate"
    )]
    TimeStill { time: f64 },
    #[error(
        "the times give no usable sample rate (the time from sample to sample is {interval} s); check its unit"
    )]
    NoInterval { interval: f64 },
    #[error(
        "the scale stands still, or nothing is connected: {why}; move the scale by at least a whole period while \
         recording, and check the wiring if this stays"
    )]
    Standstill { why: String },
    #[error(
        "the column '{column}' is dead: {why}; check the wiring, or name another column with {option} COLUMN"
    )]
    DeadChannel {
        column: String,
        why: String,
        option: &'static str,
    },
    #[error(
        "{found} samples are too few; at least {MIN_SAMPLES} are needed, over one scale period or more"
    )]
    TooFew { found: usize },
    #[error("the columns differ in length ({lengths:?}); expected one value per sample in each")]
    Lengths { lengths: Vec<usize> },
    #[error("{key} is '{value}'; expected {expected}")]
    Metadata {
        key: &'static str,
        value: String,
        expected: &'static str,
    },
    #[error("{key} is given twice, as '{first}' and as '{second}'; keep one")]
    MetadataTwice {
        key: &'static str,
        first: String,
        second: String,
    },
    #[error(
        "the range of the ADC is not clear: {what}; give either full_scale, or adc_min and adc_max with adc_min < adc_max"
    )]
    AdcRange { what: &'static str },
}

fn if_near(name: &Option<String>) -> String {
    name.as_ref()
        .map_or_else(String::new, |n| format!(" (nearest: '{n}')"))
}

fn list(names: &[String]) -> String {
    const SHOWN: usize = 12;
    let mut text = names
        .iter()
        .take(SHOWN)
        .map(|n| format!("'{}'", shorten(n)))
        .collect::<Vec<_>>()
        .join(", ");
    if names.len() > SHOWN {
        text += &format!(" and {} more", names.len() - SHOWN);
    }
    text
}

/// The text, cut where it would fill the screen.
pub(crate) fn shorten(text: &str) -> String {
    const LONGEST: usize = 40;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    text.chars().take(LONGEST).chain(['…']).collect()
}
