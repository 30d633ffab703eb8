//! The geometric fit less its curvature bias.
//!
//! Every sample is projected on the curve along the metric of the noise; Gauss–Newton makes the signed distances
//! small. Noise makes a curved line look larger: a distance has the mean κσ²/2, which is taken off in every step. What
//! is left of the bias is below a tenth of a standard error, where the plain fit has 1.3 and the algebraic one 6 at
//! 5 % noise and 4000 samples.

use nalgebra::{SMatrix, Vector2};

use crate::ellipse::{Ellipse, Parameters};

/// A fit with what it says about the noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The curve.
    pub ellipse: Ellipse,
    /// Covariance of the parameters.
    pub covariance: SMatrix<f64, 5, 5>,
    /// Noise of the cosine and sine channel, rms, in the unit of the signals.
    pub noise: [f64; 2],
    /// Smallest over largest eigenvalue of the information, each parameter in its own unit of amplitude.
    pub condition: f64,
    /// The direction that the data tell least about, in the same units.
    pub weakest: Parameters,
    /// The iteration has come to rest.
    pub converged: bool,
}

const ITERATIONS: usize = 60;

/// Fits from `start`. `ratio` is σ_s/σ_c; `None` estimates it.
#[must_use]
pub fn fit(cos: &[f64], sin: &[f64], start: &Ellipse, ratio: Option<f64>) -> Fit {
    let mut ellipse = *start;
    let mut ratio_now = ratio.unwrap_or(1.0);
    let mut round = Round::default();
    let mut converged = false;
    let mut searching = ratio.is_none();
    for iteration in 0..ITERATIONS {
        round = Round::of(cos, sin, &ellipse, ratio_now);
        let Some(step) = round.step() else { break };
        let unit = units(&ellipse);
        let size = step.component_div(&unit).amax();
        let damp = (0.3 / size).min(1.0);
        let next = Ellipse::of(&(ellipse.parameters() + step * damp));
        if !next.is_sound() {
            break;
        }
        ellipse = next;
        let settled = size < 1e-10;
        if searching && (iteration % 3 == 2 || settled) {
            let found = round.ratio(ratio_now);
            // Far below what the samples can tell of it: from here on it stands still.
            searching = (found / ratio_now).ln().abs() > 1e-3 && iteration < ITERATIONS / 2;
            ratio_now = found;
            continue;
        }
        if settled {
            converged = true;
            break;
        }
    }
    let sigma = round.sigma2.sqrt();
    let information = round.information;
    let covariance = information.try_inverse().map_or_else(
        || SMatrix::repeat(f64::NAN),
        |inverse| inverse * round.sigma2,
    );
    let unit = SMatrix::<f64, 5, 5>::from_diagonal(&units(&ellipse));
    let eigen = (unit * information * unit).symmetric_eigen();
    let (low, high) = (eigen.eigenvalues.imin(), eigen.eigenvalues.imax());
    Fit {
        ellipse,
        covariance,
        noise: [sigma, sigma * ratio_now],
        condition: eigen.eigenvalues[low] / eigen.eigenvalues[high],
        weakest: eigen.eigenvectors.column(low).into(),
        converged,
    }
}

/// Amplitudes for lengths, a radian for β.
pub(crate) fn units(ellipse: &Ellipse) -> Parameters {
    let a = ellipse.amplitude();
    Parameters::new(a, a, a, a, 1.0)
}

/// Sums of one pass over the samples, in units of the cosine channel's noise.
struct Round {
    information: SMatrix<f64, 5, 5>,
    score: Parameters,
    curved: Parameters,
    sigma2: f64,
    /// Regression of squared residuals on the normal's direction.
    squares: [f64; 5],
}

impl Default for Round {
    fn default() -> Self {
        Self {
            information: SMatrix::zeros(),
            score: Parameters::zeros(),
            curved: Parameters::zeros(),
            sigma2: 0.0,
            squares: [0.0; 5],
        }
    }
}

/// The signed distance of a sample in the metric of the noise, its derivatives, half the curvature, and the squared
/// components of the normal in the plane of the signals.
pub(crate) fn distance(
    ellipse: &Ellipse,
    y: Vector2<f64>,
    ratio: f64,
) -> (f64, Parameters, f64, [f64; 2]) {
    let weight = Vector2::new(1.0, 1.0 / (ratio * ratio));
    let alpha = ellipse.nearest(y, weight);
    let miss = y - ellipse.point(alpha);
    let white = |v: Vector2<f64>| Vector2::new(v.x, v.y / ratio);
    let along = white(ellipse.tangent(alpha));
    let speed = along.norm();
    // Outwards: the tangent turned to the right.
    let normal = Vector2::new(along.y, -along.x) / speed;
    let (sin, _) = (alpha - ellipse.beta).sin_cos();
    let bend = white(Vector2::new(-ellipse.a_c * alpha.cos(), -ellipse.a_s * sin));
    let curvature = (along.x * bend.y - along.y * bend.x) / speed.powi(3);
    let by = ellipse.by_parameters(alpha).map(|v| normal.dot(&white(v)));
    let plain = Vector2::new(normal.x, normal.y / ratio);
    let length2 = plain.norm_squared();
    (
        normal.dot(&white(miss)),
        Parameters::from(by),
        curvature / 2.0,
        [plain.x * plain.x / length2, plain.y * plain.y / length2],
    )
}

impl Round {
    fn of(cos: &[f64], sin: &[f64], ellipse: &Ellipse, ratio: f64) -> Self {
        let mut this = Self::default();
        let mut sum = 0.0;
        for (c, s) in cos.iter().zip(sin) {
            let (d, by, half_curvature, [nx, ny]) = distance(ellipse, Vector2::new(*c, *s), ratio);
            this.information += by * by.transpose();
            this.score += by * d;
            this.curved += by * half_curvature;
            sum += d * d;
            // A residual along the plain normal: d² (nx + ratio² ny) = σ_c² nx + σ_s² ny.
            let plain = d * d * (nx + ratio * ratio * ny);
            this.squares[0] += nx * nx;
            this.squares[1] += nx * ny;
            this.squares[2] += ny * ny;
            this.squares[3] += nx * plain;
            this.squares[4] += ny * plain;
        }
        this.sigma2 = sum / (cos.len() as f64 - 5.0).max(1.0);
        this
    }

    fn step(&self) -> Option<Parameters> {
        let inverse = self.information.try_inverse()?;
        let step = inverse * (self.score - self.curved * self.sigma2);
        step.iter().all(|v| v.is_finite()).then_some(step)
    }

    /// σ_s/σ_c from the squared residuals; `now` where they do not tell.
    fn ratio(&self, now: f64) -> f64 {
        let [xx, xy, yy, xd, yd] = self.squares;
        let determinant = xx * yy - xy * xy;
        let cos = (xd * yy - yd * xy) / determinant;
        let sin = (yd * xx - xd * xy) / determinant;
        let ratio2 = sin / cos;
        if ratio2.is_finite() && (1e-4..=1e4).contains(&ratio2) {
            ratio2.sqrt()
        } else {
            now
        }
    }
}
