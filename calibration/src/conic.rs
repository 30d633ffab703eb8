//! Heydemann's least squares, section 5.1, and the closed-form solution of equations (5).
//!
//! The conic is fitted homogeneously, in a frame in which the samples are centred and of size one: the form "= 1" is
//! singular where the ellipse passes through the origin, and its signs turn where the origin lies outside.

use nalgebra::{Matrix6, SMatrix, Vector6};
use nonius_recording::Ellipse;

use crate::curve::{Curve, Parameters};
use crate::sandwich::Sandwich;

/// A frame in which the samples are centred and of size one, each channel for itself.
struct Frame {
    middle: [f64; 2],
    size: [f64; 2],
}

impl Frame {
    fn of(cos: &[f64], sin: &[f64]) -> Option<Self> {
        let n = cos.len() as f64;
        let middle = [cos, sin].map(|v| v.iter().sum::<f64>() / n);
        let spread =
            |v: &[f64], m: f64| (v.iter().map(|x| (x - m).powi(2)).sum::<f64>() / n).sqrt();
        let size = [spread(cos, middle[0]), spread(sin, middle[1])];
        let good = size.iter().all(|s| *s > 0.0 && s.is_finite());
        good.then_some(Self { middle, size })
    }

    /// [x², y², xy, x, y, 1].
    fn row(&self, y_c: f64, y_s: f64) -> Vector6<f64> {
        let x = (y_c - self.middle[0]) / self.size[0];
        let y = (y_s - self.middle[1]) / self.size[1];
        Vector6::new(x * x, y * y, x * y, x, y, 1.0)
    }

    fn normalised(&self, e: &Ellipse) -> Ellipse {
        Ellipse {
            a_c: e.a_c / self.size[0],
            b_c: (e.b_c - self.middle[0]) / self.size[0],
            a_s: e.a_s / self.size[1],
            b_s: (e.b_s - self.middle[1]) / self.size[1],
            beta: e.beta,
        }
    }

    fn raw(&self, e: &Ellipse) -> Ellipse {
        Ellipse {
            a_c: e.a_c * self.size[0],
            b_c: e.b_c * self.size[0] + self.middle[0],
            a_s: e.a_s * self.size[1],
            b_s: e.b_s * self.size[1] + self.middle[1],
            beta: e.beta,
        }
    }
}

/// The least-squares conic, as an ellipse; `None` where the data make none.
#[must_use]
pub fn heydemann(cos: &[f64], sin: &[f64]) -> Option<Ellipse> {
    let frame = Frame::of(cos, sin)?;
    let mut gram = Matrix6::zeros();
    for (c, s) in cos.iter().zip(sin) {
        let row = frame.row(*c, *s);
        gram.syger(1.0, &row, &row, 1.0);
    }
    gram.fill_upper_triangle_with_lower_triangle();
    let eigen = gram.symmetric_eigen();
    let q = eigen.eigenvectors.column(eigen.eigenvalues.imin());
    let found = closed_form([q[0], q[1], q[2], q[3], q[4], q[5]])?;
    let ellipse = frame.raw(&found);
    ellipse.is_sound().then_some(ellipse)
}

/// Covariance of what [`heydemann`] found, from the scatter of the samples' algebraic distances.
#[must_use]
pub fn covariance(cos: &[f64], sin: &[f64], found: &Ellipse) -> Option<SMatrix<f64, 5, 5>> {
    let frame = Frame::of(cos, sin)?;
    let inside = frame.normalised(found);
    let conic = |p: &Parameters| equations_5(&Ellipse::of(p)).normalize();
    let q = conic(&inside.parameters());
    let mut by = SMatrix::<f64, 6, 5>::zeros();
    for i in 0..5 {
        let at = |h: f64| {
            let mut p = inside.parameters();
            p[i] += h;
            conic(&p)
        };
        by.set_column(i, &((at(1e-6) - at(-1e-6)) / 2e-6));
    }
    let mut sandwich = Sandwich::new(5);
    for (c, s) in cos.iter().zip(sin) {
        let row = frame.row(*c, *s);
        let slope = by.transpose() * row;
        sandwich.add(row.dot(&q), slope.as_slice());
    }
    let inner = sandwich.covariance()?;
    let [c, s] = frame.size;
    let unit = [c, c, s, s, 1.0];
    Some(SMatrix::from_fn(|i, j| inner[(i, j)] * unit[i] * unit[j]))
}

/// Equations (5) without the division by K, which is 0 where the ellipse passes through the origin:
/// θ1 y_c² + θ2 y_s² + θ3 y_c y_s + θ4 y_c + θ5 y_s + θ6 = 0.
#[must_use]
pub fn equations_5(e: &Ellipse) -> Vector6<f64> {
    let (g_c, g_s) = (1.0 / e.a_c, 1.0 / e.a_s);
    let (u, v) = (g_c * e.b_c, g_s * e.b_s);
    let (sin, cos) = e.beta.sin_cos();
    Vector6::new(
        g_c * g_c,
        g_s * g_s,
        2.0 * g_c * g_s * sin,
        -2.0 * g_c * (u + v * sin),
        -2.0 * g_s * (v + u * sin),
        u * u + v * v + 2.0 * u * v * sin - cos * cos,
    )
}

/// Equations (5) solved: θ1 y_c² + θ2 y_s² + θ3 y_c y_s + θ4 y_c + θ5 y_s + θ6 = 0 as amplitudes, offsets and phase.
/// θ6 = −1 is the paper's form. `None` where it is no ellipse.
#[must_use]
pub fn closed_form(theta: [f64; 6]) -> Option<Ellipse> {
    let [t1, t2, t3, t4, t5, t6] = theta;
    Ellipse::of_conic([t1, t3, t2, t4, t5, t6]).filter(Curve::is_sound)
}
