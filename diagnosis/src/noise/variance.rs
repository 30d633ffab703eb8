//! Noise whose covariance is a sum of shapes: likelihood, best amounts, and how sure they are where the noise is not white.
//!
//! A sample leaves a pair of residuals, radial and tangential. What noise of the channels depends on shows in the
//! variance of either, and as much in what they have in common.

use nalgebra::{DMatrix, DVector};

use crate::model::sweep::half;
use crate::numerics::solve::{Normal, Solution};

/// Steps of the scoring iteration; each is a regression on the products, weighted with the covariances of the one before.
const STEPS: usize = 6;
/// So many of them look at every sample: from where fewer lead to, a single one is off by a small part of the errors.
const LAST: usize = 1;
/// Samples that are enough to see what noise depends on.
pub(crate) const ENOUGH: usize = 120_000;
/// Samples that are enough for the steps that only lead to where the last ones start.
const FIRST: usize = 20_000;
/// Least variance, as a share of the mean.
const LEAST: f64 = 0.02;
/// Most of what two residuals may have in common, as a correlation.
const MOST: f64 = 0.9;
/// A single residual further out, in its standard deviations, is a glitch, no noise that depends on something.
const FAR: f64 = 5.0;
/// Blocks of samples in which products may go together; in each choice, so many of them.
const BLOCKS: [usize; 2] = [40, 400];

/// Products of a pair of residuals, or their means: radial squared, tangential squared, radial times tangential.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Products(pub(crate) [f64; 3]);

impl Products {
    fn of([radial, tangential]: [f64; 2]) -> Self {
        Self([
            radial * radial,
            tangential * tangential,
            radial * tangential,
        ])
    }

    fn is_nothing(&self) -> bool {
        self.0.iter().all(|p| *p == 0.0)
    }

    fn plus(self, amount: f64, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + amount * other.0[i]))
    }

    /// Trace of the product of two symmetric matrices.
    fn trace(&self, other: &Self) -> f64 {
        let [a, b] = [&self.0, &other.0];
        a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2]
    }
}

/// A covariance that can be one, and its inverse.
struct Covariance {
    value: Products,
    determinant: f64,
    inverse: Products,
}

impl Covariance {
    /// The sum of so much of each shape; a variance is never below a small part of the mean.
    fn of(x: &[f64], shapes: &[Products]) -> Self {
        let sum = x
            .iter()
            .zip(shapes)
            .fold(Products::default(), |sum, (x, h)| sum.plus(*x, *h));
        let [radial, tangential] = [sum.0[0].max(LEAST), sum.0[1].max(LEAST)];
        let most = MOST * (radial * tangential).sqrt();
        let common = sum.0[2].clamp(-most, most);
        let determinant = radial * tangential - common * common;
        let inverse = [tangential, radial, -common].map(|p| p / determinant);
        Self {
            value: Products([radial, tangential, common]),
            determinant,
            inverse: Products(inverse),
        }
    }

    /// A pair without what is too far out in either of its residuals.
    fn cut(&self, pair: [f64; 2]) -> [f64; 2] {
        let limits = [self.value.0[0], self.value.0[1]].map(|v| FAR * v.sqrt());
        [0, 1].map(|row| pair[row].clamp(-limits[row], limits[row]))
    }

    /// The inverse from either side: what weighs a shape in the likelihood.
    fn weighed(&self, h: &Products) -> Products {
        let [a, b, c] = self.inverse.0;
        let [r, t, m] = h.0;
        let [first, second] = [
            [a * r + c * m, a * m + c * t],
            [c * r + b * m, c * m + b * t],
        ];
        Products([
            first[0] * a + first[1] * c,
            second[0] * c + second[1] * b,
            first[0] * c + first[1] * b,
        ])
    }
}

/// Writes the shapes of a sample.
pub(crate) type Shapes<'a> = dyn Fn(usize, &mut [Products]) + 'a;

/// Pairs of residuals, in units of their rms, and which samples count.
#[derive(Clone)]
pub(crate) struct Pairs<'a> {
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

