//! Section 5.1: Heydemann's least squares, and the inversion of (5) in closed form.
//!
//! The form "= 1" is the paper's. It is singular where the ellipse passes through the origin, and its five numbers all
//! turn negative where the origin lies outside; the inversion takes either sign.

use nalgebra::{Matrix2, MatrixXx5, RowSVector, SVector, Vector2};

use super::{ReferenceError, Sensor};

/// θ1 … θ5 of (5): θ1 y_c² + θ2 y_s² + θ3 y_c y_s + θ4 y_c + θ5 y_s = 1.
pub type Conic = SVector<f64, 5>;

/// One row of Y.
fn row([c, s]: [f64; 2]) -> RowSVector<f64, 5> {
    RowSVector::from([c * c, s * s, c * s, c, s])
}

/// Θ̂ = (Y'Y)⁻¹ Y' 1, by singular value decomposition instead of the normal equations.
///
/// # Errors
/// Fewer than five samples, or samples that do not determine an ellipse (standstill, a straight line).
pub fn fit(samples: &[[f64; 2]]) -> Result<Conic, ReferenceError> {
    const UNDETERMINED: ReferenceError = ReferenceError::Data(
        "the samples do not determine an ellipse: more of the period must be travelled",
    );
    if samples.len() < 5 {
        return Err(ReferenceError::Data(
            "an ellipse takes at least five samples",
        ));
    }
    // A common scale, so that squares and signals weigh alike.
    let scale = samples
        .iter()
        .flatten()
        .fold(0.0f64, |largest, y| largest.max(y.abs()));
    if !(scale.is_finite() && scale > 0.0) {
        return Err(UNDETERMINED);
    }
    let rows: Vec<_> = samples.iter().map(|y| row(y.map(|v| v / scale))).collect();
    let y = MatrixXx5::from_rows(&rows);
    let ones = nalgebra::DVector::from_element(samples.len(), 1.0);
    let svd = y.svd(true, true);
    let largest = svd.singular_values.max();
    if svd.singular_values.min() < 1e-10 * largest {
        return Err(UNDETERMINED);
    }
    let theta = svd.solve(&ones, 0.0).map_err(|_| UNDETERMINED)?;
    let back = [scale * scale, scale * scale, scale * scale, scale, scale];
    Ok(Conic::from_fn(|i, _| theta[i] / back[i]))
}

/// Equation (5): the conic of a sensor.
///
/// # Errors
/// K = 0: the ellipse passes through the origin and has no form "= 1".
pub fn conic(sensor: &Sensor) -> Result<Conic, ReferenceError> {
    let Sensor {
        a_c,
        b_c,
        a_s,
        b_s,
        beta,
    } = *sensor;
    let (g_c, g_s) = (1.0 / a_c, 1.0 / a_s);
    let (sin, cos2) = (beta.sin(), beta.cos().powi(2));
    let k = 1.0
        - (g_c * g_c * b_c * b_c + g_s * g_s * b_s * b_s + 2.0 * g_c * b_c * g_s * b_s * sin)
            / cos2;
    if k == 0.0 {
        return Err(ReferenceError::Data(
            "the ellipse passes through the origin, where the form \"= 1\" is singular",
        ));
    }
    let over = k * cos2;
    Ok(Conic::from([
        g_c * g_c / over,
        g_s * g_s / over,
        2.0 * g_c * g_s * sin / over,
        -2.0 * g_c / over * (g_c * b_c + g_s * b_s * sin),
        -2.0 * g_s / over * (g_s * b_s + g_c * b_c * sin),
    ]))
}

/// The "set of non-linear equations" (5) solved in closed form: sin β = sign(θ1) θ3 / (2 √(θ1 θ2)), the offsets are the
/// centre of the conic, and the amplitudes follow from its size.
///
/// # Errors
/// The conic is no ellipse, or an imaginary one.
pub fn sensor(conic: &Conic) -> Result<Sensor, ReferenceError> {
    const NO_ELLIPSE: ReferenceError = ReferenceError::Data("the fitted conic is not an ellipse");
    let [t1, t2, t3, t4, t5]: [f64; 5] = (*conic).into();
    let sin = t1.signum() * t3 / (2.0 * (t1 * t2).sqrt());
    // sin β is NaN where θ1 θ2 < 0.
    if sin.is_nan() || sin.abs() >= 1.0 {
        return Err(NO_ELLIPSE);
    }
    let beta = sin.asin();
    let quadratic = Matrix2::new(t1, t3 / 2.0, t3 / 2.0, t2);
    let linear = Vector2::new(t4, t5);
    let centre = quadratic.lu().solve(&(linear * -0.5)).ok_or(NO_ELLIPSE)?;
    // About the centre u'Au = 1 + centre'A centre = 1/K.
    let size = 1.0 + centre.dot(&(quadratic * centre));
    let amplitude = |t: f64| (size / t).sqrt() / beta.cos();
    let sensor = Sensor {
        a_c: amplitude(t1),
        b_c: centre.x,
        a_s: amplitude(t2),
        b_s: centre.y,
        beta,
    };
    sensor.check().map_err(|_| NO_ELLIPSE)?;
    Ok(sensor)
}

/// Fit and inversion together.
///
/// # Errors
/// As [`fit`] and [`sensor`].
pub fn calibrate(samples: &[[f64; 2]]) -> Result<Sensor, ReferenceError> {
    sensor(&fit(samples)?)
}
