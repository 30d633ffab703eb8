//! Likelihood of flicker noise in time, to hold beside that of levels and steps: a spectrum is looked at through a window
//! and by every second line, which is worth half of the recording.
//!
//! Noise with a 1/f spectrum is a sum of first-order processes of equal power whose time constants are evenly spaced in
//! their logarithm. Both channels have such noise, the radius shows r = c cos α + s sin α of it beside white noise, and what is
//! against a reference s cos α − c sin α: a Kalman filter tells how likely each sample is after the ones before it.
//!
//! A long recording is looked at by groups of samples over which the fastest process that is not lost in the white noise
//! hardly changes. Of slow noise all of it is seen then; the first part alone would not do, for what is chance there looks
//! like many times as much if the rest is taken to be alike.

use crate::drifts::channels::{Channels, Row};
use crate::drifts::telegraph::ENOUGH;

/// Ratio of neighbouring time constants: the sum follows 1/f to a few per cent.
const RATIO: f64 = 4.0;
/// Share of the corner's period below which a process is lost in the white noise.
const SHORTEST: f64 = 0.016;
/// Share of the recording beyond which a process is an offset.
const LONGEST: f64 = 0.5;
/// Corner frequencies that are tried, over the one of the spectrum.
const CORNERS: [f64; 5] = [0.35, 0.6, 1.0, 1.7, 2.9];

/// Shares of the shortest time constant that a group of samples may last.
const SHARES: f64 = 8.0;
/// Share of a group's information below which one of its two channels is not seen.
const UNSEEN: f64 = 1e-9;

/// Log-likelihood that flicker noise explains beyond white noise.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Explained {
    /// Of the samples that were looked at: this is evidence.
    pub(crate) seen: f64,
    /// Of all samples, if those that were not looked at are like the others: this compares.
    pub(crate) all: f64,
    /// What steady offsets explain of that: they are no noise.
    pub(crate) steady: f64,
}

/// What flicker noise explains of what is seen, near a corner frequency in hertz.
pub(crate) fn gain(seen: Channels, corner: f64) -> Explained {
    let of_one = |by: f64| Processes::explained(seen, by * corner);
    let more = |a: Explained, b: Explained| if b.all > a.all { b } else { a };
    CORNERS
        .into_iter()
        .map(of_one)
        .fold(Explained::default(), more)
}

/// Time constant in samples below which a process is lost in the white noise.
fn shortest(seen: &Channels, corner: f64) -> f64 {
    (SHORTEST / corner * seen.context.rate).max(1.0)
}

/// First-order processes of both channels, in units of the white noise.
struct Processes {
    /// What of each is left after a sample.
    stay: Vec<f64>,
    /// Variance of each.
    power: f64,
    /// Expectations, those of the cosine first.
    state: Vec<f64>,
    /// Their covariance, row by row.
    covariance: Vec<f64>,
}

impl Processes {
    /// What processes below a corner frequency explain.
    fn explained(seen: Channels, corner: f64) -> Explained {
        let all = seen.samples();
        let longest = (shortest(&seen, corner) / SHARES).max(1.0) as usize;
        let group = all.div_ceil(ENOUGH).clamp(1, longest);
        let part = seen.first(all.min(ENOUGH * group));
        let gain = Self::new(&part, corner, group).gain(&part, group);
        let whole = all as f64 / part.samples() as f64;
        Explained {
            seen: gain,
            all: gain * whole,
            steady: part.steady(all) * whole,
        }
    }

    /// Before the first group, of so many samples.
    fn new(seen: &Channels, corner: f64, group: usize) -> Self {
        let rate = seen.context.rate;
        let shortest = shortest(seen, corner);
        let longest = LONGEST * seen.samples() as f64;
        let mut times = vec![longest];
        while let Some(next) = times.last().map(|t| t / RATIO).filter(|t| *t > shortest) {
            times.push(next);
        }
        let one: Vec<f64> = times.iter().map(|t| (-(group as f64) / t).exp()).collect();
        let stay = [one.as_slice(), one.as_slice()].concat();
        // Σ of 2 v τ / (1 + ω²τ²) over evenly spaced ln τ is v / (2 f ln RATIO).
        let power = 2.0 * RATIO.ln() * corner / rate;
        let m = stay.len();
        let mut covariance = vec![0.0; m * m];
        (0..m).for_each(|i| covariance[i * m + i] = power);
        Self {
            state: vec![0.0; m],
            stay,
            power,
            covariance,
        }
    }

