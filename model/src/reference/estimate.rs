//! What the reference says of a sample.

use std::f64::consts::TAU;

use super::Theta;

/// What is known at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// α̂_k, unwrapped, radians.
    pub alpha_hat: f64,
    /// The same in whole turns, and the phase −π … π that remains: full resolution after any distance.
    pub turns: i64,
    /// See [`turns`](Self::turns).
    pub phase: f64,
    /// Speed, radians per second.
    pub speed: f64,
    /// Θ_k, with which this sample was corrected.
    pub theta: Theta,
    /// Phase error, radians.
    pub e: f64,
    /// Radial residual.
    pub rho: f64,
    /// The loop follows.
    pub locked: bool,
    /// This sample was allowed to move Θ.
    pub updated: bool,
}

impl Estimate {
    /// Position in scale periods.
    #[must_use]
    pub fn periods(&self) -> f64 {
        self.turns as f64 + self.phase / TAU
    }
}
