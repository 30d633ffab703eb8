//! Equation (4) as a curve: points, tangents, curvature, the nearest point.

use nalgebra::{SVector, Vector2};

/// y_c = a_c cos α + b_c, y_s = a_s sin(α − β) + b_s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Amplitude of the cosine channel, in the unit of the signals, above 0.
    pub a_c: f64,
    /// Offset of the cosine channel.
    pub b_c: f64,
    /// Amplitude of the sine channel, above 0.
    pub a_s: f64,
    /// Offset of the sine channel.
    pub b_s: f64,
    /// Phase error in radians, −π/2 … π/2.
    pub beta: f64,
}

/// The parameters in the order of the fields.
pub type Parameters = SVector<f64, 5>;

impl Ellipse {
    /// The parameters as a vector.
    #[must_use]
    pub fn parameters(&self) -> Parameters {
        Parameters::new(self.a_c, self.b_c, self.a_s, self.b_s, self.beta)
    }

    /// The ellipse of a parameter vector.
    #[must_use]
    pub fn of(p: &Parameters) -> Self {
        Self {
            a_c: p[0],
            b_c: p[1],
            a_s: p[2],
            b_s: p[3],
            beta: p[4],
        }
    }

    /// The signals at α in radians.
    #[must_use]
    pub fn point(&self, alpha: f64) -> Vector2<f64> {
        Vector2::new(
            self.a_c * alpha.cos() + self.b_c,
            self.a_s * (alpha - self.beta).sin() + self.b_s,
        )
    }

    /// Their derivative by α.
    #[must_use]
    pub fn tangent(&self, alpha: f64) -> Vector2<f64> {
        Vector2::new(
            -self.a_c * alpha.sin(),
            self.a_s * (alpha - self.beta).cos(),
        )
    }

    /// Their derivative by each parameter, at constant α.
    #[must_use]
    pub fn by_parameters(&self, alpha: f64) -> [Vector2<f64>; 5] {
        let (sin, cos) = (alpha - self.beta).sin_cos();
        [
            Vector2::new(alpha.cos(), 0.0),
            Vector2::new(1.0, 0.0),
            Vector2::new(0.0, sin),
            Vector2::new(0.0, 1.0),
            Vector2::new(0.0, -self.a_s * cos),
        ]
    }

    /// The corrected pair (cos α, sin α) of a raw pair.
    #[must_use]
    pub fn corrected(&self, y_c: f64, y_s: f64) -> (f64, f64) {
        let c = (y_c - self.b_c) / self.a_c;
        let (sin, cos) = self.beta.sin_cos();
        (c, ((y_s - self.b_s) / self.a_s + c * sin) / cos)
    }

    /// Θ of section 5.3: cos α = θ1 y_c + θ2, sin α = θ3 y_s + θ4 + θ5 y_c.
    #[must_use]
    pub fn theta(&self) -> [f64; 5] {
        let (cos, tan) = (self.beta.cos(), self.beta.tan());
        [
            1.0 / self.a_c,
            -self.b_c / self.a_c,
            1.0 / (self.a_s * cos),
            -self.b_s / (self.a_s * cos) - self.b_c * tan / self.a_c,
            tan / self.a_c,
        ]
    }

    /// The ellipse that Θ turns into the unit circle.
    #[must_use]
    pub fn of_theta(theta: &[f64]) -> Self {
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

    /// Whether it is one: finite, amplitudes above 0, |β| below a right angle.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let finite = self.parameters().iter().all(|v| v.is_finite());
        finite && self.a_c > 0.0 && self.a_s > 0.0 && self.beta.abs() < 1.5
    }

    /// The mean amplitude.
    #[must_use]
    pub fn amplitude(&self) -> f64 {
        (self.a_c + self.a_s) / 2.0
    }

    /// α of the nearest point, distances measured with the channels' `weight` (1/σ² up to a factor).
    #[must_use]
    pub fn nearest(&self, y: Vector2<f64>, weight: Vector2<f64>) -> f64 {
        let (c, s) = self.corrected(y.x, y.y);
        let mut alpha = s.atan2(c);
        for _ in 0..12 {
            let (sin, cos) = (alpha - self.beta).sin_cos();
            let miss = y - self.point(alpha);
            let along = self.tangent(alpha);
            let bend = Vector2::new(-self.a_c * alpha.cos(), -self.a_s * sin);
            let weighted = miss.component_mul(&weight);
            let slope = -weighted.dot(&along);
            let along_weighted = along.component_mul(&weight);
            // Gauss–Newton where the curvature of the distance is no help.
            let full = along_weighted.dot(&along) - weighted.dot(&bend);
            let own = along_weighted.dot(&along);
            let step = slope / if full > 0.2 * own { full } else { own };
            alpha -= step.clamp(-0.5, 0.5);
            let _ = cos;
            if step.abs() < 1e-13 {
                break;
            }
        }
        alpha
    }
}
