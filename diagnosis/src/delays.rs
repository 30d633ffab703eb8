//! Samples that are missing or were put in, seen through all noise: behind one, the angle is early or late by what it moves in a
//! sample, wherever it goes from there. That is a step as high as the speed and a bend by the acceleration, which noise hides that
//! is loud at their frequencies: an axis that shakes, a drive that wanders. So both are looked for by matched filters, each
//! frequency by how quiet it is there.

use std::f64::consts::{LN_2, PI};
use std::ops::Range;

use nonius_fourier::{Complex, forward, inverse};

use crate::checks::{magnitudes, ninth};
use crate::correlate::sums;
use crate::lines::median;
use crate::solve::{dot, weights_of};

/// Samples on either side through which a curve is laid that takes the motion, and its order; the longest that there are samples
/// enough for.
const CURVES: [(usize, i32); 4] = [(64, 5), (200, 5), (600, 5), (2000, 9)];
const LONGEST: usize = 2;
/// So many times the samples on a side are needed.
const ENOUGH: usize = 6;
/// Of the ends of a recording so many sides show nothing.
const EDGE: f64 = 1.5;
/// Samples that are transformed together.
const BLOCK: usize = 1 << 16;
/// Bins of a spectrum over which it is about as high: at least so many, and so large a part of a frequency.
const BINS: (usize, usize) = (12, 12);
/// So many times the samples on a side, to either side, tell how large the noise is just there.
const AROUND: usize = 8;

/// How an angle is seen to be early behind each of its samples, with curves of one length.
pub(crate) struct Delays {
    side: usize,
    /// Standard deviations of stationary noise by which it is early before each sample.
    told: Vec<f64>,
    /// Samples that seem to be missing there; negative: put in.
    samples: Vec<f64>,
    /// Square of what the likeliest corner of the drive there would be told by.
    corner: Vec<f64>,
    /// Standard deviation of `told`, over the whole recording.
    typical: f64,
}

/// A place before which samples seem to be missing.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Delay {
    /// The sample behind it.
    pub(crate) before: usize,
    /// How many; negative: put in.
    pub(crate) samples: f64,
    /// Standard deviation of that.
    pub(crate) sigma: f64,
}

/// By the longest curves that the angle has samples enough for, the shorter ones first; these give the speed.
pub(crate) fn delays(angle: &[f64]) -> Vec<Delays> {
    let fit = CURVES.partition_point(|(side, _)| angle.len() >= ENOUGH * side);
    let curves = CURVES[fit.saturating_sub(LONGEST)..fit].iter();
    let curves: Vec<Curve> = curves.copied().map(Curve::new).collect();
    let Some(shortest) = curves.first() else {
        return vec![];
    };
    let moves = [1, 2].map(|i| shortest.at_each(angle, i));
    let look = |curve: &Curve| Delays::new(angle, curve, &moves);
    curves.iter().map(look).collect()
}

impl Delays {
    fn new(angle: &[f64], curve: &Curve, [speed, bend]: &[Vec<f64>; 2]) -> Self {
        let (n, side) = (angle.len(), curve.side);
        let middle = curve.at_each(angle, 0);
        let mut left = vec![0.0; n];
        for k in side..n - side {
            left[k] = angle[k] - middle[k];
        }
        fade(&mut left[side..n - side], side / 2);
        let length = BLOCK.min(n.next_power_of_two());
        let templates = Templates::new(curve, length);
        let mut this = Self {
            side,
            told: vec![0.0; n],
            samples: vec![0.0; n],
            corner: vec![0.0; n],
            typical: f64::MIN_POSITIVE,
        };
        let edge = (EDGE * side as f64) as usize;
        let inside = if n <= length { n } else { length - 2 * edge };
        for from in (0..n.saturating_sub(2 * edge)).step_by(inside) {
            let to = n.min(from + length);
            let Some(seen) = templates.seen(&left[from..to]) else {
                continue;
            };
            for k in from + edge..to - edge {
                this.take(k, &seen, k - from, (speed[k], bend[k]));
            }
        }
        if n > 2 * edge {
            this.typical = deviation(&this.told[edge..n - edge]);
        }
        this
    }

