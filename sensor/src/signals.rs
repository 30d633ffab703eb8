//! Samples of a sensor that is moved.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::StandardNormal;

use crate::cause::Cause;
use crate::channel::{Moment, clipped, of_both, of_one, of_scale};
use crate::coupling::Coupling;
use crate::flicker;
use crate::lag::Passed;
use crate::motion::Motion;
use crate::sensor::Sensor;
use crate::side::sides;

/// Times that the place of the axis is made of its cogging, and that of the place.
const COGGED: usize = 4;

/// What the ADC says, in the unit of the signals.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Seconds.
    pub time_s: Vec<f64>,
    /// The cosine channel.
    pub cos: Vec<f64>,
    /// The sine channel.
    pub sin: Vec<f64>,
}

impl Sensor {
    /// The sensor moved as `motion` says, with noise of this seed.
    #[must_use]
    pub fn simulate(&self, motion: &Motion, seed: u64) -> Samples {
        let mut random = StdRng::seed_from_u64(seed);
        let n = motion.alpha.len();
        let rate = self.adc.sample_rate_hz;
        let speed = derivative(&motion.alpha, rate);
        let acceleration = derivative(&speed, rate);
        let side = [1.0, -1.0].map(|start| sides(&motion.alpha, start));
        // Causes know the time since the beginning.
        let start = motion.time_s.first().copied().unwrap_or_default();
        let whole = motion.time_s.last().map_or(0.0, |last| last - start);
        let lags = self.lags();
        let density = self.sum(|c| match *c {
            Cause::FlickerNoise {
                density_at_1_hz, ..
            } => density_at_1_hz,
            _ => 0.0,
        });
        let mut slow = || match density {
            0.0 => vec![0.0; n],
            _ => flicker::noise(n, rate, density, &mut random),
        };
        let slow = [slow(), slow()];
        let mut coupling = Coupling::of(self);
        let (mut cos, mut sin) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for k in 0..n {
            let jitter = self.sum(|c| match *c {
                Cause::ClockJitter { rms_s } => rms_s * random.sample::<f64, _>(StandardNormal),
                _ => 0.0,
            });
            let time = motion.time_s[k] - start;
            let alpha = self.seen(motion.alpha[k], time) + speed[k] * jitter;
            let phi = self.revolution(alpha);
            let amplitude = 1.0 + self.sum(|c| of_both(c, time, phi));
            let pair: [f64; 2] = std::array::from_fn(|which| {
                let lag = lags[which];
                let late = alpha - speed[k] * lag.delay + 0.5 * acceleration[k] * lag.delay.powi(2);
                let passed = Passed {
                    late,
                    speed: speed[k],
                    acceleration: acceleration[k],
                    tau: lag.tau,
                };
                let phase = self.phase(which);
                let y = amplitude * passed.wave(1.0, phase);
                let x = Moment {
                    alpha,
                    time,
                    whole: whole.max(f64::MIN_POSITIVE),
                    speed: speed[k],
                    side: [side[0][k], side[1][k]],
                };
                y + self.sum(|c| of_scale(c, which, amplitude, phase, &passed))
                    + self.sum(|c| of_one(c, which, y, &x))
                    + self.sum(|c| self.of_other(c, which, &x))
            });
            let pair = coupling.passed(pair);
            let mut noisy = |y: f64, which: usize| {
                let more = self.sum(|c| match *c {
                    Cause::AmplitudeNoise { rms } => {
                        rms * y * random.sample::<f64, _>(StandardNormal)
                    }
                    _ => 0.0,
                });
                let white = self.signals.noise_rms * random.sample::<f64, _>(StandardNormal);
                let all = y + more + slow[which][k] + white;
                self.causes
                    .iter()
                    .fold(all, |y, cause| clipped(cause, which, y))
            };
            let pair = [noisy(pair[0], 0), noisy(pair[1], 1)];
            let s = &self.signals;
            let glitch = self.sum(|c| match *c {
                Cause::Glitches { share, largest } if random.random::<f64>() < share => largest,
                _ => 0.0,
            });
            cos.push(self.converted(s.a_c * pair[0] + s.b_c + glitch, 0));
            sin.push(self.converted(s.a_s * pair[1] + s.b_s, 1));
        }
        let all = Samples {
            time_s: motion.time_s.clone(),
            cos,
            sin,
        };
        self.arrived(all, &mut random)
    }

    pub(crate) fn sum(&self, of: impl FnMut(&Cause) -> f64) -> f64 {
        self.causes.iter().map(of).sum()
    }

    /// The angle that the scale shows where the smooth motion is at `alpha`, radians: there is other motion, and places are off.
    fn seen(&self, alpha: f64, time: f64) -> f64 {
        let vibrating = alpha
            + self.sum(|c| match *c {
                Cause::Vibration {
                    frequency_hz,
                    amplitude,
                    phase,
                } => amplitude * (TAU * frequency_hz * time + phase).cos(),
                _ => 0.0,
            });
        let of_revolution = |which: fn(&Cause) -> bool, at: f64| {
            self.sum(|c| match *c {
                Cause::Cogging {
                    order,
                    amplitude,
                    phase,
                }
                | Cause::GraduationError {
                    order,
                    amplitude,
                    phase,
                } if which(c) => amplitude * (order * self.revolution(at) + phase).cos(),
                _ => 0.0,
            })
        };
        // Cogging is of the place where the axis is with it.
        let cogging =
            |at: f64| vibrating + of_revolution(|c| matches!(c, Cause::Cogging { .. }), at);
        let place = (0..COGGED).fold(vibrating, |at, _| cogging(at));
        place + of_revolution(|c| matches!(c, Cause::GraduationError { .. }), place)
    }

    fn revolution(&self, alpha: f64) -> f64 {
        alpha / f64::from(self.motion.periods_per_revolution.unwrap_or(1))
    }
}

fn derivative(x: &[f64], rate: f64) -> Vec<f64> {
    let n = x.len();
    (0..n)
        .map(|k| {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(n - 1));
            if a == b {
                0.0
            } else {
                (x[b] - x[a]) * rate / (b - a) as f64
            }
        })
        .collect()
}
