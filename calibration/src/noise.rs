//! What the residuals say of the noise of each channel.
//!
//! Across the curve a sample strays by n·ε, whose variance n_c² σ_c² + n_s² σ_s² swings with the angle: residual²
//! against angle tells the ratio of the channels' noise. A distortion of the signals is taken out first ([`crate::shape`]).

use nalgebra::{SMatrix, SVector};

use crate::shape::OWN;

/// Beyond this ratio, each in fractions of its amplitude, one channel's noise is as good as none; the estimate ends here.
const EXTREME: f64 = 10.0;
/// Up to this ratio the estimates were tested: beyond it they are pressed against [`EXTREME`], and nothing says how far off
/// they are.
pub(crate) const TESTED: f64 = 8.0;

/// A sample's residual.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Residual {
    /// Angle in radians.
    pub(crate) alpha: f64,
    /// Signed distance across the curve in the metric of the noise, its mean by curvature taken off.
    pub(crate) white: f64,
    /// n_c² of the plain normal; n_s² is the rest.
    pub(crate) cos_share: f64,
    /// n_c² of the normal in the metric of the noise; n_s² is the rest.
    pub(crate) white_cos: f64,
    /// 2 n_c n_s of the same: how the square grows with the correlation of the channels' noise.
    pub(crate) by_both: f64,
}

/// The white noise of both channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variances {
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    /// Standard error of ln(σ_s/σ_c), with the tails that the noise has.
    pub(crate) log_ratio_error: f64,
    /// The same if the noise is Gaussian: what the angles tell.
    pub(crate) log_ratio_told: f64,
}

/// Lag-one correlation beyond which residuals are not white.
const CORRELATED: f64 = 0.1;

/// Whether residuals resemble their neighbours.
pub(crate) fn is_coloured(residuals: &[Residual]) -> bool {
    correlation(residuals) >= CORRELATED + 4.0 / (residuals.len() as f64).sqrt()
}

/// A squared value and how it grows with σ_c² and σ_s².
struct Square {
    value: f64,
    by_cos: f64,
    by_sin: f64,
}

/// The variances of both channels in units of the metric's σ_c²; the metric has σ_s = `ratio` σ_c,
/// the signals a_s = `gain` a_c. Residuals that
/// resemble their neighbours hold drift as well; the noise then is what second differences show.
pub(crate) fn variances(residuals: &[Residual], ratio: f64, gain: f64) -> Option<Variances> {
    let (square, gain2) = (ratio * ratio, gain * gain);
    let plain = |r: &Residual| {
        let (cos, sin) = (r.cos_share, 1.0 - r.cos_share);
        // In the metric the normal has length one.
        let length = cos + square * sin;
        Square {
            value: r.white * r.white,
            by_cos: cos / length,
            by_sin: sin / length,
        }
    };
    let n = residuals.len() as f64;
    let squares: Vec<Square> = residuals.iter().map(plain).collect();
    if !is_coloured(residuals) {
        return scoring(&squares, square, gain2, n / (n - OWN as f64).max(1.0), 1.0);
    }
    let middle = residuals.windows(3).zip(squares.windows(3));
    let second: Vec<Square> = middle
        .map(|(r, own)| Square {
            value: (r[1].white - (r[0].white + r[2].white) / 2.0).powi(2),
            by_cos: own[1].by_cos + (own[0].by_cos + own[2].by_cos) / 4.0,
            by_sin: own[1].by_sin + (own[0].by_sin + own[2].by_sin) / 4.0,
        })
        .collect();
    // Neighbouring second differences correlate by −2/3 and 1/6: their squares tell less than independent ones.
    let inflation = 1.0 + 2.0 * (4.0 / 9.0 + 1.0 / 36.0);
    scoring(&second, square, gain2, 1.0, inflation)
}

