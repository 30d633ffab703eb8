//! Likelihood of flicker noise in time, to hold beside that of levels and steps: a spectrum is looked at through a window
//! and by every second line, which is worth half of the recording.
//!
//! Noise with a 1/f spectrum is a sum of first-order processes of equal power whose time constants are evenly spaced in
//! their logarithm. Both channels have such noise, the radius shows r = c cos α + s sin α of it beside white noise: a Kalman
//! filter tells how likely each sample is after the ones before it.

use crate::context::Context;
use crate::telegraph::ENOUGH;

/// Ratio of neighbouring time constants: the sum follows 1/f to a few per cent.
const RATIO: f64 = 4.0;
/// Share of the corner's period below which a process is lost in the white noise.
const SHORTEST: f64 = 0.016;
/// Share of the recording beyond which a process is an offset.
const LONGEST: f64 = 0.5;
/// Corner frequencies that are tried, over the one of the spectrum.
const CORNERS: [f64; 5] = [0.35, 0.6, 1.0, 1.7, 2.9];

/// Log-likelihood that flicker noise explains of a radial residual beyond white noise, near a corner frequency in hertz.
pub(crate) fn gain(context: &Context, radial: &[f64], corner: f64) -> f64 {
    let n = radial.len().min(ENOUGH);
    let part = &radial[..n];
    let of_one = |by: f64| Processes::new(context, n, by * corner).gain(context, part);
    let best = CORNERS.into_iter().map(of_one).fold(0.0, f64::max);
    best / n as f64 * radial.len() as f64
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
    fn new(context: &Context, samples: usize, corner: f64) -> Self {
        let shortest = (SHORTEST / corner * context.rate).max(1.0);
        let longest = LONGEST * samples as f64;
        let mut times = vec![longest];
        while let Some(next) = times.last().map(|t| t / RATIO).filter(|t| *t > shortest) {
            times.push(next);
        }
        let one: Vec<f64> = times.iter().map(|t| (-1.0 / t).exp()).collect();
        let stay = [one.as_slice(), one.as_slice()].concat();
        // Σ of 2 v τ / (1 + ω²τ²) over evenly spaced ln τ is v / (2 f ln RATIO).
        let power = 2.0 * RATIO.ln() * corner / context.rate;
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

    fn gain(mut self, context: &Context, radial: &[f64]) -> f64 {
        let (m, mut row) = (self.stay.len(), vec![]);
        let (mut spread, mut power, mut white, mut counts) = (0.0, 0.0, 0.0, 0.0);
        for (k, r) in radial.iter().enumerate() {
            self.step();
            if context.weight[k] == 0.0 {
                continue;
            }
            let seen = |i: usize| {
                if i < m / 2 {
                    context.cos[k]
                } else {
                    context.sin[k]
                }
            };
            row.clear();
            row.extend(self.covariance.chunks(m).map(|line| {
                let (c, s) = line.split_at(m / 2);
                context.cos[k] * c.iter().sum::<f64>() + context.sin[k] * s.iter().sum::<f64>()
            }));
            let expected: f64 = (0..m).map(|i| seen(i) * self.state[i]).sum();
            let variance = 1.0 + (0..m).map(|i| seen(i) * row[i]).sum::<f64>();
            let off = r - expected;
            for (i, line) in self.covariance.chunks_mut(m).enumerate() {
                let by = row[i] / variance;
                self.state[i] += by * off;
                line.iter_mut().zip(&row).for_each(|(p, q)| *p -= by * q);
            }
            spread += variance.ln();
            power += off * off / variance;
            white += r * r;
            counts += 1.0;
        }
        0.5 * (counts * (white / power).ln() - spread)
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
