//! The searches of sections 5.2 to 5.4, off line: the Θ that makes J = Σ (‖MΘ‖² − 1)² smallest.
//!
//! The paper goes down the gradient; what counts is where it ends, and Levenberg–Marquardt gets there sooner. It works
//! on signals normalised by an ellipse, where all columns of M are of one size; J does not mind.
//!
//! With the cubic sets one direction of Θ changes no radius: [`BLIND`](crate::set::BLIND). The search stays where it starts along it, at
//! straight channels.

use nalgebra::{DMatrix, DVector, SVector};
use nonius_recording::Ellipse;

use crate::curve::Curve;
use crate::sandwich::Sandwich;
use crate::set::Set;

/// Eigenvalues below this share of the largest are a direction that these samples do not show.
pub(crate) const FAINT: f64 = 1e-9;
const ITERATIONS: usize = 200;

/// A minimum of J.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Θ for the signals in their own unit.
    pub theta: Vec<f64>,
    /// Θ for signals normalised by [`frame`](Self::frame).
    pub(crate) normal: DVector<f64>,
    /// About which it was searched.
    pub(crate) frame: Ellipse,
    /// Its covariance; `None` where the samples do not determine it. The blind direction has none.
    pub covariance: Option<DMatrix<f64>>,
    /// The nearest parameters of equation (4): amplitude and mean of each channel's first harmonic over the period, and
    /// the phase. `None` where a polynomial cannot be inverted.
    pub ellipse: Option<Ellipse>,
    /// Their covariance.
    pub ellipse_covariance: Option<DMatrix<f64>>,
    /// Directions that these samples do not show, besides the blind one.
    pub faint: usize,
    /// The iteration has come to rest.
    pub converged: bool,
}

/// The minimum of J nearest to the ellipse `frame`, which also normalises the signals.
#[must_use]
pub fn minimise(set: Set, cos: &[f64], sin: &[f64], frame: &Ellipse) -> Minimum {
    let frame = set.frame(frame);
    let normal = |(c, s): (&f64, &f64)| ((c - frame.b_c) / frame.a_c, (s - frame.b_s) / frame.a_s);
    let pairs: Vec<(f64, f64)> = cos.iter().zip(sin).map(normal).collect();
    let search = Search {
        set,
        pairs,
        directions: set.directions(),
    };
    let (theta, faint, converged) = search.run(set.start(&frame));
    let inner = search.covariance(&theta);
    let to_raw = set.to_raw(&frame);
    let physical = physical(set, theta.as_slice());
    let size = sizes(&frame);
    let middle = [0.0, frame.b_c, 0.0, frame.b_s, 0.0];
    Minimum {
        theta: (&to_raw * &theta).as_slice().to_vec(),
        covariance: inner.as_ref().map(|c| &to_raw * c * to_raw.transpose()),
        ellipse: physical.map(|p| {
            Ellipse::of(&SVector::from_fn(|i, _| {
                p.parameters()[i] * size[i] + middle[i]
            }))
        }),
        ellipse_covariance: inner.and_then(|c| physical_covariance(set, &theta, &frame, &c)),
        faint,
        converged,
        normal: theta,
        frame,
    }
}

/// What normalising by `frame` divides a_c, b_c, a_s, b_s, β by.
fn sizes(frame: &Ellipse) -> [f64; 5] {
    [frame.a_c, frame.a_c, frame.a_s, frame.a_s, 1.0]
}

/// Covariance of the nearest a_c, b_c, a_s, b_s, β, by that of Θ of normalised signals.
pub(crate) fn physical_covariance(
    set: Set,
    theta: &DVector<f64>,
    frame: &Ellipse,
    of_theta: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let at = physical(set, theta.as_slice())?;
    let by = physical_slopes(set, theta, &at)?;
    let size = sizes(frame);
    let plain = &by * of_theta * by.transpose();
    Some(DMatrix::from_fn(5, 5, |i, j| {
        plain[(i, j)] * size[i] * size[j]
    }))
}

struct Search {
    set: Set,
    pairs: Vec<(f64, f64)>,
    directions: DMatrix<f64>,
}

impl Search {
    fn objective(&self, theta: &[f64]) -> f64 {
        let radius = |(c, s): &(f64, f64)| {
            let (x, y) = self.set.correct(theta, *c, *s);
            (x * x + y * y - 1.0).powi(2)
        };
        self.pairs.iter().map(radius).sum()
    }

