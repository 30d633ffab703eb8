//! Least-squares conic through points, homogeneous, in Taubin's normalisation.
//!
//! A x² + B xy + C y² + D x + E y + F = 0 with the mean squared gradient held at one. Unlike "F = 1"
//! it does not mind where the origin lies, and unlike plain normalisation noise hardly shrinks it.

use nalgebra::{Cholesky, Matrix5, SymmetricEigen, Vector5};

use crate::ellipse::Ellipse;

/// Sums over the points, for coordinates of order one.
#[derive(Default)]
pub(crate) struct Conic {
    count: f64,
    sum: Vector5<f64>,
    squares: Matrix5<f64>,
    gradients: Matrix5<f64>,
}

impl Conic {
    pub(crate) fn add(&mut self, x: f64, y: f64) {
        let z = Vector5::new(x * x, x * y, y * y, x, y);
        let along_x = Vector5::new(2.0 * x, y, 0.0, 1.0, 0.0);
        let along_y = Vector5::new(0.0, x, 2.0 * y, 0.0, 1.0);
        self.count += 1.0;
        self.sum += z;
        self.squares.syger(1.0, &z, &z, 1.0);
        self.gradients.syger(1.0, &along_x, &along_x, 1.0);
        self.gradients.syger(1.0, &along_y, &along_y, 1.0);
    }

    /// The ellipse, or `None` where the points do not make one.
    pub(crate) fn ellipse(mut self) -> Option<Ellipse> {
        let mean = self.sum / self.count;
        self.squares.syger(-self.count, &mean, &mean, 1.0);
        // The sums fill one triangle.
        self.squares.fill_upper_triangle_with_lower_triangle();
        self.gradients.fill_upper_triangle_with_lower_triangle();
        if !(self.squares.iter().chain(self.gradients.iter())).all(|v| v.is_finite()) {
            return None;
        }
        let root = Cholesky::new(self.gradients)?.l();
        let inverse = root.try_inverse()?;
        let spread = inverse * self.squares * inverse.transpose();
        if !spread.iter().all(|v| v.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::try_new(spread, f64::EPSILON, 1000)?;
        let smallest = eigen.eigenvalues.imin();
        let q = inverse.transpose() * eigen.eigenvectors.column(smallest);
        let f = -q.dot(&mean);
        Ellipse::of_conic([q[0], q[1], q[2], q[3], q[4], f])
    }
}

impl Ellipse {
    /// The ellipse A x² + B xy + C y² + D x + E y + F = 0 from its coefficients A … F: the closed-form solution of the
    /// paper's equations (5), up to a common factor of either sign. x is the cos channel, y the sin channel. `None`
    /// where the conic is no real ellipse.
    #[must_use]
    pub fn of_conic([a, b, c, d, e, f]: [f64; 6]) -> Option<Self> {
        let discriminant = 4.0 * a * c - b * b;
        let b_c = (b * e - 2.0 * c * d) / discriminant;
        let b_s = (b * d - 2.0 * a * e) / discriminant;
        // About its centre: A x² + B xy + C y² = size.
        let size = -(f + (d * b_c + e * b_s) / 2.0);
        let (a, b, c) = (a / size, b / size, c / size);
        let sin_beta = b / (2.0 * (a * c).sqrt());
        let cos_beta_squared = 1.0 - sin_beta * sin_beta;
        let ellipse = Self {
            a_c: (a * cos_beta_squared).sqrt().recip(),
            b_c,
            a_s: (c * cos_beta_squared).sqrt().recip(),
            b_s,
            beta: sin_beta.asin(),
        };
        let real = discriminant > 0.0 && a > 0.0 && c > 0.0 && cos_beta_squared > 0.0;
        (real && ellipse.is_finite()).then_some(ellipse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ellipse_is_found_wherever_the_origin_lies() {
        let shapes = [
            (1.0, 0.0, 1.0, 0.0, 0.0),
            (0.7, 0.7, 1.3, 0.0, 0.3),
            (1.0, 1.4, 0.5, -1.0, -0.9),
            (1.0, -3.0, 1.0, 2.0, 1.2),
        ];
        for (a_c, b_c, a_s, b_s, beta) in shapes {
            let mut conic = Conic::default();
            for k in 0..16 {
                let alpha = f64::from(k) * 0.39;
                conic.add(a_c * alpha.cos() + b_c, a_s * (alpha - beta).sin() + b_s);
            }
            let found = conic.ellipse().expect("an ellipse");
            let pairs = [
                (found.a_c, a_c),
                (found.b_c, b_c),
                (found.a_s, a_s),
                (found.b_s, b_s),
                (found.beta, beta),
            ];
            for (found, expected) in pairs {
                assert!((found - expected).abs() < 1e-6, "{found} {expected}");
            }
        }
    }

    #[test]
    fn points_that_make_no_ellipse_give_none() {
        let fit = |points: &dyn Fn(f64) -> (f64, f64)| {
            let mut conic = Conic::default();
            (0..20)
                .map(|k| points(f64::from(k) / 10.0 - 1.0))
                .for_each(|(x, y)| conic.add(x, y));
            conic.ellipse()
        };
        assert_eq!(fit(&|_| (1.0, 2.0)), None);
        assert_eq!(fit(&|t| (t.cosh(), t.sinh())), None);
        assert_eq!(fit(&|t| (t, f64::NAN)), None);
        assert_eq!(Conic::default().ellipse(), None);
    }
}
