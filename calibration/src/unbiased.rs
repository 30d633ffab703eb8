//! The geometric fit less its curvature bias.
//!
//! Every sample is projected on the curve along the metric of the noise; Gauss–Newton makes the signed distances
//! small. Noise makes a curved line look larger: a distance has the mean κσ²/2, which is taken off in every step. What
//! is left of the bias is below a tenth of a standard error, where the plain fit has about one and the algebraic one six
//! at 5 % noise and 4000 samples.

use nalgebra::{SMatrix, Vector2};
use nonius_recording::Ellipse;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::curve::{Curve, Parameters, invert};
use crate::noise::{self, Residual};
use crate::shape::{Shape, take_shape};
use crate::together::{Together, together};

/// A fit with what it says about the noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// The curve.
    pub ellipse: Ellipse,
    /// Covariance of the parameters, from the Fisher information of the arcs that were seen. All of the residual counts
    /// as noise.
    pub covariance: SMatrix<f64, 5, 5>,
    /// White noise of the cosine and sine channel, rms, in the unit of the signals; what repeats with the angle is not
    /// in it.
    pub noise: [f64; 2],
    /// Standard error of ln(σ_s/σ_c); 0 where the ratio was given.
    pub log_ratio_error: f64,
    /// The ratio could not be told and equal noise was taken.
    pub ratio_assumed: bool,
    /// The ratio was estimated, and lies beyond those whose estimate was tested.
    pub ratio_extreme: bool,
    /// What repeats with the angle and is no ellipse.
    pub shape: Option<Shape>,
    /// How much further consecutive parts of the recording differ than the standard errors say, for the parameter where
    /// that is worst; 1 is what white noise does.
    pub scatter: Option<f64>,
    /// White noise does not do that.
    pub changes: bool,
    /// Noise that both channels have together, where there is such.
    pub together: Option<Together>,
    /// The iteration has come to rest.
    pub converged: bool,
}

impl Fit {
    /// The noise of cosine and sine channel in fractions of their amplitudes.
    pub(crate) fn relative_noise(&self) -> [f64; 2] {
        relative(self.noise, &self.ellipse)
    }
}

fn relative([c, s]: [f64; 2], ellipse: &Ellipse) -> [f64; 2] {
    [c / ellipse.a_c, s / ellipse.a_s]
}

const ITERATIONS: usize = 80;
/// Standard error of ln(σ_s/σ_c) beyond which the samples do not tell the ratio.
const VAGUE: f64 = 0.35;
/// Consecutive parts of a recording, to see whether their differences are noise.
const PARTS: usize = 20;
/// Scatter of the parts, in standard errors, that is worth a word.
const SCATTER: f64 = 1.8;
/// Probability below which a parameter's scatter is not noise; there are five.
const CHANCE: f64 = 1e-4;
/// Samples in a part that make its share of the score nearly Gaussian.
const PART: usize = 20;