    /// Levenberg–Marquardt. Gives Θ, the number of faint directions, and whether it came to rest.
    fn run(&self, mut theta: DVector<f64>) -> (DVector<f64>, usize, bool) {
        let n = self.set.parameters();
        let mut damping = 1e-6;
        let mut now = self.objective(theta.as_slice());
        let mut faint = 0;
        let mut slope = DVector::zeros(n);
        for _ in 0..ITERATIONS {
            let mut normal = DMatrix::<f64>::zeros(n, n);
            let mut score = DVector::<f64>::zeros(n);
            for (c, s) in &self.pairs {
                let (x, y) = self.set.correct(theta.as_slice(), *c, *s);
                self.set
                    .slope(theta.as_slice(), *c, *s, slope.as_mut_slice());
                normal.syger(1.0, &slope, &slope, 1.0);
                score.axpy(x * x + y * y - 1.0, &slope, 1.0);
            }
            normal.fill_upper_triangle_with_lower_triangle();
            let inner = self.directions.transpose() * normal * &self.directions;
            let score = self.directions.transpose() * score;
            let eigen = inner.symmetric_eigen();
            let largest = eigen.eigenvalues.amax();
            let mut step = DVector::<f64>::zeros(score.len());
            faint = 0;
            for (value, vector) in eigen
                .eigenvalues
                .iter()
                .zip(eigen.eigenvectors.column_iter())
            {
                if *value < FAINT * largest {
                    faint += 1;
                    continue;
                }
                step.axpy(
                    -vector.dot(&score) / (value + damping * largest),
                    &vector,
                    1.0,
                );
            }
            let step = &self.directions * step;
            let next = &theta + &step;
            let then = self.objective(next.as_slice());
            // Rounding makes J tremble at the minimum.
            if then.is_finite() && then <= now * (1.0 + 1e-12) + f64::MIN_POSITIVE {
                theta = next;
                now = then;
                damping = (damping / 10.0).max(1e-15);
                if step.amax() < 1e-10 {
                    return (theta, faint, true);
                }
            } else {
                damping *= 10.0;
                if step.amax() < 1e-10 {
                    return (theta, faint, true);
                }
                if damping > 1e6 {
                    break;
                }
            }
        }
        (theta, faint, false)
    }

    fn covariance(&self, theta: &DVector<f64>) -> Option<DMatrix<f64>> {
        let n = self.set.parameters();
        let mut sandwich = Sandwich::new(self.directions.ncols());
        let mut slope = DVector::zeros(n);
        for (c, s) in &self.pairs {
            let (x, y) = self.set.correct(theta.as_slice(), *c, *s);
            self.set
                .slope(theta.as_slice(), *c, *s, slope.as_mut_slice());
            let inner = self.directions.transpose() * &slope;
            sandwich.add(x * x + y * y - 1.0, inner.as_slice());
        }
        let inner = sandwich.covariance()?;
        Some(&self.directions * inner * self.directions.transpose())
    }
}

/// The ellipse nearest to the signals that Θ makes the unit circle, for normalised signals.
fn physical(set: Set, theta: &[f64]) -> Option<Ellipse> {
    let found = match set {
        Set::Four | Set::Five => Ellipse::of_theta(theta),
        Set::Eight | Set::Nine => {
            let tan = theta.get(8).copied().unwrap_or(0.0);
            // s = W + tan β · c = sin α, so W = sin(α − β) / cos β.
            let (a_c, b_c) = first_harmonic(&theta[..4], 1.0)?;
            let (a_s, b_s) = first_harmonic(&theta[4..8], tan.hypot(1.0))?;
            Ellipse {
                a_c,
                b_c,
                a_s,
                b_s,
                beta: tan.atan(),
            }
        }
    };
    found.is_sound().then_some(found)
}

fn physical_slopes(set: Set, theta: &DVector<f64>, at: &Ellipse) -> Option<DMatrix<f64>> {
    let mut by = DMatrix::zeros(5, set.parameters());
    let h = 1e-6;
    for i in 0..set.parameters() {
        let moved = |h: f64| {
            let mut theta = theta.clone();
            theta[i] += h;
            Some(physical(set, theta.as_slice())?.parameters() - at.parameters())
        };
        let slope = (moved(h)? - moved(-h)?) / (2.0 * h);
        by.column_mut(i).copy_from(&slope);
    }
    Some(by)
}

/// Amplitude and mean of the signal u over a period in which the cubic of it is `size` · cos. `None` where the cubic
/// does not rise all the way.
fn first_harmonic(cubic: &[f64], size: f64) -> Option<(f64, f64)> {
    const POINTS: u32 = 64;
    let (mut sum, mut first) = (0.0, 0.0);
    let mut u = 0.0;
    // Half a period: the other half is its mirror image.
    for k in 0..POINTS {
        let cos = ((f64::from(k) + 0.5) * std::f64::consts::PI / f64::from(POINTS)).cos();
        u = invert(cubic, size * cos, u)?;
        sum += u;
        first += u * cos;
    }
    let n = f64::from(POINTS);
    Some((2.0 * first / n, sum / n))
}

/// The u near `guess` that this cubic brings to `value`. `None` where the cubic falls on the way there.
pub(crate) fn invert(cubic: &[f64], value: f64, guess: f64) -> Option<f64> {
    let [one, two, three, zero] = [cubic[0], cubic[1], cubic[2], cubic[3]];
    let mut u = guess;
    for _ in 0..50 {
        let off = ((three * u + two) * u + one) * u + zero - value;
        let slope = (3.0 * three * u + 2.0 * two) * u + one;
        let step = (off / slope).clamp(-0.5, 0.5);
        if slope.is_nan() || slope <= 0.0 || step.is_nan() {
            return None;
        }
        u -= step;
        if step.abs() < 1e-13 {
            return Some(u);
        }
    }
    None
}
