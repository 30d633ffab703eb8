//! The searches of sections 5.2 to 5.4, off line: the Θ that makes J = Σ (‖MΘ‖² − 1)² smallest.
//!
//! The paper goes down the gradient; what counts is where it ends, and Levenberg–Marquardt gets there sooner. With the
//! cubic sets one direction changes no radius, and J leaves it open: the step along it is left out.

use nalgebra::{DMatrix, DVector};

use crate::ellipse::Ellipse;

/// Which parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Gains and offsets, equation (6).
    Four,
    /// And the phase, equation (7).
    Five,
    /// Cubic polynomials of each channel, 5.4.
    Eight,
    /// And the phase.
    Nine,
}

/// Singular values below this, relative to the largest, are a direction that J does not see.
const BLIND: f64 = 1e-3;
const ITERATIONS: usize = 100;

impl Set {
    /// The columns of M for signals of amplitude about one.
    fn columns(self, c: f64, s: f64) -> Vec<[f64; 2]> {
        let cubic = |y: f64| [y, y * y, y * y * y, 1.0];
        match self {
            Self::Four => vec![[c, 0.0], [1.0, 0.0], [0.0, s], [0.0, 1.0]],
            Self::Five => vec![[c, 0.0], [1.0, 0.0], [0.0, s], [0.0, 1.0], [0.0, c]],
            Self::Eight | Self::Nine => {
                let mut all: Vec<[f64; 2]> = cubic(c).map(|m| [m, 0.0]).to_vec();
                all.extend(cubic(s).map(|m| [0.0, m]));
                if self == Self::Nine {
                    all.push([0.0, c]);
                }
                all
            }
        }
    }

    /// Powers of the signals' unit in each parameter: θ of normalised signals is θ of raw ones times unit^power.
    #[must_use]
    pub fn powers(self) -> Vec<i32> {
        match self {
            Self::Four => vec![1, 0, 1, 0],
            Self::Five => vec![1, 0, 1, 0, 1],
            Self::Eight => vec![1, 2, 3, 0, 1, 2, 3, 0],
            Self::Nine => vec![1, 2, 3, 0, 1, 2, 3, 0, 1],
        }
    }

    fn start(self, ellipse: &Ellipse) -> Vec<f64> {
        let [one, two, three, four, five] = ellipse.theta();
        match self {
            Self::Four => vec![
                1.0 / ellipse.a_c,
                two,
                1.0 / ellipse.a_s,
                -ellipse.b_s / ellipse.a_s,
            ],
            Self::Five => vec![one, two, three, four, five],
            Self::Eight => vec![
                one,
                0.0,
                0.0,
                two,
                1.0 / ellipse.a_s,
                0.0,
                0.0,
                -ellipse.b_s / ellipse.a_s,
            ],
            Self::Nine => vec![one, 0.0, 0.0, two, three, 0.0, 0.0, four, five],
        }
    }

    /// The corrected pair.
    #[must_use]
    pub fn correct(self, theta: &[f64], y_c: f64, y_s: f64) -> (f64, f64) {
        let columns = self.columns(y_c, y_s);
        let sum = |row: usize| -> f64 { columns.iter().zip(theta).map(|(m, t)| m[row] * t).sum() };
        (sum(0), sum(1))
    }
}

/// A minimum of J.
#[derive(Clone, Debug, PartialEq)]
pub struct Minimum {
    /// Θ for the signals in their own unit.
    pub theta: Vec<f64>,
    /// Directions that J does not see.
    pub blind: usize,
    /// The iteration has come to rest.
    pub converged: bool,
}

/// The minimum of J nearest to the ellipse.
#[must_use]
pub fn minimise(set: Set, cos: &[f64], sin: &[f64], start: &Ellipse) -> Minimum {
    // Signals of amplitude one make the columns of one size.
    let unit = start.amplitude();
    let scaled = Ellipse {
        a_c: start.a_c / unit,
        b_c: start.b_c / unit,
        a_s: start.a_s / unit,
        b_s: start.b_s / unit,
        beta: start.beta,
    };
    let mut theta = DVector::from_vec(set.start(&scaled));
    let n = theta.len();
    let pairs = || cos.iter().zip(sin).map(|(c, s)| (c / unit, s / unit));
    let mut damping = 1e-6;
    let mut blind = 0;
    let mut converged = false;
    let objective = |theta: &DVector<f64>| -> f64 {
        pairs()
            .map(|(c, s)| {
                let (x, y) = set.correct(theta.as_slice(), c, s);
                (x * x + y * y - 1.0).powi(2)
            })
            .sum()
    };
    let mut now = objective(&theta);
    for _ in 0..ITERATIONS {
        let mut normal = DMatrix::<f64>::zeros(n, n);
        let mut score = DVector::<f64>::zeros(n);
        for (c, s) in pairs() {
            let columns = set.columns(c, s);
            let (x, y) = set.correct(theta.as_slice(), c, s);
            let residual = x * x + y * y - 1.0;
            let row =
                DVector::from_iterator(n, columns.iter().map(|m| 2.0 * (m[0] * x + m[1] * y)));
            normal.ger(1.0, &row, &row, 1.0);
            score.axpy(residual, &row, 1.0);
        }
        let eigen = normal.clone().symmetric_eigen();
        let largest = eigen.eigenvalues.amax();
        let mut step = DVector::<f64>::zeros(n);
        blind = 0;
        for (value, vector) in eigen
            .eigenvalues
            .iter()
            .zip(eigen.eigenvectors.column_iter())
        {
            if *value < BLIND * BLIND * largest {
                blind += 1;
                continue;
            }
            let along = vector.dot(&score) / (value + damping * largest);
            step.axpy(-along, &vector, 1.0);
        }
        let next = &theta + &step;
        let then = objective(&next);
        if then.is_finite() && then <= now * (1.0 + 1e-14) {
            let small = step.amax() < 1e-11;
            theta = next;
            now = then;
            damping = (damping / 10.0).max(1e-15);
            if small {
                converged = true;
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    let theta = theta.iter().zip(set.powers());
    Minimum {
        theta: theta.map(|(t, power)| t / unit.powi(power)).collect(),
        blind,
        converged,
    }
}

/// Where a cubic channel has its ends ±1: amplitude and offset in the unit of the signal.
#[must_use]
pub fn ends(cubic: [f64; 4], start: (f64, f64)) -> Option<(f64, f64)> {
    let [one, two, three, zero] = cubic;
    let end = |target: f64, from: f64| {
        let mut y = from;
        for _ in 0..50 {
            let value = zero + y * (one + y * (two + y * three)) - target;
            let slope = one + y * (2.0 * two + y * 3.0 * three);
            let step = value / slope;
            if !step.is_finite() {
                return None;
            }
            y -= step;
            if step.abs() < 1e-13 * (1.0 + y.abs()) {
                return Some(y);
            }
        }
        None
    };
    let (a, b) = start;
    let (high, low) = (end(1.0, b + a)?, end(-1.0, b - a)?);
    Some(((high - low) / 2.0, (high + low) / 2.0))
}