/// Fits from `start`. `ratio` is σ_s/σ_c; `None` estimates it.
#[must_use]
pub fn fit(cos: &[f64], sin: &[f64], start: &Ellipse, ratio: Option<f64>) -> Fit {
    let pairs: Vec<Vector2<f64>> = cos
        .iter()
        .zip(sin)
        .map(|(c, s)| Vector2::new(*c, *s))
        .collect();
    let mut feet: Vec<f64> = pairs
        .iter()
        .map(|y| start.angle(y.x, y.y) * std::f64::consts::TAU)
        .collect();
    let mut ellipse = *start;
    let mut metric = ratio.unwrap_or(1.0);
    let mut searching = ratio.is_none();
    let (mut ratio_assumed, mut converged) = (false, false);
    let mut round = Round::of(&pairs, &mut feet, &ellipse, metric);
    for iteration in 0..ITERATIONS {
        let Some(step) = round.step(&ellipse) else {
            break;
        };
        let size = step.component_div(&ellipse.units()).amax();
        let next = Ellipse::of(&(ellipse.parameters() + step * (0.3 / size).min(1.0)));
        if !next.is_sound() {
            break;
        }
        ellipse = next;
        // Far below the bias that is left.
        let settled = size < 1e-9;
        if searching && (settled || size < 1e-4 || iteration % 8 == 7) {
            let last = metric;
            (metric, ratio_assumed) = round.ratio(metric, ellipse.a_s / ellipse.a_c);
            searching = (metric / last).ln().abs() > 3e-4 && iteration < ITERATIONS / 2;
        } else if settled {
            converged = true;
            break;
        }
        round = Round::of(&pairs, &mut feet, &ellipse, metric);
    }
    let mut residuals = round.residuals.clone();
    let shape = take_shape(&mut residuals);
    let white = residuals.iter().map(|r| r.white * r.white).sum::<f64>();
    let white = (white / (pairs.len() as f64 - 5.0).max(1.0)).sqrt();
    let found = noise::variances(&residuals, metric, ellipse.a_s / ellipse.a_c);
    let noise = match found {
        // Of a given ratio the size alone is measured.
        Some(found) if ratio.is_none() && !ratio_assumed => [found.cos.sqrt(), found.sin.sqrt()],
        _ => [white, white * metric],
    };
    let [c, s] = relative(noise, &ellipse);
    let covariance = round.covariance(&ellipse);
    let scatter = covariance.and_then(|c| round.scatter(&residuals, &c));
    Fit {
        scatter: scatter.map(|(factor, _)| factor),
        changes: scatter.is_some_and(|(_, changes)| changes),
        covariance: covariance.unwrap_or_else(|| SMatrix::repeat(f64::NAN)),
        noise,
        log_ratio_error: match (ratio, found) {
            (Some(_), _) => 0.0,
            (None, Some(found)) => found.log_ratio_error,
            (None, None) => f64::INFINITY,
        },
        ratio_assumed,
        ratio_extreme: ratio.is_none() && !ratio_assumed && (s / c).ln().abs() > noise::TESTED.ln(),
        shape: shape.map(|(rms, order)| Shape {
            rms: rms * (1.0 + metric) / 2.0 / ellipse.amplitude(),
            order,
        }),
        together: together(&residuals),
        ellipse,
        converged,
    }
}

/// Sums of one pass over the samples, in units of the cosine channel's noise.
struct Round {
    information: SMatrix<f64, 5, 5>,
    score: Parameters,
    curved: Parameters,
    sigma2: f64,
    residuals: Vec<Residual>,
    /// How far the curve moves across itself with each parameter, sample by sample.
    by: Vec<Parameters>,
}

impl Round {
    /// `feet` are the angles of the nearest points, from the last pass to this one.
    fn of(pairs: &[Vector2<f64>], feet: &mut [f64], ellipse: &Ellipse, ratio: f64) -> Self {
        let mut this = Self {
            information: SMatrix::zeros(),
            score: Parameters::zeros(),
            curved: Parameters::zeros(),
            sigma2: 0.0,
            residuals: Vec::with_capacity(pairs.len()),
            by: Vec::with_capacity(pairs.len()),
        };
        let mut sum = 0.0;
        let mut half_curvatures = Vec::with_capacity(pairs.len());
        for (y, foot) in pairs.iter().zip(feet) {
            let near = Projection::of(ellipse, *y, ratio, *foot);
            *foot = near.alpha;
            let by = near.by;
            this.information.syger(1.0, &by, &by, 1.0);
            this.score += by * near.distance;
            this.curved += by * near.half_curvature;
            this.by.push(by);
            sum += near.distance * near.distance;
            half_curvatures.push(near.half_curvature);
            this.residuals.push(Residual {
                alpha: near.alpha,
                white: near.distance,
                cos_share: near.cos_share,
                white_cos: near.white_cos,
                by_both: near.by_both,
            });
        }
        this.information.fill_upper_triangle_with_lower_triangle();
        this.sigma2 = sum / (pairs.len() as f64 - 5.0).max(1.0);
        for (r, half) in this.residuals.iter_mut().zip(half_curvatures) {
            r.white -= half * this.sigma2;
        }
        this
    }

    fn step(&self, ellipse: &Ellipse) -> Option<Parameters> {
        let step = invert(&self.information, ellipse)? * (self.score - self.curved * self.sigma2);
        step.iter().all(|v| v.is_finite()).then_some(step)
    }

