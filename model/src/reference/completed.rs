//! The completed gradient: the radial update for everything, and one scalar sensitivity for the direction v that no
//! radius shows (section 5.4 is singular along it, see [`Parameters::null_direction`]).
//!
//! w_v = n⊥ᵀ M v;  ∇_v α̂ by recursion (11), one scalar;  μ ← μ − γ_v (w_v − ∇_v α̂) e;  Θ moves along v with μ.
//!
//! It learns at γ_v |S(2f)|²/8 per sample, S the loop's sensitivity at twice the signal frequency f: what a wide loop
//! follows, it cannot tell from motion. Hence the gate: slower than `slowest`, it rests. It cannot tell motion at two
//! cycles per scale period from sensor error either; where a scale period is a revolution, do not use it.

use nalgebra::RowSVector;

use super::gradient::{Observation, Recursion};
use super::loops::Filter;
use super::{Parameters, ReferenceError, Theta, require};

/// Steps and gate of the completion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompletedConfig {
    /// γ_v, at most 4 per sample.
    pub gamma_v: f64,
    /// Below this speed, radians per sample, the completion rests.
    pub slowest: f64,
}

/// The scalar sensitivity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Completion {
    config: CompletedConfig,
    recursion: Recursion<1>,
}

impl Completion {
    /// For a loop with this filter.
    ///
    /// # Errors
    /// γ_v outside 0 … 4 does not converge; sets without a cubic need no completion.
    pub fn new(
        config: CompletedConfig,
        parameters: Parameters,
        filter: Filter,
    ) -> Result<Self, ReferenceError> {
        let CompletedConfig { gamma_v, slowest } = config;
        let reason = "stable up to 4 per sample";
        require((0.0..=4.0).contains(&gamma_v), "gamma_v", gamma_v, reason)?;
        require(
            slowest >= 0.0,
            "slowest",
            slowest,
            "a speed, radians per sample",
        )?;
        if parameters.null_direction(&Theta::zeros()).is_none() {
            return Err(ReferenceError::Impossible(
                "only the sets of eight and nine have a direction that the radius does not show",
            ));
        }
        Ok(Self {
            config,
            recursion: Recursion::new(filter),
        })
    }

    /// What is to be added to Θ along v, if `open` and the signal (`speed` in radians per sample) is fast enough; the
    /// recursion goes on in either case.
    pub fn step(
        &mut self,
        parameters: Parameters,
        theta: &Theta,
        seen: &Observation,
        speed: f64,
        open: bool,
    ) -> Theta {
        let Some(v) = parameters.null_direction(theta) else {
            return Theta::zeros();
        };
        let w_v = seen.w() * v;
        let sensitivity = w_v.x - self.recursion.value().x;
        self.recursion.advance(RowSVector::from(w_v));
        if open && speed.abs() >= self.config.slowest {
            v * (-self.config.gamma_v * sensitivity * seen.e)
        } else {
            Theta::zeros()
        }
    }
}
