//! The on-line gradient searches of sections 5.2 to 5.5.

use super::{Filter, ParameterSet};

/// What is made small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Objective {
    /// 5.2, 5.3: the sum of (‖MΘ‖² − 1)², its gradient smoothed with the forgetting factor λ in [0, 1).
    SumOfSquares {
        /// λ.
        lambda: f64,
    },
    /// The same, the gradient summed over so many samples before an update.
    Batch {
        /// Samples per update.
        samples: usize,
    },
    /// 5.5: the residual, with the exact gradient of α̂ by recursion (11).
    Residual,
    /// 5.5.1: the residual in its final form.
    FinalForm,
}

/// A search: its objective and what it remembers.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    set: ParameterSet,
    objective: Objective,
    /// ∇J, smoothed or summed.
    gradient: Vec<f64>,
    summed: usize,
    /// ∇α̂_k, ∇α̂_{k−1}, w_{k−1} of (11).
    nabla: Vec<f64>,
    nabla_before: Vec<f64>,
    w_before: Vec<f64>,
}

impl Search {
    /// A search that has seen nothing.
    #[must_use]
    pub fn new(set: ParameterSet, objective: Objective) -> Self {
        let zeros = vec![0.0; set.len()];
        Self {
            set,
            objective,
            gradient: zeros.clone(),
            summed: 0,
            nabla: zeros.clone(),
            nabla_before: zeros.clone(),
            w_before: zeros,
        }
    }

    /// ∇α̂_k of (11).
    #[must_use]
    pub fn nabla_alpha_hat(&self) -> &[f64] {
        &self.nabla
    }

    /// The gradient that Θ goes down along at this sample: δΘ = −γ times this. `e` is e_k in radians, `filter` the loop
    /// before its step.
    pub fn gradient(
        &mut self,
        (y_c, y_s): (f64, f64),
        theta: &[f64],
        filter: &Filter,
        e: f64,
    ) -> Vec<f64> {
        let m = self.set.columns(y_c, y_s);
        let (c, s) = self.set.correct(theta, y_c, y_s);
        let (sin, cos) = filter.alpha_hat().sin_cos();
        let r = [c - cos, s - sin];
        match self.objective {
            Objective::SumOfSquares { lambda } => {
                let own = sum_of_squares(&m, c, s);
                for (g, own) in self.gradient.iter_mut().zip(own) {
                    *g = own + lambda * *g;
                }
                self.gradient.clone()
            }
            Objective::Batch { samples } => {
                for (g, own) in self.gradient.iter_mut().zip(sum_of_squares(&m, c, s)) {
                    *g += own;
                }
                self.summed += 1;
                let zeros = vec![0.0; m.len()];
                if self.summed < samples {
                    return zeros;
                }
                self.summed = 0;
                std::mem::replace(&mut self.gradient, zeros)
            }
            Objective::FinalForm => {
                let along = [r[0] + sin * e, r[1] - cos * e];
                m.iter()
                    .map(|m| m[0] * along[0] + m[1] * along[1])
                    .collect()
            }
            Objective::Residual => {
                let gradient = m
                    .iter()
                    .zip(&self.nabla)
                    .map(|(m, nabla)| (m[0] + sin * nabla) * r[0] + (m[1] - cos * nabla) * r[1]);
                let gradient = gradient.collect();
                let w: Vec<f64> = m.iter().map(|m| m[1] * cos - m[0] * sin).collect();
                self.recursion(w, filter);
                gradient
            }
        }
    }

    /// Equation (11).
    fn recursion(&mut self, w: Vec<f64>, f: &Filter) {
        let next = (0..w.len())
            .map(|i| {
                -(f.c + f.a) * self.nabla[i] - (f.d + f.b) * self.nabla_before[i]
                    + f.a * w[i]
                    + f.b * self.w_before[i]
            })
            .collect();
        self.nabla_before = std::mem::replace(&mut self.nabla, next);
        self.w_before = w;
    }
}

/// 4 MᵀMΘ (ΘᵀMᵀMΘ − 1), with (c, s) = MΘ.
fn sum_of_squares(m: &[[f64; 2]], c: f64, s: f64) -> Vec<f64> {
    let excess = c * c + s * s - 1.0;
    m.iter()
        .map(|m| 4.0 * (m[0] * c + m[1] * s) * excess)
        .collect()
}
