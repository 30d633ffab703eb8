//! Off-line calibration: from two columns of samples to the parameters of equation (4), with standard errors.
//!
//! [`calibrate`] runs one [`Method`]; [`unbiased`] is the default. Signals are in any unit, both in the same one.

#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod bound;
pub mod conic;
pub mod ellipse;
pub mod extremes;
pub mod gradient;
mod jackknife;
mod method;
pub mod unbiased;
mod words;

pub use ellipse::Ellipse;
pub use method::{Calibration, Error, Method, Options, Parameter, calibrate};