/// Lag-one correlation.
fn correlation(residuals: &[Residual]) -> f64 {
    let products = residuals.windows(2).map(|w| w[0].white * w[1].white);
    let squares: f64 = residuals.iter().map(|r| r.white * r.white).sum();
    products.sum::<f64>() / squares.max(f64::MIN_POSITIVE)
}

/// Scoring of the Gaussian likelihood from σ_s²/σ_c² = `start`; `gain2` is (a_s/a_c)². `scale` makes up for what a fit took, `inflation` for correlated squares.
fn scoring(
    squares: &[Square],
    start: f64,
    gain2: f64,
    scale: f64,
    inflation: f64,
) -> Option<Variances> {
    let values: f64 = squares.iter().map(|s| s.value).sum::<f64>() * scale;
    let sizes: f64 = squares.iter().map(|s| s.by_cos + s.by_sin * start).sum();
    let mean = values / sizes;
    if mean.is_nan() || mean <= 0.0 {
        return None;
    }
    let (mut cos, mut sin) = (mean, mean * start);
    let mut covariance = [0.0; 3];
    for _ in 0..8 {
        let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
        let mut sum = [0.0; 2];
        for s in squares {
            let v = s.by_cos * cos + s.by_sin * sin;
            let weight = 1.0 / (v * v);
            aa += weight * s.by_cos * s.by_cos;
            ab += weight * s.by_cos * s.by_sin;
            bb += weight * s.by_sin * s.by_sin;
            sum[0] += weight * s.by_cos * s.value * scale;
            sum[1] += weight * s.by_sin * s.value * scale;
        }
        let determinant = aa * bb - ab * ab;
        if determinant.is_nan() || determinant <= 1e-12 * aa * bb {
            return None;
        }
        // Twice the inverse information.
        covariance = [bb, -ab, aa].map(|v| 2.0 * inflation * v / determinant);
        let next = [
            (sum[0] * bb - sum[1] * ab) / determinant,
            (sum[1] * aa - sum[0] * ab) / determinant,
        ];
        let least = next[0].max(next[1] / gain2) / (EXTREME * EXTREME);
        let next = [next[0].max(least), next[1].max(least * gain2)];
        let still = (next[0] / cos - 1.0).abs() + (next[1] / sin - 1.0).abs() < 1e-6;
        [cos, sin] = next;
        if !(cos > 0.0 && sin > 0.0) {
            return None;
        }
        if still {
            break;
        }
    }
    let of_log =
        |[cc, cs, ss]: [f64; 3]| cc / (cos * cos) - 2.0 * cs / (cos * sin) + ss / (sin * sin);
    // What is Gaussian scatters as the information says; with longer tails its squares scatter by more.
    let scattered = scatter(squares, scale, [cos, sin])?.map(|v| inflation * v);
    let error = |log: f64| (log / 4.0).max(0.0).sqrt();
    let log_ratio_told = error(of_log(covariance));
    Some(Variances {
        cos,
        sin,
        log_ratio_error: log_ratio_told.max(error(of_log(scattered))),
        log_ratio_told,
    })
}

