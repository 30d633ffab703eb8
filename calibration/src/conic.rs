//! Heydemann's least squares, section 5.1, and the closed-form solution of equations (5).
//!
//! The conic is fitted homogeneously, about the middle of the data: the form "= 1" is singular where the ellipse
//! passes through the origin, and its signs turn where the origin lies outside.

use nalgebra::{SMatrix, SVector};

use crate::ellipse::Ellipse;

/// The least-squares conic, as an ellipse; `None` where the data make none.
#[must_use]
pub fn heydemann(cos: &[f64], sin: &[f64]) -> Option<Ellipse> {
    let n = cos.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
    let (x0, y0) = (mean(cos), mean(sin));
    let spread = |v: &[f64], m: f64| (v.iter().map(|x| (x - m).powi(2)).sum::<f64>() / n).sqrt();
    let scale = (spread(cos, x0).powi(2) + spread(sin, y0).powi(2)).sqrt();
    if !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    let mut gram = SMatrix::<f64, 6, 6>::zeros();
    for (c, s) in cos.iter().zip(sin) {
        let (x, y) = ((c - x0) / scale, (s - y0) / scale);
        let row = SVector::<f64, 6>::from([x * x, y * y, x * y, x, y, 1.0]);
        gram += row * row.transpose();
    }
    let eigen = gram.symmetric_eigen();
    let q = eigen
        .eigenvectors
        .column(eigen.eigenvalues.imin())
        .clone_owned();
    let found = closed_form([q[0], q[1], q[2], q[3], q[4], q[5]])?;
    let ellipse = Ellipse {
        a_c: found.a_c * scale,
        b_c: found.b_c * scale + x0,
        a_s: found.a_s * scale,
        b_s: found.b_s * scale + y0,
        beta: found.beta,
    };
    ellipse.is_sound().then_some(ellipse)
}

/// Equations (5) solved: θ1 y_c² + θ2 y_s² + θ3 y_c y_s + θ4 y_c + θ5 y_s + θ6 = 0 as amplitudes, offsets and phase.
/// θ6 = −1 is the paper's form.
#[must_use]
pub fn closed_form(theta: [f64; 6]) -> Option<Ellipse> {
    let [t1, t2, t3, t4, t5, t6] = theta;
    let discriminant = 4.0 * t1 * t2 - t3 * t3;
    // NaN is no ellipse either.
    if discriminant.is_nan() || discriminant <= 0.0 {
        return None;
    }
    let b_c = (t3 * t5 - 2.0 * t2 * t4) / discriminant;
    let b_s = (t3 * t4 - 2.0 * t1 * t5) / discriminant;
    // About the centre: θ1 x² + θ2 y² + θ3 x y = size.
    let size = -(t6 + (t4 * b_c + t5 * b_s) / 2.0);
    let sin = t1.signum() * t3 / (2.0 * (t1 * t2).sqrt());
    let cos2 = 1.0 - sin * sin;
    let (c2, s2) = (size / t1 / cos2, size / t2 / cos2);
    if !(c2 > 0.0 && s2 > 0.0) {
        return None;
    }
    let ellipse = Ellipse {
        a_c: c2.sqrt(),
        b_c,
        a_s: s2.sqrt(),
        b_s,
        beta: sin.asin(),
    };
    ellipse.is_sound().then_some(ellipse)
}
