//! Matched filters for what a delay makes of an angle: a step and a ramp, and what corners of a drive do, each frequency by how
//! quiet it is.

use std::f64::consts::LN_2;

use nonius_fourier::{Complex, forward, inverse};

use crate::checks::sides::powers;
use crate::numerics::correlate::sums;
use crate::numerics::lines::{median, window};
use crate::numerics::solve::{dot, weights_of};

/// Bins of a spectrum over which it is about as high: at least so many, and so large a part of a frequency.
const BINS: (usize, usize) = (12, 12);

/// Weights of the samples about one that give the curve there, its slope and its second derivative.
pub(crate) struct Curve {
    pub(crate) side: usize,
    weights: [Vec<f64>; 3],
}

impl Curve {
    pub(crate) fn new((side, order): (usize, i32)) -> Self {
        let reach = side as f64;
        let powers = powers(2 * side + 1, order);
        let weights = |degree: usize, by: f64| -> Vec<f64> {
            let others = powers.iter().enumerate().filter(|(i, _)| *i != degree);
            let others: Vec<Vec<f64>> = others.map(|(_, power)| power.clone()).collect();
            let weights = weights_of(&powers[degree], &others);
            weights.iter().map(|w| w * by).collect()
        };
        Self {
            side,
            weights: [
                weights(0, 1.0),
                weights(1, 1.0 / reach),
                weights(2, 2.0 / (reach * reach)),
            ],
        }
    }

    /// One of these of all samples that have enough on either side.
    pub(crate) fn at_each(&self, angle: &[f64], i: usize) -> Vec<f64> {
        let mut all = vec![0.0; self.side];
        all.extend(sums(angle, &self.weights[i]));
        all.resize(angle.len(), 0.0);
        all
    }

    /// What is left of a function of the time, 0 before it begins, where curves are taken off: of as many samples on either side of
    /// that.
    fn left(&self, f: impl Fn(f64) -> f64) -> Vec<f64> {
        let reach = 2 * self.side;
        let values: Vec<f64> = (0..=2 * reach)
            .map(|i| {
                if i < reach {
                    0.0
                } else {
                    f((i - reach) as f64)
                }
            })
            .collect();
        let curves = sums(&values, &self.weights[0]);
        let own = &values[self.side..];
        own.iter().zip(curves).map(|(v, c)| v - c).collect()
    }
}

/// Lets values begin and end at 0, over so many of them.
pub(crate) fn fade(values: &mut [f64], over: usize) {
    let n = values.len();
    for i in 0..over.min(n / 2) {
        let by = window(i, 2 * over);
        values[i] *= by;
        values[n - 1 - i] *= by;
    }
}

/// Spectra of a step, a ramp and higher powers of the time where a curve is taken off.
pub(crate) struct Templates {
    side: usize,
    of: [Vec<Complex<f64>>; 4],
    /// Their squares, and second the product of step and ramp, of the frequencies that are not negative.
    squares: [Vec<f64>; 5],
}

/// What a block of an angle shows of them at each sample.
pub(crate) struct Seen {
    /// The angle times each, by how quiet each frequency is.
    pub(crate) with: [Vec<f64>; 4],
    /// The same of the step, of step and ramp, of the ramp.
    pub(crate) square: [f64; 3],
    /// And of all but the step.
    pub(crate) corners: [f64; 3],
}

impl Templates {
    pub(crate) fn new(curve: &Curve, length: usize) -> Self {
        let side = curve.side;
        let of = [0, 1, 2, 3].map(|power| {
            let mut all = vec![Complex::ZERO; length];
            // The ramp is by the sample, the others are of any size.
            let unit = if power < 2 { 1.0 } else { side as f64 };
            let left = curve.left(|t| (t / unit).powi(power));
            for (i, value) in left.into_iter().enumerate() {
                all[(i + length - side) % length] = value.into();
            }
            forward(&mut all);
            all
        });
        let product = |(a, b): (usize, usize)| -> Vec<f64> {
            let pairs = of[a].iter().zip(&of[b]).take(length / 2 + 1);
            pairs.map(|(a, b)| (a * b.conj()).re).collect()
        };
        let squares = [(0, 0), (0, 1), (1, 1), (2, 2), (3, 3)].map(product);
        Self { side, of, squares }
    }

    /// A block of what curves leave of an angle; `None` where that is nothing.
    pub(crate) fn seen(&self, block: &[f64]) -> Option<Seen> {
        let length = self.of[0].len();
        let mut block = block.to_vec();
        fade(&mut block, self.side / 2);
        let counted = block.iter().filter(|v| **v != 0.0).count();
        let mut values: Vec<Complex<f64>> = block.into_iter().map(Complex::from).collect();
        values.resize(length, Complex::ZERO);
        forward(&mut values);
        let noise = spectrum(&values, counted)?;
        for (j, value) in values.iter_mut().enumerate() {
            *value /= noise[j.min(length - j)] * length as f64;
        }
        // Two of them as the real and the imaginary part of one.
        let both = |a: usize, b: usize| {
            let mut all = values.clone();
            for (i, value) in all.iter_mut().enumerate() {
                let (a, b) = (self.of[a][i].conj(), self.of[b][i].conj());
                *value *= Complex::new(a.re - b.im, a.im + b.re);
            }
            inverse(&mut all);
            let (a, b): (Vec<f64>, Vec<f64>) = all.into_iter().map(|v| (v.re, v.im)).unzip();
            [a, b]
        };
        let ([step, ramp], [second, third]) = (both(0, 1), both(2, 3));
        // All but the first and the last stand for a negative frequency, too.
        let over = noise.iter().map(|noise| 2.0 / (noise * length as f64));
        let over: Vec<f64> = over.collect();
        let [steps, both, ramps, seconds, thirds] = self.squares.each_ref().map(|products| {
            let ends = [0, length / 2].map(|j| products[j] * over[j]);
            dot(products, &over) - (ends[0] + ends[1]) / 2.0
        });
        Some(Seen {
            with: [step, ramp, second, third],
            square: [steps, both, ramps],
            corners: [ramps, seconds, thirds],
        })
    }
}

/// How loud each frequency that is not negative is, per sample of so many that are counted; lines do not count.
fn spectrum(values: &[Complex<f64>], counted: usize) -> Option<Vec<f64>> {
    let half = values.len() / 2;
    let power: Vec<f64> = values[..=half]
        .iter()
        .map(|v| v.norm_sqr() / counted.max(1) as f64)
        .collect();
    // Middle of some bins and the logarithm of the power there.
    let mut places: Vec<(f64, f64)> = vec![];
    let mut from = 1;
    while from <= half {
        let to = (from + (from / BINS.1).max(BINS.0)).min(half + 1);
        let usual = median(&power[from..to]) / LN_2;
        if usual <= 0.0 {
            return None;
        }
        places.push((0.5 * (from + to - 1) as f64, usual.ln()));
        from = to;
    }
    let mut next = 1;
    let at = |j: usize| {
        let x = j as f64;
        while next + 1 < places.len() && places[next].0 < x {
            next += 1;
        }
        let (a, b) = (places[next - 1], *places.get(next)?);
        let share = ((x - a.0) / (b.0 - a.0)).clamp(0.0, 1.0);
        Some((a.1 + share * (b.1 - a.1)).exp())
    };
    (0..=half).map(at).collect()
}
