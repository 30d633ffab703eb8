//! Equation (4) as a curve: points, tangents, curvature, the nearest point; and Θ of section 5.3.

use nalgebra::{DMatrix, SMatrix, SVector, Vector2};
use nonius_recording::Ellipse;

/// a_c, b_c, a_s, b_s, β.
pub type Parameters = SVector<f64, 5>;

/// Largest |β| that still counts as a sin/cos pair, in radians (86°).
const STEEPEST: f64 = 1.5;

/// What calibration needs of an [`Ellipse`]. Angles are in radians, lengths in the unit of the signals.
pub trait Curve: Sized {
    /// The parameters as a vector.
    fn parameters(&self) -> Parameters;
    /// The ellipse of a parameter vector.
    fn of(p: &Parameters) -> Self;
    /// The signals at α, equation (4).
    fn point(&self, alpha: f64) -> Vector2<f64>;
    /// Their derivative by α.
    fn tangent(&self, alpha: f64) -> Vector2<f64>;
    /// Their second derivative by α.
    fn bend(&self, alpha: f64) -> Vector2<f64>;
    /// Their derivative by each parameter, at constant α.
    fn by_parameters(&self, alpha: f64) -> [Vector2<f64>; 5];
    /// Θ of section 5.3: cos α = θ1 y_c + θ2, sin α = θ3 y_s + θ4 + θ5 y_c.
    fn theta(&self) -> [f64; 5];
    /// The ellipse that Θ of section 5.2 (four) or 5.3 (five) turns into the unit circle.
    fn of_theta(theta: &[f64]) -> Self;
    /// Whether it is one: finite, amplitudes above 0, |β| below a right angle.
    fn is_sound(&self) -> bool;
    /// Amplitudes for lengths, a radian for β: what makes the parameters comparable.
    fn units(&self) -> Parameters;
    /// α of the nearest point, searched from `alpha`; distances measured with the channels' `weight` (1/σ² up to a
    /// factor).
    fn nearest(&self, y: Vector2<f64>, weight: Vector2<f64>, alpha: f64) -> f64;
}

impl Curve for Ellipse {
    fn parameters(&self) -> Parameters {
        Parameters::new(self.a_c, self.b_c, self.a_s, self.b_s, self.beta)
    }

    fn of(p: &Parameters) -> Self {
        Self {
            a_c: p[0],
            b_c: p[1],
            a_s: p[2],
            b_s: p[3],
            beta: p[4],
        }
    }

    fn point(&self, alpha: f64) -> Vector2<f64> {
        Vector2::new(
            self.a_c * alpha.cos() + self.b_c,
            self.a_s * (alpha - self.beta).sin() + self.b_s,
        )
    }

    fn tangent(&self, alpha: f64) -> Vector2<f64> {
        let cos = (alpha - self.beta).cos();
        Vector2::new(-self.a_c * alpha.sin(), self.a_s * cos)
    }

    fn bend(&self, alpha: f64) -> Vector2<f64> {
        let sin = (alpha - self.beta).sin();
        Vector2::new(-self.a_c * alpha.cos(), -self.a_s * sin)
    }

    fn by_parameters(&self, alpha: f64) -> [Vector2<f64>; 5] {
        let (sin, cos) = (alpha - self.beta).sin_cos();
        [
            Vector2::new(alpha.cos(), 0.0),
            Vector2::new(1.0, 0.0),
            Vector2::new(0.0, sin),
            Vector2::new(0.0, 1.0),
            Vector2::new(0.0, -self.a_s * cos),
        ]
    }

    fn theta(&self) -> [f64; 5] {
        let (cos, tan) = (self.beta.cos(), self.beta.tan());
        [
            1.0 / self.a_c,
            -self.b_c / self.a_c,
            1.0 / (self.a_s * cos),
            -self.b_s / (self.a_s * cos) - self.b_c * tan / self.a_c,
            tan / self.a_c,
        ]
    }

    fn of_theta(theta: &[f64]) -> Self {
        let five = theta.get(4).copied().unwrap_or(0.0);
        let (a_c, b_c) = (1.0 / theta[0], -theta[1] / theta[0]);
        let beta = (five * a_c).atan();
        let scale = 1.0 / theta[2];
        Self {
            a_c,
            b_c,
            a_s: scale / beta.cos(),
            b_s: -(theta[3] + b_c * five) * scale,
            beta,
        }
    }

    fn is_sound(&self) -> bool {
        let finite = self.parameters().iter().all(|v| v.is_finite());
        finite && self.a_c > 0.0 && self.a_s > 0.0 && self.beta.abs() < STEEPEST
    }

    fn units(&self) -> Parameters {
        let a = self.amplitude();
        Parameters::new(a, a, a, a, 1.0)
    }

    fn nearest(&self, y: Vector2<f64>, weight: Vector2<f64>, mut alpha: f64) -> f64 {
        for _ in 0..20 {
            let miss = (y - self.point(alpha)).component_mul(&weight);
            let along = self.tangent(alpha);
            let own = along.component_mul(&weight).dot(&along);
            let full = own - miss.dot(&self.bend(alpha));
            // Gauss–Newton where the curvature of the distance is no help.
            let step = miss.dot(&along) / if full > 0.2 * own { full } else { own };
            alpha += step.clamp(-0.5, 0.5);
            if step.abs() < 1e-9 {
                // Newton's next step would be below the square of this one.
                break;
            }
        }
        alpha
    }
}

/// Covariance of θ1 … θ5 from that of the physical parameters.
#[must_use]
pub fn theta_covariance(ellipse: &Ellipse, covariance: &SMatrix<f64, 5, 5>) -> SMatrix<f64, 5, 5> {
    let steps = ellipse.units() * 1e-6;
    let mut jacobian = SMatrix::<f64, 5, 5>::zeros();
    for i in 0..5 {
        let at = |sign: f64| {
            let mut p = ellipse.parameters();
            p[i] += sign * steps[i];
            Parameters::from(Ellipse::of(&p).theta())
        };
        jacobian.set_column(i, &((at(1.0) - at(-1.0)) / (2.0 * steps[i])));
    }
    jacobian * covariance * jacobian.transpose()
}

/// Of five parameters, as of a set of any number.
pub(crate) fn dynamic(covariance: &SMatrix<f64, 5, 5>) -> DMatrix<f64> {
    DMatrix::from_fn(5, 5, |i, j| covariance[(i, j)])
}

/// Share of the largest eigenvalue below which an information matrix, in comparable units, is rounding.
const RANK: f64 = 1e-13;

/// The inverse of an information matrix of the parameters; `None` where the samples leave a direction open.
pub(crate) fn invert(
    information: &SMatrix<f64, 5, 5>,
    ellipse: &Ellipse,
) -> Option<SMatrix<f64, 5, 5>> {
    let unit = SMatrix::<f64, 5, 5>::from_diagonal(&ellipse.units());
    let comparable = unit * information * unit;
    if !comparable.iter().all(|v| v.is_finite()) {
        return None;
    }
    let eigen = comparable.symmetric_eigen();
    let values = eigen.eigenvalues;
    if values.max() <= 0.0 || values.min() <= RANK * values.max() {
        return None;
    }
    let inverse = SMatrix::from_diagonal(&values.map(|v| 1.0 / v));
    let vectors = unit * eigen.eigenvectors;
    Some(vectors * inverse * vectors.transpose())
}
