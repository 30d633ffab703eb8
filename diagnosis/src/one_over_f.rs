//! Likelihood of flicker noise in time, to hold beside that of levels and steps: a spectrum is looked at through a window
//! and by every second line, which is worth half of the recording.
//!
//! Noise with a 1/f spectrum is a sum of first-order processes of equal power whose time constants are evenly spaced in
//! their logarithm. Both channels have such noise, the radius shows r = c cos α + s sin α of it beside white noise, and what is
//! against a reference s cos α − c sin α: a Kalman filter tells how likely each sample is after the ones before it.

use crate::channels::{Channels, Row};
use crate::telegraph::ENOUGH;

/// Ratio of neighbouring time constants: the sum follows 1/f to a few per cent.
const RATIO: f64 = 4.0;
/// Share of the corner's period below which a process is lost in the white noise.
const SHORTEST: f64 = 0.016;
/// Share of the recording beyond which a process is an offset.
const LONGEST: f64 = 0.5;
/// Corner frequencies that are tried, over the one of the spectrum.
const CORNERS: [f64; 5] = [0.35, 0.6, 1.0, 1.7, 2.9];

/// Log-likelihood that flicker noise explains of what is seen beyond white noise, near a corner frequency in hertz.
pub(crate) fn gain(seen: Channels, corner: f64) -> f64 {
    let n = seen.samples().min(ENOUGH);
    let part = seen.first(n);
    let of_one = |by: f64| Processes::new(&part, by * corner).gain(&part);
    let best = CORNERS.into_iter().map(of_one).fold(0.0, f64::max);
    best / n as f64 * seen.samples() as f64
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
    fn new(seen: &Channels, corner: f64) -> Self {
        let rate = seen.context.rate;
        let shortest = (SHORTEST / corner * rate).max(1.0);
        let longest = LONGEST * seen.samples() as f64;
        let mut times = vec![longest];
        while let Some(next) = times.last().map(|t| t / RATIO).filter(|t| *t > shortest) {
            times.push(next);
        }
        let one: Vec<f64> = times.iter().map(|t| (-1.0 / t).exp()).collect();
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

    fn gain(mut self, seen: &Channels) -> f64 {
        let mut with = vec![];
        let (mut spread, mut power, mut white, mut counts) = (0.0, 0.0, 0.0, 0.0);
        for k in 0..seen.samples() {
            self.step();
            if seen.context.weight[k] == 0.0 {
                continue;
            }
            for row in seen.rows(k) {
                let (variance, off) = self.take(&row, &mut with);
                spread += variance.ln();
                power += off * off / variance;
                white += row.left * row.left;
                counts += 1.0;
            }
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
        for (i, line) in self.covariance.chunks_mut(m).enumerate() {
            let by = with[i] / variance;
            self.state[i] += by * off;
            line.iter_mut().zip(&*with).for_each(|(p, q)| *p -= by * q);
        }
        (variance, off)
    }

    /// A sample later.
    fn step(&mut self) {
        let m = self.stay.len();
        for (i, line) in self.covariance.chunks_mut(m).enumerate() {
            let own = self.stay[i];
            line.iter_mut()
                .zip(&self.stay)
                .for_each(|(p, s)| *p *= own * s);
            line[i] += self.power * (1.0 - own * own);
        }
        self.state
            .iter_mut()
            .zip(&self.stay)
            .for_each(|(x, s)| *x *= s);
    }
}
