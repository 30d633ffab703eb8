//! A start by least squares over whole periods of travel, as a design asks for it (`calibration.start = "least_squares"`).
//!
//! The pair that Θ corrects has the radius R and the direction n; along it the radius changes by h δΘ with h = nᵀ M. Over a
//! period of travel the δΘ that makes Σ w (R − 1 + h δΘ)² least, w the way that a sample stands for, is a linear problem:
//!
//! (Σ w hᵀ h) δΘ = −Σ w hᵀ (R − 1).
//!
//! Gains, offsets and phase are solved, bends are left to the search. R and n are the pair's own, so that what the loop has not
//! followed yet is no error of Θ. Not in the paper.

use std::f64::consts::TAU;

use nalgebra::{RowSVector, SMatrix};

use super::gradient::Observation;
use super::{Parameters, Theta};

/// The periods, as far as they have come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solved {
    wanted: u32,
    done: u32,
    normal: SMatrix<f64, 9, 9>,
    right: Theta,
    /// The pair's angle (radians, unwrapped) where the running period began, and at the sample before.
    way: Option<(f64, f64)>,
}

impl Solved {
    /// Before the first of so many periods of travel.
    #[must_use]
    pub fn new(periods: u32) -> Self {
        Self {
            wanted: periods,
            done: 0,
            normal: SMatrix::zeros(),
            right: Theta::zeros(),
            way: None,
        }
    }

    /// There are periods to come.
    #[must_use]
    pub fn running(&self) -> bool {
        self.done < self.wanted
    }

    /// The signal has changed: all of them are to come.
    pub fn again(&mut self) {
        *self = Self::new(self.wanted);
    }

    /// Lock is lost: what was gathered of a period is dropped.
    pub fn drop_period(&mut self) {
        *self = Self {
            done: self.done,
            ..Self::new(self.wanted)
        };
    }

    /// Takes a sample in lock and its α̂ (radians, unwrapped); the change of Θ where a period of travel ends.
    pub fn step(
        &mut self,
        parameters: Parameters,
        seen: &Observation,
        alpha_hat: f64,
    ) -> Option<Theta> {
        let [c, s] = seen.corrected;
        let radius = c.hypot(s);
        // 1 + ρ is the pair's part along the estimate, e that across it.
        let angle = alpha_hat + seen.e.atan2(1.0 + seen.rho);
        let (began, before) = self.way.unwrap_or((angle, angle));
        let weight = (angle - before).abs();
        self.way = Some((began, angle));
        if radius > 0.0 {
            let h = RowSVector::<f64, 9>::from_fn(|_, i| {
                (c * seen.m[(0, i)] + s * seen.m[(1, i)]) / radius
            });
            self.normal += h.transpose() * h * weight;
            self.right -= h.transpose() * ((radius - 1.0) * weight);
        }
        if (angle - began).abs() < TAU {
            return None;
        }
        let change = self.solve(parameters);
        let done = self.done + 1;
        *self = Self {
            done,
            way: Some((angle, angle)),
            ..Self::new(self.wanted)
        };
        change
    }

    /// δΘ of the period that was gathered.
    fn solve(&self, parameters: Parameters) -> Option<Theta> {
        let mut own = SMatrix::<f64, 9, 9>::identity();
        let mut right = Theta::zeros();
        // Gains, offsets and, where there is one, the phase.
        let linear = || parameters.linear().into_iter().chain(parameters.phase());
        for i in linear() {
            right[i] = self.right[i];
            for j in linear() {
                own[(i, j)] = self.normal[(i, j)];
            }
        }
        own.cholesky().map(|normal| normal.solve(&right))
    }
}
