//! A start by recursive least squares: where the gradient takes a dozen periods, it takes two.
//!
//! The final form goes down along Mᵀ n ρ because ρ changes by h δΘ with h = nᵀ M. So the δΘ that makes Σ (ρ + h δΘ)² least
//! is a linear least-squares problem, and is solved sample by sample:
//!
//! K = P hᵀ / (λ + h P hᵀ),  Θ ← Θ − K ρ,  P ← (P − K h P) / λ.
//!
//! λ < 1 forgets the first samples, whose α̂ still had the miscalibration in it. Not in the paper.

use std::f64::consts::TAU;

use nalgebra::{RowSVector, SMatrix};

use super::gradient::Observation;
use super::{ReferenceError, Theta, require};

/// How the start is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StartConfig {
    /// Periods of travel; after that the gradient takes over.
    pub periods: f64,
    /// λ, above 0 and up to 1.
    pub lambda: f64,
    /// Variance that each parameter may have before the first sample: P starts as so much times the unit matrix.
    pub spread: f64,
}

/// The least squares, as far as they have come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastSquaresStart {
    config: StartConfig,
    p: SMatrix<f64, 9, 9>,
    /// α̂ of the first sample, radians.
    began: Option<f64>,
    done: bool,
}

impl LeastSquaresStart {
    /// Before the first sample.
    ///
    /// # Errors
    /// λ outside (0, 1], a spread or a way that is not positive.
    pub fn new(config: StartConfig) -> Result<Self, ReferenceError> {
        let StartConfig {
            periods,
            lambda,
            spread,
        } = config;
        let reason = "samples are forgotten at 0 < lambda <= 1";
        require(lambda > 0.0 && lambda <= 1.0, "lambda", lambda, reason)?;
        let finite = |x: f64| x > 0.0 && x.is_finite();
        require(finite(spread), "spread", spread, "a variance is positive")?;
        require(finite(periods), "periods", periods, "a way is positive")?;
        Ok(Self {
            config,
            p: SMatrix::identity() * spread,
            began: None,
            done: false,
        })
    }

    /// Takes a sample that may move Θ, and its α̂ (radians, unwrapped): the change of Θ, `None` when the start is over.
    pub fn step(&mut self, seen: &Observation, alpha_hat: f64) -> Option<Theta> {
        let began = *self.began.get_or_insert(alpha_hat);
        if self.done || (alpha_hat - began).abs() >= self.config.periods * TAU {
            self.done = true;
            return None;
        }
        let h = RowSVector::<f64, 9>::from_fn(|_, i| {
            seen.cos_hat * seen.m[(0, i)] + seen.sin_hat * seen.m[(1, i)]
        });
        let gain = self.p * h.transpose();
        let k = gain / (self.config.lambda + (h * gain).x);
        self.p = (self.p - k * (h * self.p)) / self.config.lambda;
        Some(-k * seen.rho)
    }
}