    fn gain(mut self, seen: &Channels, group: usize) -> f64 {
        let mut with = vec![];
        let (mut spread, mut power, mut white, mut counts) = (0.0, 0.0, 0.0, 0.0);
        for first in (0..seen.samples()).step_by(group) {
            self.step();
            let group = Group::of(seen, first..(first + group).min(seen.samples()));
            let rows = group.rows();
            // What no offset of the channels explains is white noise.
            power += group.square - rows.iter().map(|r| r.left * r.left).sum::<f64>();
            for row in rows.iter().filter(|r| r.of != [0.0; 2]) {
                let (variance, off) = self.take(row, &mut with);
                spread += variance.ln();
                power += off * off / variance;
            }
            white += group.square;
            counts += group.count;
        }
        0.5 * (counts * (white / power).ln() - spread)
    }

    /// Takes what is seen: its variance, and by how much it is not what was expected. `with`: room for covariances.
    fn take(&mut self, row: &Row, with: &mut Vec<f64>) -> (f64, f64) {
        let m = self.stay.len();
        let of = |i: usize| row.of[usize::from(i >= m / 2)];
        with.clear();
        with.extend(self.covariance.chunks(m).map(|line| {
            let (c, s) = line.split_at(m / 2);
            row.of[0] * c.iter().sum::<f64>() + row.of[1] * s.iter().sum::<f64>()
        }));
        let expected: f64 = (0..m).map(|i| of(i) * self.state[i]).sum();
        let variance = 1.0 + (0..m).map(|i| of(i) * with[i]).sum::<f64>();
        let off = row.left - expected;
        let by = |i: usize| with[i] / variance;
        (0..m).for_each(|i| self.state[i] += by(i) * off);
        known(&mut self.covariance, with, variance);
        (variance, off)
    }

    /// A group later.
    fn step(&mut self) {
        let m = self.stay.len();
        forgotten(&mut self.covariance, &self.stay);
        for (i, own) in self.stay.iter().enumerate() {
            self.covariance[i * m + i] += self.power * (1.0 - own * own);
        }
        self.state
            .iter_mut()
            .zip(&self.stay)
            .for_each(|(x, s)| *x *= s);
    }
}

/// A covariance less what is known once a number with these covariances is: its variance is given.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn known(covariance: &mut [f64], with: &[f64], variance: f64) {
    for (line, own) in covariance.chunks_mut(with.len()).zip(with) {
        let by = own / variance;
        line.iter_mut().zip(with).for_each(|(p, q)| *p -= by * q);
    }
}

/// A covariance of which these shares of the numbers stay.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn forgotten(covariance: &mut [f64], stay: &[f64]) {
    for (line, own) in covariance.chunks_mut(stay.len()).zip(stay) {
        line.iter_mut().zip(stay).for_each(|(p, s)| *p *= own * s);
    }
}

/// Samples over which the offsets of the channels hardly change.
#[derive(Default)]
struct Group {
    /// Sums of products of what a residual shows of the channels: cos², cos sin, sin².
    shown: [f64; 3],
    /// Of those with the residual.
    with_left: [f64; 2],
    /// Of squares of the residual.
    square: f64,
    /// Residuals.
    count: f64,
}

impl Group {
    fn of(seen: &Channels, samples: std::ops::Range<usize>) -> Self {
        let mut this = Self::default();
        for k in samples.filter(|k| seen.context.weight[*k] != 0.0) {
            for Row { of: [c, s], left } in seen.rows(k) {
                this.shown[0] += c * c;
                this.shown[1] += c * s;
                this.shown[2] += s * s;
                this.with_left[0] += c * left;
                this.with_left[1] += s * left;
                this.square += left * left;
                this.count += 1.0;
            }
        }
        this
    }

    /// Two residuals with the noise of one that tell as much of the offsets as all of the group do (Cholesky): the channel that is
    /// seen more, and what is seen of the other beside it.
    fn rows(&self) -> [Row; 2] {
        let [cc, cs, ss] = self.shown;
        let turned = ss > cc;
        let (own, other) = if turned { (ss, cc) } else { (cc, ss) };
        let [with_c, with_s] = self.with_left;
        let (with_own, with_other) = if turned {
            (with_s, with_c)
        } else {
            (with_c, with_s)
        };
        let row = |of: [f64; 2], left: f64| Row {
            of: if turned { [of[1], of[0]] } else { of },
            left,
        };
        let nothing = || row([0.0; 2], 0.0);
        if own <= 0.0 {
            return [nothing(), nothing()];
        }
        let root = own.sqrt();
        let first = row([root, cs / root], with_own / root);
        let beside = other - cs * cs / own;
        if beside <= UNSEEN * own {
            return [first, nothing()];
        }
        let root = beside.sqrt();
        let left = (with_other - cs / own * with_own) / root;
        [first, row([0.0, root], left)]
    }
}