/// Covariance of both variances by how far the squares scatter about what they make of them.
fn scatter(squares: &[Square], scale: f64, [cos, sin]: [f64; 2]) -> Option<[f64; 3]> {
    let (mut bread, mut filling) = (SMatrix::<f64, 2, 2>::zeros(), SMatrix::<f64, 2, 2>::zeros());
    for s in squares {
        let by = SVector::<f64, 2>::new(s.by_cos, s.by_sin) / (s.by_cos * cos + s.by_sin * sin);
        let off = s.value * scale / (s.by_cos * cos + s.by_sin * sin) - 1.0;
        bread += by * by.transpose();
        filling += by * by.transpose() * (off * off);
    }
    let inverse = bread.try_inverse()?;
    let found = inverse * filling * inverse;
    Some([found[(0, 0)], found[(0, 1)], found[(1, 1)]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::take_shape;
    use rand::{SeedableRng, rngs::StdRng};
    use rand_distr::{Distribution, StandardNormal};

    /// Residuals across a unit circle, noise 1 and `ratio`, in the metric of equal noise; what `other` adds to them.
    fn circle(seed: u64, ratio: f64, other: impl Fn(usize, f64) -> f64) -> Vec<Residual> {
        let mut random = StdRng::seed_from_u64(seed);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let at = |k: usize| 13.0 * std::f64::consts::TAU * k as f64 / 4000.0;
        (0..4000)
            .map(|k| {
                let (sin, cos) = at(k).sin_cos();
                Residual {
                    alpha: at(k),
                    white: cos * draw() + sin * ratio * draw() + other(k, at(k)),
                    cos_share: cos * cos,
                    white_cos: cos * cos,
                    by_both: 2.0 * cos * sin,
                }
            })
            .collect()
    }

    fn ratio(residuals: &[Residual]) -> (f64, f64) {
        let found = variances(residuals, 1.0, 1.0).expect("there is one");
        ((found.sin / found.cos).sqrt(), found.log_ratio_error)
    }

    #[test]
    fn the_ratio_is_told_by_squared_residuals_within_its_error() {
        for truth in [0.5, 1.0, 1.7, 4.0] {
            let misses = (0..40).map(|seed| {
                let (found, error) = ratio(&circle(seed, truth, |_, _| 0.0));
                (found / truth).ln() / error
            });
            let misses: Vec<f64> = misses.collect();
            let square = misses.iter().map(|m| m * m).sum::<f64>() / 40.0;
            // Chi square with 40 degrees of freedom, 0.0005 on either side.
            assert!((0.42..1.95).contains(&square), "{truth}: {square}");
        }
    }

    #[test]
    fn drift_is_no_noise() {
        let drift = |k: usize, _: f64| 5.0 * (k as f64 * 0.003).sin();
        for truth in [1.0, 1.7] {
            let (found, error) = ratio(&circle(3, truth, drift));
            assert!((found / truth).ln().abs() < 4.0 * error, "{found}");
            assert!(error < 0.08, "{error}");
        }
    }

    #[test]
    fn a_distortion_is_found_measured_and_taken_out() {
        let mut residuals = circle(5, 1.0, |_, a| 3.0 * (4.0 * a).cos());
        let (rms, order) = take_shape(&mut residuals).expect("there is one");
        assert_eq!(order, 4);
        assert!((rms - 3.0 / 2f64.sqrt()).abs() < 0.1, "{rms}");
        assert!(ratio(&residuals).0.ln().abs() < 0.15);
    }

    /// 1 in 1000 by design: two hundred noises, less what an ellipse takes of them, show none.
    #[test]
    fn noise_has_no_shape() {
        let fitted = |seed: u64| {
            let mut residuals = circle(seed, 1.0, |_, _| 0.0);
            let shapes: [fn(f64) -> f64; 5] = [
                |_| 1.0,
                |a| 2f64.sqrt() * a.cos(),
                |a| 2f64.sqrt() * a.sin(),
                |a| 2f64.sqrt() * (2.0 * a).cos(),
                |a| 2f64.sqrt() * (2.0 * a).sin(),
            ];
            for shape in shapes {
                let sum: f64 = residuals.iter().map(|r| r.white * shape(r.alpha)).sum();
                let size = sum / residuals.len() as f64;
                residuals
                    .iter_mut()
                    .for_each(|r| r.white -= size * shape(r.alpha));
            }
            residuals
        };
        let found = (100..300).filter(|seed| take_shape(&mut fitted(*seed)).is_some());
        assert!(found.count() <= 2);
    }

    #[test]
    fn one_angle_does_not_tell_the_ratio() {
        let still: Vec<Residual> = circle(1, 2.0, |_, _| 0.0)
            .into_iter()
            .map(|r| Residual {
                cos_share: 0.5,
                ..r
            })
            .collect();
        assert_eq!(variances(&still, 1.0, 1.0), None);
    }
}
