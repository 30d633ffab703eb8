//! Noise whose variance is a sum of shapes: likelihood, best amounts, and how sure they are where the noise is not white.

use nalgebra::{DMatrix, DVector};

use crate::solve::Normal;
use crate::sweep::BLOCKS as INTERLEAVED;

/// Steps of the scoring iteration; each is a regression on the squares, weighted with the variances of the one before.
const STEPS: usize = 6;
/// So many of them look at every sample.
const LAST: usize = 2;
/// Samples that are enough to see what noise depends on.
pub(crate) const ENOUGH: usize = 120_000;
/// Samples that are enough for the steps that only lead to where the last ones start.
const FIRST: usize = 20_000;
/// Least variance, as a share of the mean.
const LEAST: f64 = 0.02;
/// A single sample further out (square over variance) is a glitch, no noise that depends on something.
const FAR: f64 = 25.0;
/// Blocks of samples in which squares may go together; in each choice, so many of them.
const BLOCKS: [usize; 2] = [40, 400];

/// Writes the shapes of a sample in a row, 0 or 1.
pub(crate) type Shapes<'a> = dyn Fn(usize, usize, &mut [f64]) + 'a;

/// Squares of two rows of residuals in units of their means, and which samples count.
pub(crate) struct Squares<'a> {
    pub(crate) rows: [Vec<f64>; 2],
    pub(crate) weight: &'a [f64],
    /// Of so many blocks of samples one is looked at.
    pub(crate) every: usize,
}

/// Amounts of shapes, and what they explain.
pub(crate) struct Fitted {
    pub(crate) x: Vec<f64>,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) likelihood: f64,
    pub(crate) rank: usize,
}

/// A variance is never below a small part of the mean.
fn variance(x: &[f64], shapes: &[f64]) -> f64 {
    let sum: f64 = x.iter().zip(shapes).map(|(x, h)| x * h).sum();
    sum.max(LEAST)
}

impl Squares<'_> {
    /// Visits row and index of every sample that counts, in one of so many blocks.
    fn each(&self, every: usize, mut visit: impl FnMut(usize, usize)) {
        const BLOCK: usize = 1024;
        for row in 0..2 {
            for start in (0..self.weight.len()).step_by(BLOCK * every) {
                for k in start..(start + BLOCK).min(self.weight.len()) {
                    if self.weight[k] > 0.0 {
                        visit(row, k);
                    }
                }
            }
        }
    }

    /// Cuts what is far out of these variances.
    pub(crate) fn cut(&mut self, x: &[f64], shapes: &Shapes) {
        let mut h = vec![0.0; x.len()];
        for (row, squares) in self.rows.iter_mut().enumerate() {
            for (k, square) in squares.iter_mut().enumerate() {
                shapes(row, k, &mut h);
                *square = square.min(FAR * variance(x, &h));
            }
        }
    }

    /// The likeliest amounts of `count` shapes; starts from these.
    pub(crate) fn fit(&self, start: Vec<f64>, shapes: &Shapes) -> Fitted {
        let count = start.len();
        let (mut x, mut h) = (start, vec![0.0; count]);
        let mut last = None;
        // Rounded down: every other block, where held-out blocks are about as long, would miss half of them.
        let coarse = self.every.max(self.weight.len() / FIRST);
        for step in 0..STEPS {
            let every = if step + LAST < STEPS {
                coarse
            } else {
                self.every
            };
            let (mut gram, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
            self.each(every, |row, k| {
                shapes(row, k, &mut h);
                let v = variance(&x, &h);
                let square = self.rows[row][k].min(FAR * v);
                let weight = 0.5 / (v * v);
                for (j, b) in h.iter().enumerate().filter(|(_, b)| **b != 0.0) {
                    right[j] += weight * b * square;
                    for (i, a) in h[..=j].iter().enumerate() {
                        gram[(i, j)] += weight * a * b;
                    }
                }
            });
            gram.fill_lower_triangle_with_upper_triangle();
            let solution = Normal::new(gram, right, 0.0).solve();
            x.clone_from(&solution.x);
            last = Some(solution);
        }
        let likelihood = self.likelihood(&x, shapes);
        let (covariance, rank) = last.map_or((DMatrix::zeros(count, count), 0), |s| {
            (s.covariance, s.rank)
        });
        Fitted {
            x,
            covariance,
            likelihood,
            rank,
        }
    }

    fn likelihood(&self, x: &[f64], shapes: &Shapes) -> f64 {
        let (mut sum, mut h) = (0.0, vec![0.0; x.len()]);
        self.each(self.every, |row, k| {
            shapes(row, k, &mut h);
            let v = variance(x, &h);
            sum -= 0.5 * (v.ln() + self.rows[row][k] / v);
        });
        sum
    }

    /// Log-likelihood of interleaved blocks by amounts that were fitted to the blocks between them: with the last shape less
    /// without it.
    pub(crate) fn held_out(&self, start: &[f64], shapes: &Shapes) -> f64 {
        let length = self.weight.len().div_ceil(INTERLEAVED).max(1);
        let half = |half: usize| -> Vec<f64> {
            let own = |k: usize| f64::from(k / length % 2 == half);
            let weights = self.weight.iter().enumerate();
            weights.map(|(k, w)| w * own(k)).collect()
        };
        let [first, second] = [half(0), half(1)];
        let part = |weight| Squares {
            rows: self.rows.clone(),
            weight,
            every: self.every,
        };
        let gain = |fitted: &Squares, judged: &Squares| {
            let likelihood = |start: &[f64]| {
                let x = fitted.fit(start.to_vec(), shapes).x;
                judged.likelihood(&x, shapes)
            };
            likelihood(start) - likelihood(&start[..start.len() - 1])
        };
        let halves = [part(&first), part(&second)];
        gain(&halves[0], &halves[1]) + gain(&halves[1], &halves[0])
    }

    /// So many times the variance that independent squares give it, the amount of the last shape has: squares of coloured
    /// noise, and of noise that comes and goes, go together.
    pub(crate) fn inflation(&self, fitted: &Fitted, shapes: &Shapes) -> f64 {
        let count = fitted.x.len();
        // The amount is a sum over samples, each with its share.
        let share = fitted.covariance.column(count - 1).clone_owned();
        let n = self.weight.len();
        let expected = fitted.covariance[(count - 1, count - 1)];
        let spread = |blocks: usize| {
            let length = n.div_ceil(blocks).max(1);
            let mut sums = vec![0.0; blocks];
            let mut h = vec![0.0; count];
            self.each(self.every, |row, k| {
                shapes(row, k, &mut h);
                let v = variance(&fitted.x, &h);
                let along: f64 = share.iter().zip(&h).map(|(s, h)| s * h).sum();
                sums[k / length] += along * (self.rows[row][k].min(FAR * v) - v) / (2.0 * v * v);
            });
            sums.iter().map(|s| s * s).sum::<f64>()
        };
        let widest = BLOCKS.map(spread).into_iter().fold(0.0, f64::max);
        (widest / expected.max(f64::MIN_POSITIVE)).max(1.0)
    }
}
