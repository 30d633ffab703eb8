//! Section 5.5: the gradient of the residual, exact by recursion (11) and in its final form.
//!
//! With n = (cos α̂, sin α̂) and n⊥ = (−sin α̂, cos α̂) the residual is r = n ρ + n⊥ e, so that
//!
//! final form:  Mᵀ(r + (sin α̂, −cos α̂) e) = Mᵀ n ρ;
//! exact form:  (M + (sin α̂, −cos α̂) ∇α̂)ᵀ r = Mᵀ n ρ + (w − ∇α̂)ᵀ e.
//!
//! They differ in the term (w − ∇α̂) e alone, which is of second order in the loop's sensitivity: it is what the final
//! form gives up, and with it all sight of parameters that change no radius.

use nalgebra::{RowSVector, Vector2};

use super::harmonics::Harmonics;
use super::loops::Filter;
use super::{Jacobian, Parameters, Theta, skew};

/// What one sample shows, given Θ and α̂.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// M, or the derivative of the corrected pair.
    pub m: Jacobian,
    /// Corrected pair (c, s).
    pub corrected: [f64; 2],
    /// cos α̂.
    pub cos_hat: f64,
    /// sin α̂.
    pub sin_hat: f64,
    /// e, radians.
    pub e: f64,
    /// ρ = nᵀ r: the radial residual.
    pub rho: f64,
}

impl Observation {
    /// Looks at the sample y with Θ and α̂.
    #[must_use]
    pub fn new(parameters: Parameters, theta: &Theta, y: [f64; 2], alpha_hat: f64) -> Self {
        Self::known(parameters, theta, y, alpha_hat, (0.0, &Harmonics::NONE))
    }

    /// The same where the sine's phase runs `kappa` radians ahead because it is sampled later, and with harmonics in the
    /// channels. M stays as it is without: what both change of it is small, and no fixed point of the search depends on it.
    #[must_use]
    pub fn known(
        parameters: Parameters,
        theta: &Theta,
        y: [f64; 2],
        alpha_hat: f64,
        (kappa, harmonics): (f64, &Harmonics),
    ) -> Self {
        let (sin_hat, cos_hat) = alpha_hat.sin_cos();
        let tan_beta = skew::tan_beta(parameters, theta);
        let mut late = parameters.corrected(theta, y);
        if !harmonics.is_none() {
            late = harmonics.removed(late, (alpha_hat, alpha_hat + kappa), tan_beta);
        }
        let [c, s] = if kappa == 0.0 {
            late
        } else {
            skew::together(late, kappa, tan_beta)
        };
        Self {
            m: parameters.at_estimate(theta, y, (cos_hat, sin_hat)),
            corrected: [c, s],
            cos_hat,
            sin_hat,
            e: s * cos_hat - c * sin_hat,
            rho: c * cos_hat + s * sin_hat - 1.0,
        }
    }

    /// The same as if the loop had not lagged: the radius less 1, to third order in e, in the place of its projection ρ.
    #[must_use]
    pub fn without_lag(&self) -> Self {
        let along = self.rho + self.e * self.e / 2.0;
        let (cos, sin) = (self.cos_hat, self.sin_hat);
        Self {
            corrected: [
                cos * (1.0 + along) - sin * self.e,
                sin * (1.0 + along) + cos * self.e,
            ],
            rho: along,
            ..*self
        }
    }

    /// (8): r = corrected pair less (cos α̂, sin α̂).
    #[must_use]
    pub fn residual(&self) -> Vector2<f64> {
        let [c, s] = self.corrected;
        Vector2::new(c - self.cos_hat, s - self.sin_hat)
    }

    /// (10): w = (−sin α̂, cos α̂) M, the derivative of e with respect to Θ at fixed α̂.
    #[must_use]
    pub fn w(&self) -> RowSVector<f64, 9> {
        self.w_across([self.cos_hat, self.sin_hat])
    }

    /// The same across another direction (cos, sin).
    #[must_use]
    pub fn w_across(&self, [cos, sin]: [f64; 2]) -> RowSVector<f64, 9> {
        RowSVector::from_fn(|_, i| -sin * self.m[(0, i)] + cos * self.m[(1, i)])
    }

    /// (sin α̂, −cos α̂): how the residual changes with α̂.
    fn turned(&self) -> Vector2<f64> {
        Vector2::new(self.sin_hat, -self.cos_hat)
    }

    /// Final form of 5.5.1: Mᵀ (r + (sin α̂, −cos α̂) e).
    #[must_use]
    pub fn final_form(&self) -> Theta {
        self.m.transpose() * (self.residual() + self.turned() * self.e)
    }

    /// ∇r = M + (sin α̂, −cos α̂) ∇α̂.
    #[must_use]
    pub fn gradient_of_residual(&self, gradient_of_alpha: &RowSVector<f64, 9>) -> Jacobian {
        self.m + self.turned() * gradient_of_alpha
    }
}

/// Recursion (11) for any number of directions: ∇α̂ from w, through the closed loop.
///
/// (10) is printed as a product in the paper; it is the difference ∇e = w − ∇α̂, and with it (9) gives (11) as printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recursion<const N: usize> {
    filter: Filter,
    now: RowSVector<f64, N>,
    before: RowSVector<f64, N>,
    w_before: RowSVector<f64, N>,
}

impl<const N: usize> Recursion<N> {
    /// With the filter of the loop, ∇α̂ = 0.
    #[must_use]
    pub fn new(filter: Filter) -> Self {
        Self {
            filter,
            now: RowSVector::zeros(),
            before: RowSVector::zeros(),
            w_before: RowSVector::zeros(),
        }
    }

    /// ∇α̂_k.
    #[must_use]
    pub fn value(&self) -> RowSVector<f64, N> {
        self.now
    }

    /// (11): takes w_k, goes from ∇α̂_k to ∇α̂_{k+1}.
    pub fn advance(&mut self, w: RowSVector<f64, N>) {
        let Filter { a, b, c, d } = self.filter;
        let next = self.now * -(c + a) - self.before * (d + b) + w * a + self.w_before * b;
        (self.before, self.now, self.w_before) = (self.now, next, w);
    }
}

/// Which form of the residual gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// With ∇α̂ from recursion (11).
    Exact,
    /// Section 5.5.1: ∇α̂ ≈ w.
    Final,
}

/// The residual gradient of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResidualGradient {
    form: Form,
    recursion: Recursion<9>,
}

impl ResidualGradient {
    /// For a loop with this filter.
    #[must_use]
    pub fn new(form: Form, filter: Filter) -> Self {
        Self {
            form,
            recursion: Recursion::new(filter),
        }
    }

    /// (∇r_k)ᵀ r_k, half the gradient of |r_k|², and the recursion one sample on.
    pub fn step(&mut self, seen: &Observation) -> Theta {
        match self.form {
            Form::Final => seen.final_form(),
            Form::Exact => {
                let gradient = seen.gradient_of_residual(&self.recursion.value());
                self.recursion.advance(seen.w());
                gradient.transpose() * seen.residual()
            }
        }
    }
}
