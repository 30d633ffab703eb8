//! Blind tests of the diagnosis.
//!
//! A [`Case`] follows from its seed: an experiment (axis, sensor, converter), a cause hidden in it with a magnitude that
//! gives it the detection SNR asked for, and the recording. The truth is sealed ([`seal`]): written to a file whose hash
//! is known before the verdict. Nothing that simulates shares code or formulas with sensor model, calibration or
//! diagnosis but the Fourier transform of a library (`nonius-fourier` hands it on); the diagnosis is called in one place,
//! `verdict`, and sees nothing but the file.

mod baseline;
mod case;
mod effect;
mod effects;
mod magnitude;
mod many;
mod motion;
mod rows;
mod score;
mod sealed;
mod simulate;
mod spectrum;
mod strange_circuits;
mod strangers;
mod summary;
mod table;
mod table_of_many;
mod truth;
mod twin;
mod verdict;
mod vibration;
mod visible;
mod world;

pub use case::{Case, Unreachable};
pub use motion::{Drive, Motion};
pub use rows::Rows;
pub use score::{Outcome, ParameterScore, Score};
pub use sealed::{SealError, Sealed, seal};
pub use summary::{Share, Summary};
pub use table::page;
pub use table_of_many::page_of_many;
pub use truth::{HiddenCause, Kind, TrueParameter, Truth, Twin};
pub use verdict::{Named, Verdict, verdict};
pub use vibration::Vibration;
pub use world::World;

/// Every name of the catalogue that can be hidden.
pub fn names() -> impl Iterator<Item = &'static str> {
    effects::CATALOGUE.iter().map(|e| e.name)
}

/// Names of the causes that the catalogue does not hold.
pub fn stranger_names() -> impl Iterator<Item = &'static str> {
    strangers::STRANGERS.iter().map(|s| s.0)
}
