//! The completed gradient: the radial update for everything, and one scalar sensitivity for the direction v that no
//! radius shows (section 5.4 is singular along it, see [`Parameters::null_direction`]).
//!
//! w_v = n⊥ᵀ M v;  ∇_v α̂ by recursion (11), one scalar;  μ ← μ − γ_v (w_v − ∇_v α̂) e;  Θ moves along v with μ.
//!
//! It learns at γ_v |S(2f)|²/8 per sample, S the loop's sensitivity at twice the signal frequency f: what a wide loop
//! follows, it cannot tell from motion. (The chip takes the 64 sectors of a period for that, and moves where the period ends, so
//! that what an axis does while it brakes is dropped.) Hence its gate of its own: net travel slower than `slowest` and it rests, and so
//! it does under vibration, however fast. It cannot tell motion at two cycles per scale period from sensor error either;
//! where a scale period is a revolution, do not use it.

use std::f64::consts::TAU;

use nalgebra::RowSVector;

use super::gradient::{Observation, Recursion};
use super::loops::Filter;
use super::{Parameters, ReferenceError, Theta, require};

/// Steps and gate of the completion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompletedConfig {
    /// γ_v, at most 4 per sample.
    pub gamma_v: f64,
    /// Below this speed of net travel, radians per sample, the completion rests; 0: it never does.
    pub slowest: f64,
}

/// Whether whole periods of net travel follow one another fast enough.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Moving {
    slowest: f64,
    /// α̂, radians, where the running period began, and samples since.
    began: Option<f64>,
    samples: f64,
    open: bool,
}

impl Moving {
    fn step(&mut self, alpha_hat: f64) -> bool {
        let began = *self.began.get_or_insert(alpha_hat);
        self.samples += 1.0;
        // Exactly at the slowest it rests, whatever the rounding.
        let late = self.samples * self.slowest > TAU * (1.0 - 1e-12);
        if late || (alpha_hat - began).abs() >= TAU {
            self.open = !late;
            self.began = Some(alpha_hat);
            self.samples = 0.0;
        }
        self.open
    }
}

/// The scalar sensitivity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Completion {
    gamma_v: f64,
    moving: Moving,
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
            gamma_v,
            moving: Moving {
                slowest,
                began: None,
                samples: 0.0,
                open: slowest == 0.0,
            },
            recursion: Recursion::new(filter),
        })
    }

    /// What is to be added to Θ along v, if `locked` and the signal travels fast enough; recursion and gate go on in
    /// either case. `alpha_hat` is unwrapped, radians.
    pub fn step(
        &mut self,
        parameters: Parameters,
        theta: &Theta,
        seen: &Observation,
        alpha_hat: f64,
        locked: bool,
    ) -> Theta {
        let Some(v) = parameters.null_direction(theta) else {
            return Theta::zeros();
        };
        let w_v = seen.w() * v;
        let sensitivity = w_v.x - self.recursion.value().x;
        self.recursion.advance(RowSVector::from(w_v));
        let moving = self.moving.step(alpha_hat);
        if locked && moving {
            v * (-self.gamma_v * sensitivity * seen.e)
        } else {
            Theta::zeros()
        }
    }
}
