//! Samples that are missing or were put in, seen through all noise: behind one, the angle is early or late by what it moves in a
//! sample, wherever it goes from there. That is a step as high as the speed and a bend by the acceleration, which noise hides that
//! is loud at their frequencies: an axis that shakes, a drive that wanders. So both are looked for by matched filters, each
//! frequency by how quiet it is there.

use std::collections::VecDeque;
use std::rc::Rc;

use crate::checks::matched::{Curve, Seen, Templates, fade};
use crate::checks::sides::beside;
use crate::checks::{NINTH, magnitudes, ninth};

/// Samples on either side through which a curve is laid that takes the motion, and its order; the longest that there are samples
/// enough for.
const CURVES: [(usize, i32); 4] = [(64, 5), (200, 5), (600, 5), (2000, 9)];
const LONGEST: usize = 2;
/// So many times the samples on a side are needed.
const ENOUGH: usize = 6;
/// Of the ends of a recording so many sides show nothing; as far again they show less than is there, by a tenth.
const EDGE: f64 = 1.5;
/// Samples that are transformed together.
const BLOCK: usize = 1 << 16;

/// How an angle is seen to be early behind each of its samples, with curves of one length.
pub(crate) struct Delays {
    side: usize,
    /// Radians per sample.
    speed: Rc<Vec<f64>>,
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
    /// What the angle moves in a sample there, radians.
    pub(crate) speed: f64,
}

/// By the longest curves that the angle has samples enough for, the shorter ones first; these give the speed.
pub(crate) fn delays(angle: &[f64]) -> Vec<Delays> {
    let fit = CURVES.partition_point(|(side, _)| angle.len() >= ENOUGH * side);
    let curves = CURVES[fit.saturating_sub(LONGEST)..fit].iter();
    let curves: Vec<Curve> = curves.copied().map(Curve::new).collect();
    let Some(shortest) = curves.first() else {
        return vec![];
    };
    let [speed, bend] = [1, 2].map(|i| shortest.at_each(angle, i));
    let speed = Rc::new(speed);
    let look = |curve: &Curve| Delays::new(angle, curve, (&speed, &bend));
    curves.iter().map(look).collect()
}

impl Delays {
    fn new(angle: &[f64], curve: &Curve, (speed, bend): (&Rc<Vec<f64>>, &[f64])) -> Self {
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
            speed: Rc::clone(speed),
            told: vec![0.0; n],
            samples: vec![0.0; n],
            corner: vec![0.0; n],
            typical: f64::MIN_POSITIVE,
        };
        let edge = (EDGE * side as f64) as usize;
        let inside = if n <= length { n } else { length - 2 * edge };
        for begin in (0..n.saturating_sub(2 * edge)).step_by(inside) {
            // The last one is as long as the others, for its spectrum.
            let from = begin.min(n.saturating_sub(length));
            let to = n.min(from + length);
            let Some(seen) = templates.seen(&left[from..to]) else {
                continue;
            };
            for k in begin + edge..to - edge {
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
        let near = beside(k, self.side, self.told.len());
        let enough = near.into_iter().filter(|range| range.len() > self.side);
        enough
            .map(|range| deviation(&self.told[range]))
            .fold(self.typical, f64::max)
    }

    /// What is told at a sample, by that noise.
    fn delay(&self, k: usize, noise: f64) -> Delay {
        Delay {
            before: k,
            samples: self.samples[k],
            sigma: noise * (self.samples[k] / self.told[k]).abs(),
            speed: self.speed[k],
        }
    }

    /// What is told at a sample that is known, and by how many standard deviations, if no corner of the drive near it is likelier: that
    /// one may stand anywhere and have any order is dear.
    pub(crate) fn at(&self, k: usize) -> Option<(Delay, f64)> {
        let (told, noise, reach) = (self.told[k], self.noise(k), self.side / 2);
        let near = k.saturating_sub(reach)..(k + reach + 1).min(self.told.len());
        let places = 3 * (self.side + 1);
        let paid = 2.0 * (places as f64).ln() * noise.powi(2);
        let corner = self.corner[near].iter().copied().fold(0.0, f64::max);
        let likelier = told != 0.0 && corner < told * told + paid;
        likelier.then(|| (self.delay(k, noise), told.abs() / noise))
    }

    /// Delays of more than `sure` standard deviations that are likelier than every corner of the drive near them.
    pub(crate) fn far(&self, sure: f64) -> Vec<Delay> {
        let sizes = magnitudes(&self.told);
        if sizes.iter().all(|size| *size <= sure * self.typical) {
            return vec![];
        }
        let [highest, corner] = [&sizes, &self.corner].map(|of| largest_near(of, self.side / 2));
        (0..sizes.len())
            .filter(|k| sizes[*k] > sure * self.typical && sizes[*k] >= highest[*k])
            .filter(|k| corner[*k] < sizes[*k].powi(2))
            .map(|k| (k, self.noise(k)))
            .filter(|(k, noise)| sizes[*k] > sure * noise)
            .map(|(k, noise)| self.delay(k, noise))
            .collect()
    }

    /// Samples on either side of a place that the curves go through.
    pub(crate) fn side(&self) -> usize {
        self.side
    }
}

/// The largest of the values at most `reach` away from each.
fn largest_near(values: &[f64], reach: usize) -> Vec<f64> {
    // Those that no later one exceeds, largest first.
    let mut falling = VecDeque::new();
    let mut next = 0;
    (0..values.len())
        .map(|k| {
            while next < values.len().min(k + reach + 1) {
                while falling
                    .back()
                    .is_some_and(|last| values[*last] <= values[next])
                {
                    falling.pop_back();
                }
                falling.push_back(next);
                next += 1;
            }
            while falling.front().is_some_and(|first| first + reach < k) {
                falling.pop_front();
            }
            falling.front().map_or(0.0, |first| values[*first])
        })
        .collect()
}

/// Of a normal distribution about 0, from its ninth decile.
fn deviation(values: &[f64]) -> f64 {
    ninth(&magnitudes(values)) / NINTH
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
                .filter_map(|look| look.at(LOST + 1))
                .next_back();
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