    /// What is seen at sample `k`, which is the one at `at` of a block.
    fn take(&mut self, k: usize, seen: &Seen, at: usize, (speed, bend): (f64, f64)) {
        let with = speed * seen.with[0][at] + bend * seen.with[1][at];
        let [step, both, ramp] = seen.square;
        let square = speed * (speed * step + 2.0 * bend * both) + bend * bend * ramp;
        if square > 0.0 {
            self.told[k] = with / square.sqrt();
            self.samples[k] = with / square;
        }
        let corners = seen.with[1..].iter().zip(seen.corners);
        let squares = corners.map(|(with, square)| with[at] * with[at] / square);
        self.corner[k] = squares.fold(0.0, f64::max);
    }

    /// The noise of `told` there.
    fn noise(&self, k: usize) -> f64 {
        let (n, side) = (self.told.len(), self.side);
        let before = k.saturating_sub(AROUND * side)..k.saturating_sub(side);
        let after = (k + side).min(n)..(k + AROUND * side).min(n);
        let of = |range: Range<usize>| {
            let enough = range.len() > side;
            enough.then(|| deviation(&self.told[range]))
        };
        [before, after]
            .into_iter()
            .filter_map(of)
            .fold(self.typical, f64::max)
    }

    /// Samples about a place at which what is the reason for a delay there may stand.
    fn near(&self, k: usize) -> Range<usize> {
        k.saturating_sub(self.side / 2)..(k + self.side / 2 + 1).min(self.told.len())
    }

    /// What is told at a sample, and by how many standard deviations, if no corner of the drive near it is as likely. Where the
    /// place is `known`, it is dear that a corner may stand anywhere and have any order.
    pub(crate) fn at(&self, k: usize, known: bool) -> Option<(Delay, f64)> {
        let (told, noise, near) = (self.told[k], self.noise(k), self.near(k));
        let paid = if known {
            2.0 * (3.0 * near.len() as f64).ln()
        } else {
            0.0
        };
        let corner = self.corner[near].iter().copied().fold(0.0, f64::max);
        if told == 0.0 || corner >= told * told + paid * noise.powi(2) {
            return None;
        }
        let samples = self.samples[k];
        let delay = Delay {
            before: k,
            samples,
            sigma: noise * (samples / told).abs(),
        };
        Some((delay, told.abs() / noise))
    }

    /// Delays of more than `sure` standard deviations.
    pub(crate) fn far(&self, sure: f64) -> Vec<Delay> {
        let least = sure * self.typical;
        let highest = |k: &usize| {
            let near = &self.told[self.near(*k)];
            near.iter().all(|t| t.abs() <= self.told[*k].abs())
        };
        (0..self.told.len())
            .filter(|k| self.told[*k].abs() > least)
            .filter(highest)
            .filter_map(|k| self.at(k, false))
            .filter(|(_, told)| *told > sure)
            .map(|(delay, _)| delay)
            .collect()
    }

    /// Samples on either side of a place that the curves go through.
    pub(crate) fn side(&self) -> usize {
        self.side
    }
}

/// Of a normal distribution about 0, from its ninth decile.
fn deviation(values: &[f64]) -> f64 {
    ninth(&magnitudes(values)) / 1.645
}

/// Weights of the samples about one that give the curve there, its slope and its second derivative.
struct Curve {
    side: usize,
    weights: [Vec<f64>; 3],
}

