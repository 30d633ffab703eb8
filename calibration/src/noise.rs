//! What the residuals say: the noise of each channel, and what is not noise.
//!
//! Across the curve a sample strays by n·ε, whose variance n_c² σ_c² + n_s² σ_s² swings with the angle: residual²
//! against angle tells the ratio of the channels' noise. A distortion of the signals swings with the angle too, but as
//! the residual itself, not as its square: it is taken out first, where it is there beyond doubt.

use nalgebra::{SMatrix, SVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Highest order of the radius that is looked for.
const ORDERS: usize = 8;
const COLUMNS: usize = 2 * ORDERS + 1;
/// Orders 0 to 2 hold five shapes that the ellipse itself has taken.
const OWN: usize = 5;
/// Probability below which a shape is not noise.
const SIGNIFICANT: f64 = 1e-3;
/// Samples per shape that are needed to look for shapes.
const SAMPLES: usize = 8 * COLUMNS;
/// Beyond this ratio one channel's noise is as good as none.
const EXTREME: f64 = 10.0;

/// A sample's residual.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Residual {
    /// Angle in radians.
    pub(crate) alpha: f64,
    /// Signed distance across the curve in the metric of the noise, its mean by curvature taken off.
    pub(crate) white: f64,
    /// n_c² of the plain normal; n_s² is the rest.
    pub(crate) cos_share: f64,
}

/// What repeats with the angle and is no ellipse.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Its rms, in fractions of the mean amplitude.
    pub rms: f64,
    /// The order of the radius that is largest, in cycles per scale period, 3 to 8.
    pub order: usize,
}

/// The white noise of both channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variances {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    /// Standard error of ln(σ_s/σ_c).
    pub(crate) log_ratio_error: f64,
}

/// What repeats with the angle: taken out of `residuals` where it is significant. Gives its rms in units of the cosine
/// channel's noise, and the order.
pub(crate) fn take_shape(residuals: &mut [Residual]) -> Option<(f64, usize)> {
    let n = residuals.len();
    if n < SAMPLES {
        return None;
    }
    let row = |alpha: f64| {
        let mut row = SVector::<f64, COLUMNS>::zeros();
        row[0] = 1.0;
        for m in 1..=ORDERS {
            let (sin, cos) = (m as f64 * alpha).sin_cos();
            (row[2 * m - 1], row[2 * m]) = (cos, sin);
        }
        row
    };
    let mut gram = SMatrix::<f64, COLUMNS, COLUMNS>::zeros();
    let mut sum = SVector::<f64, COLUMNS>::zeros();
    let mut before = 0.0;
    for r in residuals.iter() {
        let row = row(r.alpha);
        gram.syger(1.0, &row, &row, 1.0);
        sum += row * r.white;
        before += r.white * r.white;
    }
    gram.fill_upper_triangle_with_lower_triangle();
    // Angles that leave an arc empty make the shapes depend on each other: then nothing is said.
    let eigen = gram.symmetric_eigenvalues();
    if eigen.min() < 1e-3 * eigen.max() {
        return None;
    }
    let found = gram.cholesky()?.solve(&sum);
    let explained = found.dot(&sum);
    let after = before - explained;
    let [shapes, free] = [COLUMNS - OWN, n - COLUMNS].map(|v| v as f64);
    let f = (explained / shapes) / (after / free);
    let p = FisherSnedecor::new(shapes, free).ok()?.sf(f.max(0.0));
    // Residuals of rounding alone are no shape.
    if p.is_nan() || p >= SIGNIFICANT || after <= 0.0 {
        return None;
    }
    for r in residuals.iter_mut() {
        r.white -= row(r.alpha).dot(&found);
    }
    let size = |m: &usize| f64::hypot(found[2 * m - 1], found[2 * m]);
    let order = (3..=ORDERS).max_by(|a, b| size(a).total_cmp(&size(b)))?;
    // Noise explains a little too.
    let own = (explained - shapes * after / free).max(0.0);
    Some(((own / n as f64).sqrt(), order))
}

/// The variances of both channels in units of the metric's, by scoring of the Gaussian likelihood: the metric has
/// σ_s = `ratio` σ_c.
pub(crate) fn variances(residuals: &[Residual], ratio: f64) -> Option<Variances> {
    let n = residuals.len() as f64;
    let square = ratio * ratio;
    // Plain residual² in units of the metric's σ_c², with its share of each channel.
    let plain = |r: &Residual| {
        let share = [r.cos_share, 1.0 - r.cos_share];
        (share, r.white * r.white * (share[0] + square * share[1]))
    };
    let scale = n / (n - OWN as f64).max(1.0);
    let mean = scale * residuals.iter().map(|r| r.white * r.white).sum::<f64>() / n;
    if mean.is_nan() || mean <= 0.0 {
        return None;
    }
    let (mut cos, mut sin) = (mean, mean * square);
    let mut determinant = 0.0;
    let mut information = [0.0; 3];
    for _ in 0..8 {
        information = [0.0; 3];
        let mut sum = [0.0; 2];
        for r in residuals {
            let (share, plain) = plain(r);
            let v = share[0] * cos + share[1] * sin;
            let weight = 1.0 / (v * v);
            information[0] += weight * share[0] * share[0];
            information[1] += weight * share[0] * share[1];
            information[2] += weight * share[1] * share[1];
            sum[0] += weight * share[0] * plain * scale;
            sum[1] += weight * share[1] * plain * scale;
        }
        let [aa, ab, bb] = information;
        determinant = aa * bb - ab * ab;
        if determinant.is_nan() || determinant <= 1e-12 * aa * bb {
            return None;
        }
        let least = mean / (EXTREME * EXTREME);
        let next = [
            (sum[0] * bb - sum[1] * ab) / determinant,
            (sum[1] * aa - sum[0] * ab) / determinant,
        ]
        .map(|v| v.max(least));
        let still = (next[0] / cos - 1.0).abs() + (next[1] / sin - 1.0).abs() < 1e-6;
        [cos, sin] = next;
        if still {
            break;
        }
    }
    // Twice the inverse information is the covariance of the variances.
    let [aa, ab, bb] = information;
    let [cc, cs, ss] = [bb, -ab, aa].map(|v| 2.0 * v / determinant);
    let log = cc / (cos * cos) - 2.0 * cs / (cos * sin) + ss / (sin * sin);
    Some(Variances {
        cos,
        sin,
        log_ratio_error: (log / 4.0).max(0.0).sqrt(),
    })
}
