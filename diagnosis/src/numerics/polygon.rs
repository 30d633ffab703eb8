//! A slow change as straight lines between knots at the places where they explain most, one after the other: as few as follow
//! it, close together where it bends.

use nalgebra::{DMatrix, DVector};

use crate::numerics::solve::{Normal, Solution};

/// Pieces of the recording between which a knot may stand.
pub(crate) const PIECES: usize = 64;
/// Most numbers of a knot, and of a step beside its place.
pub(crate) const CHANNELS: usize = 2;
/// Most knots beside the ends.
const MOST: usize = 16;
/// Columns with less than this share of their own square are combinations of others.
const DEPENDENT: f64 = 1e-8;

/// Sums of products of what values at `PIECES` + 1 evenly spaced knots, of both channels, make of the data.
pub(crate) struct Polygon {
    gram: DMatrix<f64>,
    right: DVector<f64>,
    norms: DVector<f64>,
}

/// What functions of the time, from −1 to 1, sampled at the knots, explain in both channels; from the sums that [`Polygon::new`]
/// takes.
pub(crate) fn sampled(
    gram: &DMatrix<f64>,
    right: &DVector<f64>,
    functions: &[impl Fn(f64) -> f64],
) -> Solution {
    let value = |i: usize, j: usize| {
        if i % CHANNELS == j % CHANNELS {
            functions[j / CHANNELS](2.0 * (i / CHANNELS) as f64 / PIECES as f64 - 1.0)
        } else {
            0.0
        }
    };
    let values = DMatrix::from_fn(gram.nrows(), CHANNELS * functions.len(), value);
    let products = values.tr_mul(gram) * &values;
    Normal::new(products, values.tr_mul(right), 0.0).solve()
}

impl Polygon {
    /// From sums of the values at the knots: channels of a knot beside each other.
    pub(crate) fn new(gram: &DMatrix<f64>, right: &DVector<f64>) -> Self {
        let m = CHANNELS * (PIECES + 1);
        // Knot 0 is a level that does not change, knot k + 1 a line that begins at knot k.
        let value = |at: usize, knot: usize| match knot {
            0 => 1.0,
            _ => at.saturating_sub(knot - 1) as f64 / PIECES as f64,
        };
        let change = DMatrix::from_fn(m, m, |i, j| {
            if i % CHANNELS == j % CHANNELS {
                value(i / CHANNELS, j / CHANNELS)
            } else {
                0.0
            }
        });
        let gram = change.tr_mul(gram) * &change;
        Self {
            norms: gram.diagonal(),
            gram,
            right: change.tr_mul(right),
        }
    }

    /// Log-likelihood that the best lines explain, each number at its price, a place at that of its own; what `free` numbers cost
    /// is not counted.
    pub(crate) fn explained(mut self, price: f64, free: usize) -> f64 {
        let place = (PIECES as f64).ln();
        let (mut gain, mut numbers) = (0.0, 0);
        for knot in 0..2 {
            let (more, rank) = self.take(knot);
            gain += more;
            numbers += rank;
        }
        gain -= price * (numbers as f64 - free as f64);
        for _ in 0..MOST {
            let worth = |knot: &usize| {
                let (more, rank) = self.worth(*knot);
                more - price * rank as f64 - place
            };
            let best = (2..=PIECES).max_by(|a, b| worth(a).total_cmp(&worth(b)));
            let Some(best) = best.filter(|knot| worth(knot) > 0.0) else {
                break;
            };
            gain += worth(&best);
            self.take(best);
        }
        gain
    }

    /// What a knot adds to those that were taken, and its numbers.
    fn worth(&self, knot: usize) -> (f64, usize) {
        let [i, j] = [CHANNELS * knot, CHANNELS * knot + 1];
        let (a, b, c) = (self.gram[(i, i)], self.gram[(i, j)], self.gram[(j, j)]);
        let own = |i: usize, d: f64| d > DEPENDENT * self.norms[i];
        if !own(i, a) {
            let gain = 0.5 * self.right[j] * self.right[j] / c;
            return if own(j, c) { (gain, 1) } else { (0.0, 0) };
        }
        let first = 0.5 * self.right[i] * self.right[i] / a;
        let left = c - b * b / a;
        if !own(j, left) {
            return (first, 1);
        }
        let rest = self.right[j] - b * self.right[i] / a;
        (first + 0.5 * rest * rest / left, 2)
    }

    /// Takes a knot, and what it adds.
    fn take(&mut self, knot: usize) -> (f64, usize) {
        let worth = self.worth(knot);
        for i in CHANNELS * knot..CHANNELS * (knot + 1) {
            let own = self.gram[(i, i)];
            if own > DEPENDENT * self.norms[i] {
                let column = self.gram.column(i).clone_owned();
                let by = self.right[i] / own;
                self.right.axpy(-by, &column, 1.0);
                self.gram.ger(-1.0 / own, &column, &column, 1.0);
            }
        }
        worth
    }
}
