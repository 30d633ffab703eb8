//! The paper in plain `f64`: the independent check of the chip's equations.
//!
//! Written from S. Balemi, *Automatic calibration of sinusoidal encoder signals* (IFAC 2005), in the paper's own form:
//! radians, seconds, the coefficients a, b, c, d of equation (2). It shares no code with the kernels of the chip, so
//! an error in one is not an error in the other; `model/tests/chip_against_reference.rs` compares the two.
//!
//! | paper | here |
//! |---|---|
//! | (1), (4), θ ↔ a, b, β | [`sensor`] |
//! | M of (6), (7) and §5.4 | [`correction`] |
//! | section 2, the baselines | [`arctangent`], [`extremes`], [`baseline`] |
//! | section 4, poles and Methods 1, 2, 3 | [`poles`], [`loops`] |
//! | (5) | [`heydemann`] |
//! | 5.2 and 5.3, sum of squares | [`sum_of_squares`] |
//! | 5.5, (8) to (11) and the final form | [`gradient`] |
//! | what the paper lacks: the direction that no radius shows | [`completed`] |
//! | a start within two periods: sample by sample, period by period | [`recursive`], [`solved`] |
//! | harmonics of the scale period | [`harmonics`] |
//! | the sine sampled later than the cosine | [`skew`] |
//! | when to calibrate, how to start | [`gate`], [`catch_up`], [`hold`], [`start`] |
//! | all of it together | [`interpolator`] |
//!
//! Only [`from_spec`] knows of the chip's `design.toml`, and of it no more than the physical numbers.

pub mod arctangent;
pub mod baseline;
pub mod catch_up;
pub mod completed;
pub mod config;
pub mod correction;
pub mod estimate;
pub mod extremes;
pub mod from_spec;
pub mod gate;
pub mod gradient;
pub mod harmonics;
pub mod heydemann;
pub mod hold;
pub mod interpolator;
pub mod loops;
pub mod poles;
pub mod recursive;
mod searching;
pub mod sensor;
pub mod skew;
pub mod solved;
pub mod sparse;
pub mod start;
pub mod sum_of_squares;

pub use catch_up::CatchUp;
pub use correction::{Jacobian, Parameters, Theta};
pub use interpolator::{Config, Estimate, Reference, Steps};
pub use sensor::Sensor;
pub use sparse::Sparse;

use thiserror::Error;

/// What the paper says is impossible, or what cannot be computed from the data given.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReferenceError {
    /// A quantity is outside what the method allows.
    #[error("{what} = {value}: {reason}")]
    Value {
        /// The quantity, in the paper's words.
        what: &'static str,
        /// What it is.
        value: f64,
        /// Why that is impossible.
        reason: &'static str,
    },
    /// The combination asked for does not exist.
    #[error("{0}")]
    Impossible(&'static str),
    /// The data do not determine the result.
    #[error("{0}")]
    Data(&'static str),
}

pub(crate) fn require(
    holds: bool,
    what: &'static str,
    value: f64,
    reason: &'static str,
) -> Result<(), ReferenceError> {
    if holds {
        return Ok(());
    }
    Err(ReferenceError::Value {
        what,
        value,
        reason,
    })
}