impl Pairs<'_> {
    /// Visits every sample that counts, in one of so many blocks.
    fn each(&self, every: usize, mut visit: impl FnMut(usize)) {
        const BLOCK: usize = 1024;
        for start in (0..self.weight.len()).step_by(BLOCK * every) {
            for k in start..(start + BLOCK).min(self.weight.len()) {
                if self.weight[k] > 0.0 {
                    visit(k);
                }
            }
        }
    }

    fn pair(&self, k: usize) -> [f64; 2] {
        [self.rows[0][k], self.rows[1][k]]
    }

    /// Cuts what is far out of these covariances.
    pub(crate) fn cut(&mut self, x: &[f64], shapes: &Shapes) {
        let mut h = vec![Products::default(); x.len()];
        for k in 0..self.weight.len() {
            shapes(k, &mut h);
            let pair = Covariance::of(x, &h).cut(self.pair(k));
            for (row, value) in self.rows.iter_mut().zip(pair) {
                row[k] = value;
            }
        }
    }

    /// The likeliest amounts of shapes; starts from these.
    pub(crate) fn fit(&self, start: Vec<f64>, shapes: &Shapes) -> Fitted {
        let (x, _) = self.steps(start, STEPS - LAST, self.coarse(), shapes);
        let (x, solution) = self.steps(x, LAST, self.every, shapes);
        Fitted {
            likelihood: self.likelihood(&x, shapes),
            covariance: solution.covariance,
            rank: solution.rank,
            x,
        }
    }

    /// The likeliest amounts where fewer samples are enough, and their standard errors there.
    pub(crate) fn rough_fit(&self, start: Vec<f64>, shapes: &Shapes) -> (Vec<f64>, Vec<f64>) {
        let (x, solution) = self.steps(start, STEPS, self.coarse(), shapes);
        let error = solution.covariance.diagonal().map(|v| v.max(0.0).sqrt());
        (x, error.iter().copied().collect())
    }

    /// Of so many blocks of samples, one is enough for what only leads on. Rounded down: every other block, where held-out
    /// blocks are about as long, would miss half of them.
    fn coarse(&self) -> usize {
        self.every.max(self.weight.len() / FIRST)
    }

    /// Whether a rough fit leaves samples out that [`Self::fit`] looks at.
    pub(crate) fn is_rough(&self) -> bool {
        self.coarse() > self.every
    }

    /// So many steps of scoring, on one block of samples in so many.
    fn steps(
        &self,
        start: Vec<f64>,
        steps: usize,
        every: usize,
        shapes: &Shapes,
    ) -> (Vec<f64>, Solution) {
        let count = start.len();
        let (mut x, mut h) = (start, vec![Products::default(); count]);
        let mut last = Solution::default();
        // The shapes that a sample has, and which they are.
        let mut some: Vec<(usize, Products)> = vec![];
        for _ in 0..steps {
            let (mut gram, mut right) = (DMatrix::zeros(count, count), DVector::zeros(count));
            self.each(every, |k| {
                shapes(k, &mut h);
                let expected = Covariance::of(&x, &h);
                let seen = Products::of(expected.cut(self.pair(k)));
                some.clear();
                let all = h.iter().copied().enumerate();
                some.extend(all.filter(|(_, b)| !b.is_nothing()));
                for (n, (j, b)) in some.iter().enumerate() {
                    let weighed = expected.weighed(b);
                    right[*j] += 0.5 * weighed.trace(&seen);
                    let mut column = gram.column_mut(*j);
                    for (i, a) in &some[..=n] {
                        column[*i] += 0.5 * weighed.trace(a);
                    }
                }
            });
            gram.fill_lower_triangle_with_upper_triangle();
            let solution = Normal::new(gram, right, 0.0).solve();
            x.clone_from(&solution.x);
            last = solution;
        }
        (x, last)
    }

    fn likelihood(&self, x: &[f64], shapes: &Shapes) -> f64 {
        let (mut sum, mut h) = (0.0, vec![Products::default(); x.len()]);
        self.each(self.every, |k| {
            shapes(k, &mut h);
            let expected = Covariance::of(x, &h);
            let seen = Products::of(self.pair(k));
            sum -= 0.5 * (expected.determinant.ln() + expected.inverse.trace(&seen));
        });
        sum
    }

    /// Log-likelihood of interleaved blocks by amounts that were fitted to the blocks between them: with the last shape less
    /// without it.
    pub(crate) fn held_out(&self, start: &[f64], shapes: &Shapes) -> f64 {
        let length = half(self.weight.len());
        let of = |side: usize| -> Vec<f64> {
            let own = |k: usize| f64::from(k / length % 2 == side);
            let weights = self.weight.iter().enumerate();
            weights.map(|(k, w)| w * own(k)).collect()
        };
        let [first, second] = [of(0), of(1)];
        let part = |weight| Pairs {
            rows: self.rows.clone(),
            weight,
            every: self.every,
        };
        let gain = |fitted: &Pairs, judged: &Pairs| {
            let likelihood = |start: &[f64]| {
                let x = fitted.fit(start.to_vec(), shapes).x;
                judged.likelihood(&x, shapes)
            };
            likelihood(start) - likelihood(&start[..start.len() - 1])
        };
        let halves = [part(&first), part(&second)];
        gain(&halves[0], &halves[1]) + gain(&halves[1], &halves[0])
    }

    /// So many times the variance that independent pairs give it, the amount of the last shape has: products of coloured
    /// noise, and of noise that comes and goes, go together.
    pub(crate) fn inflation(&self, fitted: &Fitted, shapes: &Shapes) -> f64 {
        let count = fitted.x.len();
        // The amount is a sum over samples, each with its share.
        let share = fitted.covariance.column(count - 1).clone_owned();
        let n = self.weight.len();
        let variance = fitted.covariance[(count - 1, count - 1)];
        let spread = |blocks: usize| {
            let length = n.div_ceil(blocks).max(1);
            let mut sums = vec![0.0; blocks];
            let mut h = vec![Products::default(); count];
            self.each(self.every, |k| {
                shapes(k, &mut h);
                let expected = Covariance::of(&fitted.x, &h);
                let along = share
                    .iter()
                    .zip(&h)
                    .fold(Products::default(), |sum, (s, h)| sum.plus(*s, *h));
                let seen = Products::of(expected.cut(self.pair(k)));
                let beyond = seen.plus(-1.0, expected.value);
                sums[k / length] += 0.5 * expected.weighed(&along).trace(&beyond);
            });
            sums.iter().map(|s| s * s).sum::<f64>()
        };
        let widest = BLOCKS.map(spread).into_iter().fold(0.0, f64::max);
        (widest / variance.max(f64::MIN_POSITIVE)).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use rand::{SeedableRng, rngs::StdRng};
    use rand_distr::{Distribution, StandardNormal};

    use super::{Pairs, Products};

    const N: usize = 240_000;

    /// White noise, and noise of each channel that goes with its signal, of a scale that turns.
    fn shapes(k: usize, out: &mut [Products]) {
        let (s, c) = (0.37 * k as f64).sin_cos();
        let (cc, ss) = (c * c, s * s);
        out[0] = Products([1.0, 0.0, 0.0]);
        out[1] = Products([0.0, 1.0, 0.0]);
        if let Some(own) = out.get_mut(2) {
            *own = Products([cc * cc + ss * ss, 2.0 * cc * ss, c * s * (ss - cc)]);
        }
    }

    fn pairs(amount: f64, weight: &[f64]) -> Pairs<'_> {
        let mut random = StdRng::seed_from_u64(8);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        let mut rows = [vec![], vec![]];
        for k in 0..N {
            let (s, c) = (0.37 * k as f64).sin_cos();
            let [in_c, in_s] = [c, s].map(|u| (1.0 + amount * u * u).sqrt() * normal());
            rows[0].push(c * in_c + s * in_s);
            rows[1].push(c * in_s - s * in_c);
        }
        Pairs {
            rows,
            weight,
            every: 1,
        }
    }

    /// Half of what tells it is in what the residuals have in common: on the same samples, the likelihood of the variances alone
    /// is half as much.
    #[test]
    fn what_residuals_have_in_common_tells_as_much_as_their_variances() {
        let weight = vec![1.0; N];
        let gain = |pairs: &Pairs, shapes: &super::Shapes| {
            let with = pairs.fit(vec![1.0, 1.0, 0.0], shapes);
            let without = pairs.fit(vec![1.0, 1.0], shapes);
            (
                with.likelihood - without.likelihood,
                with.x[2],
                with.covariance[(2, 2)].sqrt(),
            )
        };
        let noisy = pairs(0.2, &weight);
        let (all, amount, error) = gain(&noisy, &shapes);
        let (variances, ..) = gain(&noisy, &|k, out: &mut [Products]| {
            shapes(k, out);
            out.iter_mut().for_each(|o| o.0[2] = 0.0);
        });
        assert!((amount - 0.2).abs() < 3.0 * error, "{amount} ± {error}");
        let ratio = all / variances;
        assert!((1.6..2.5).contains(&ratio), "{all} {variances}");
        let (nothing, amount, error) = gain(&pairs(0.0, &weight), &shapes);
        assert!(nothing < 4.0 && amount.abs() < 3.0 * error, "{nothing}");
    }
}
