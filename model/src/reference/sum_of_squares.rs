//! Sections 5.2 to 5.4: the gradient search that eliminates α by c² + s² = 1. No loop is needed for it.

use super::{Jacobian, Parameters, Theta};

/// ∇ε² of one sample: 4 MᵀMΘ (ΘᵀMᵀMΘ − 1), where ε = |MΘ|² − 1. In the Chebyshev sets M is the derivative and MΘ the
/// corrected pair.
#[must_use]
pub fn gradient(parameters: Parameters, theta: &Theta, y: [f64; 2]) -> Theta {
    gradient_of(
        &parameters.jacobian(theta, y),
        parameters.corrected(theta, y),
    )
}

/// The same of M and of the corrected pair.
fn gradient_of(m: &Jacobian, corrected: [f64; 2]) -> Theta {
    let corrected = nalgebra::Vector2::from(corrected);
    m.transpose() * corrected * (4.0 * (corrected.norm_squared() - 1.0))
}

/// J = Σ ε² over a record.
#[must_use]
pub fn objective(parameters: Parameters, theta: &Theta, samples: &[[f64; 2]]) -> f64 {
    let epsilon = |&y: &[f64; 2]| {
        let [c, s] = parameters.corrected(theta, y);
        c * c + s * s - 1.0
    };
    samples.iter().map(|y| epsilon(y).powi(2)).sum()
}

/// How the on-line form makes a step of many samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Smoothing {
    /// ∇J_k = ∇ε²_k + λ ∇J_{k−1}, an update each sample; 0 ≤ λ < 1, 0 is the plain stochastic gradient.
    Forgetting {
        /// λ.
        lambda: f64,
    },
    /// The gradient is summed over so many samples, then comes an update.
    Batch {
        /// Samples per update.
        samples: u32,
    },
}

/// The on-line search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SumOfSquares {
    smoothing: Smoothing,
    sum: Theta,
    seen: u32,
}

impl SumOfSquares {
    /// With no gradient gathered yet.
    #[must_use]
    pub fn new(smoothing: Smoothing) -> Self {
        Self {
            smoothing,
            sum: Theta::zeros(),
            seen: 0,
        }
    }

    /// Forgets what was gathered.
    pub(super) fn clear(&mut self) {
        (self.sum, self.seen) = (Theta::zeros(), 0);
    }

    /// The same of a batch that is not full.
    pub(super) fn drop_batch(&mut self) {
        if let Smoothing::Batch { .. } = self.smoothing {
            self.clear();
        }
    }

    /// Takes a sample; ∇J where an update is due, zero otherwise.
    pub fn step(&mut self, parameters: Parameters, theta: &Theta, y: [f64; 2]) -> Theta {
        self.step_of(
            &parameters.jacobian(theta, y),
            parameters.corrected(theta, y),
            (None, &Theta::repeat(1.0)),
        )
    }

    /// The same of M and of a pair from which more than Θ has been taken, or of a gradient of the residual `instead`; `free` is 1 where a
    /// parameter learns and 0 where it rests: what was gathered of that stays as it is, and is not to be stepped by.
    pub(super) fn step_of(
        &mut self,
        m: &Jacobian,
        corrected: [f64; 2],
        (instead, free): (Option<Theta>, &Theta),
    ) -> Theta {
        // That of the squares is eight times as large where the radius is near 1.
        let gradient = instead.map_or_else(|| gradient_of(m, corrected), |own| own * 8.0);
        let gradient = gradient.component_mul(free);
        match self.smoothing {
            Smoothing::Forgetting { lambda } => {
                let kept = free.map(|free| 1.0 - free * (1.0 - lambda));
                self.sum = gradient + self.sum.component_mul(&kept);
                self.sum
            }
            Smoothing::Batch { samples } => {
                self.sum += gradient;
                self.seen += 1;
                if self.seen < samples {
                    return Theta::zeros();
                }
                self.seen = 0;
                std::mem::replace(&mut self.sum, Theta::zeros())
            }
        }
    }
}

/// Off line: Θ → Θ − γ ∇J, `iterations` times, ∇J as the mean over the record so that γ does not depend on its length.
#[must_use]
pub fn search(
    parameters: Parameters,
    start: Theta,
    samples: &[[f64; 2]],
    gamma: f64,
    iterations: usize,
) -> Theta {
    let scale = gamma / samples.len().max(1) as f64;
    (0..iterations).fold(start, |theta, _| {
        let sum: Theta = samples
            .iter()
            .map(|&y| gradient(parameters, &theta, y))
            .sum();
        theta - sum * scale
    })
}