    fn covariance(&self, ellipse: &Ellipse) -> Option<SMatrix<f64, 5, 5>> {
        invert(&self.information, ellipse).map(|inverse| inverse * self.sigma2)
    }

    /// σ_s/σ_c from the residuals, and whether it had to be assumed.
    fn ratio(&self, now: f64, gain: f64) -> (f64, bool) {
        let mut residuals = self.residuals.clone();
        let _ = take_shape(&mut residuals);
        match noise::variances(&residuals, now, gain) {
            Some(found) if found.log_ratio_told < VAGUE => ((found.sin / found.cos).sqrt(), false),
            _ => (1.0, true),
        }
    }

    /// How the scores of the recording's parts scatter, beside what white noise of that size does, and whether noise
    /// scatters that far. `residuals` are those without what repeats with the angle: within less than a turn that would
    /// look like a change in time.
    fn scatter(
        &self,
        residuals: &[Residual],
        covariance: &SMatrix<f64, 5, 5>,
    ) -> Option<(f64, bool)> {
        let n = residuals.len();
        let white = residuals.iter().map(|r| r.white * r.white).sum::<f64>() / n as f64;
        if n < PARTS * PART || white <= 0.0 {
            return None;
        }
        let inverse = covariance / self.sigma2;
        // Parts that tell equally much, not equally long ones: of a long standstill all but a few would tell nothing,
        // and the mean of those few would be taken for that of all.
        let told = |by: &Parameters| by.dot(&(inverse * by));
        let all: f64 = self.by.iter().map(told).sum();
        let mut parts = [(Parameters::zeros(), SMatrix::<f64, 5, 5>::zeros()); PARTS];
        let mut sum = 0.0;
        for (r, by) in residuals.iter().zip(&self.by) {
            let part = &mut parts[((sum / all * PARTS as f64) as usize).min(PARTS - 1)];
            part.0 += by * r.white;
            part.1 += by * by.transpose();
            sum += told(by);
        }
        let mut worst = (false, 0.0);
        for i in 0..5 {
            let (mut square, mut mean, mut spread) = (0.0, 0.0, 0.0);
            for (score, information) in &parts {
                square += (inverse * score)[i].powi(2) / white;
                let own = (inverse * information * inverse)[(i, i)];
                mean += own;
                spread += own * own;
            }
            // A sum of squares of unequal sizes is nearly chi square with this freedom.
            let freedom = mean * mean / spread;
            let p = ChiSquared::new(freedom).ok()?.sf(square / mean * freedom);
            let one = (p < CHANCE, (square / mean).sqrt());
            if one > worst {
                worst = one;
            }
        }
        let (changes, factor) = worst;
        Some((factor, changes && factor > SCATTER))
    }
}

/// A sample seen from its nearest point, in the metric of the noise.
struct Projection {
    alpha: f64,
    /// Signed distance, positive outside.
    distance: f64,
    /// How far the curve moves across itself with each parameter.
    by: Parameters,
    half_curvature: f64,
    /// n_c² of the normal in the plane of the signals.
    cos_share: f64,
    /// n_c² of the normal in the metric, and 2 n_c n_s.
    white_cos: f64,
    by_both: f64,
}

impl Projection {
    fn of(ellipse: &Ellipse, y: Vector2<f64>, ratio: f64, from: f64) -> Self {
        let alpha = ellipse.nearest(y, Vector2::new(1.0, 1.0 / (ratio * ratio)), from);
        let white = |v: Vector2<f64>| Vector2::new(v.x, v.y / ratio);
        let along = white(ellipse.tangent(alpha));
        let speed = along.norm();
        // Outwards: the tangent turned to the right.
        let normal = Vector2::new(along.y, -along.x) / speed;
        let bend = white(ellipse.bend(alpha));
        let plain = Vector2::new(normal.x, normal.y / ratio);
        Self {
            alpha,
            distance: normal.dot(&white(y - ellipse.point(alpha))),
            by: Parameters::from(ellipse.by_parameters(alpha).map(|v| normal.dot(&white(v)))),
            half_curvature: along.perp(&bend) / (2.0 * speed.powi(3)),
            cos_share: plain.x * plain.x / plain.norm_squared(),
            white_cos: normal.x * normal.x,
            by_both: 2.0 * normal.x * normal.y,
        }
    }
}
