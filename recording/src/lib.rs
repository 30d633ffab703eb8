//! Measured samples: the CSV reader and what a recording says about itself.
//!
//! [`Recording::read`] turns a CSV file into columns, a sample rate and a description of the ADC, or
//! into an [`Error`] that says what is wrong, where, and what to do. [`Survey::of`] looks at a
//! recording the way a designer would: size and offset of the signals, noise, speed.
//!
//! Nothing here prints. What a reader of the output must know is in the `notes` of each result.

mod adc;
mod cells;
mod checks;
mod columns;
mod conic;
mod declared;
mod ellipse;
mod error;
mod estimate;
mod grid;
mod lines;
mod motion;
mod reader;
mod recording;
mod reference;
mod standstill;
mod step;
mod survey;
mod table;
mod time;
mod units;

pub use adc::{Adc, AdcPair, AdcSource};
pub use declared::{Metadata, Overrides};
pub use ellipse::{Ellipse, EllipseFit, FitMethod};
pub use error::{Error, ErrorKind, Place};
pub use grid::code_step;
pub use motion::Motion;
pub use recording::{OtherColumn, Recording};
pub use standstill::at_rest;
pub use survey::Survey;

/// Fewest samples a recording may have.
pub const MIN_SAMPLES: usize = 16;