impl Curve {
    fn new((side, order): (usize, i32)) -> Self {
        let reach = side as f64;
        let powers: Vec<Vec<f64>> = (0..=order)
            .map(|degree| {
                (0..=2 * side)
                    .map(|i| (i as f64 / reach - 1.0).powi(degree))
                    .collect()
            })
            .collect();
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
    fn at_each(&self, angle: &[f64], i: usize) -> Vec<f64> {
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
fn fade(values: &mut [f64], over: usize) {
    let n = values.len();
    for i in 0..over.min(n / 2) {
        let by = 0.5 - 0.5 * (PI * (i as f64 + 0.5) / over as f64).cos();
        values[i] *= by;
        values[n - 1 - i] *= by;
    }
}

/// Spectra of a step, a ramp and higher powers of the time where a curve is taken off.
struct Templates {
    side: usize,
    of: [Vec<Complex<f64>>; 4],
    /// Their squares, and second the product of step and ramp, of the frequencies that are not negative.
    squares: [Vec<f64>; 5],
}

/// What a block of an angle shows of them at each sample.
struct Seen {
    /// The angle times each, by how quiet each frequency is.
    with: [Vec<f64>; 4],
    /// The same of the step, of step and ramp, of the ramp.
    square: [f64; 3],
    /// And of all but the step.
    corners: [f64; 3],
}

impl Templates {
    fn new(curve: &Curve, length: usize) -> Self {
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
    fn seen(&self, block: &[f64]) -> Option<Seen> {
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

#[cfg(test)]
mod tests {
    use super::{Delay, delays};
    use rand::{Rng, SeedableRng, rngs::StdRng};

    const SAMPLES: usize = 20_000;
    const LOST: usize = 8_300;

    /// A drive that turns to and fro, whose axis shakes by more than it moves in a sample at a resonance. From half of the time on it goes
    /// by another acceleration, rad per square of a sample.
    fn shaken(seed: u64, corner: f64) -> Vec<f64> {
        let mut random = StdRng::seed_from_u64(seed);
        let (mut swing, mut before) = (0.0, 0.0);
        (0..=SAMPLES)
            .map(|k| {
                let t = k as f64;
                // A resonance at a hundredth of the sample rate.
                let next = 1.986 * swing - 0.99 * before + 2e-4 * random.random_range(-1.0..1.0);
                (before, swing) = (swing, next);
                let late = (t - 0.5 * SAMPLES as f64).max(0.0);
                100.0 * (t / 4000.0).sin()
                    + 0.5 * corner * late * late
                    + swing
                    + 2e-3 * random.random_range(-1.0..1.0)
            })
            .collect()
    }

    fn far(angle: &[f64]) -> Vec<Delay> {
        let looks = delays(angle);
        assert_eq!(looks.len(), 2);
        looks.iter().flat_map(|look| look.far(6.5)).collect()
    }

    #[test]
    fn a_lost_sample_shows_through_all_noise() {
        for seed in 0..8 {
            let whole = shaken(seed, 0.0);
            assert_eq!(far(&whole).len(), 0, "seed {seed}");
            let mut less = whole.clone();
            less.remove(LOST);
            let found = far(&less);
            assert!(!found.is_empty(), "seed {seed}");
            for one in found {
                assert!(one.before.abs_diff(LOST) < 4, "seed {seed}: {one:?}");
                assert!((one.samples - 1.0).abs() < 4.0 * one.sigma, "{one:?}");
            }
            let mut more = whole;
            more.insert(LOST, more[LOST]);
            let put_in = delays(&more)
                .iter()
                .filter_map(|look| look.at(LOST + 1, true))
                .last();
            let (one, told) = put_in.expect("a delay");
            assert!(
                (one.samples + 1.0).abs() < 4.0 * one.sigma && told > 5.0,
                "{one:?}"
            );
        }
    }

    /// An axis that is driven otherwise at once loses no sample.
    #[test]
    fn a_corner_of_the_drive_is_none() {
        for seed in 0..8 {
            for corner in [1e-6, -1e-5, 1e-4] {
                let found = far(&shaken(seed, corner));
                assert_eq!(found.len(), 0, "seed {seed}, corner {corner}: {found:?}");
            }
        }
    }
}
