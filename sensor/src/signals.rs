//! Samples of a sensor that is moved.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng, rngs::StdRng};
use rand_distr::StandardNormal;

use crate::cause::Cause;
use crate::coupling::Coupling;
use crate::flicker;
use crate::motion::Motion;
use crate::sensor::Sensor;

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

/// A channel's own time constant and delay.
#[derive(Clone, Copy, Default)]
struct Lag {
    tau: f64,
    delay: f64,
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
            let alpha = motion.alpha[k] + self.really(motion, k) + speed[k] * jitter;
            let phi = self.revolution(alpha);
            let amplitude = 1.0 + self.sum(|c| of_both(c, motion.time_s[k], phi));
            let pair: [f64; 2] = std::array::from_fn(|which| {
                let lag = lags[which];
                let late = alpha - speed[k] * lag.delay + 0.5 * acceleration[k] * lag.delay.powi(2);
                let y = amplitude
                    * low_passed(
                        late,
                        which,
                        self.signals.beta,
                        speed[k],
                        acceleration[k],
                        lag.tau,
                    );
                let x = Moment {
                    alpha,
                    time: motion.time_s[k],
                    whole: motion.time_s[n - 1].max(f64::MIN_POSITIVE),
                    speed: speed[k],
                };
                y + self.sum(|c| of_one(c, which, y, &x))
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
                y + more
                    + slow[which][k]
                    + self.signals.noise_rms * random.sample::<f64, _>(StandardNormal)
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

    /// What a channel has of the other, in amplitudes.
    fn of_other(&self, cause: &Cause, which: usize, at: &Moment) -> f64 {
        let Cause::DelayedCrosstalk {
            product_into_cos_s,
            product_into_sin_s,
            delay_s,
        } = *cause
        else {
            return 0.0;
        };
        let product = [product_into_cos_s, product_into_sin_s][which];
        let beta = self.signals.beta;
        let other = |alpha: f64| [(alpha - beta).sin(), alpha.cos()][which];
        let slope = [(at.alpha - beta).cos(), -at.alpha.sin()][which];
        if delay_s == 0.0 {
            -product * at.speed * slope
        } else {
            // The part that is not delayed stands in gain and phase.
            product * (other(at.alpha - at.speed * delay_s) - other(at.alpha)) / delay_s
        }
    }

    pub(crate) fn sum(&self, of: impl FnMut(&Cause) -> f64) -> f64 {
        self.causes.iter().map(of).sum()
    }

    /// What the scale shows beside the smooth motion, radians: other motion, or places that are off.
    fn really(&self, motion: &Motion, k: usize) -> f64 {
        self.sum(|c| match *c {
            Cause::Vibration {
                frequency_hz,
                amplitude,
                phase,
            } => amplitude * (TAU * frequency_hz * motion.time_s[k] + phase).cos(),
            Cause::Cogging {
                order,
                amplitude,
                phase,
            }
            | Cause::GraduationError {
                order,
                amplitude,
                phase,
            } => amplitude * (order * self.revolution(motion.alpha[k]) + phase).cos(),
            _ => 0.0,
        })
    }

    fn revolution(&self, alpha: f64) -> f64 {
        alpha / f64::from(self.motion.periods_per_revolution.unwrap_or(1))
    }

    fn lags(&self) -> [Lag; 2] {
        let mut lags = [Lag::default(); 2];
        for cause in &self.causes {
            match *cause {
                Cause::ChannelSkew { delay_s } => lags[1].delay -= delay_s,
                Cause::Latency { delay_s } => lags.iter_mut().for_each(|l| l.delay += delay_s),
                Cause::BandwidthMismatch {
                    tau_cos_s,
                    tau_sin_s,
                } => {
                    lags[0].tau += tau_cos_s;
                    lags[1].tau += tau_sin_s;
                }
                Cause::CommonBandwidth { tau_s } => lags.iter_mut().for_each(|l| l.tau += tau_s),
                _ => {}
            }
        }
        lags
    }
}

/// A moment of the recording.
struct Moment {
    alpha: f64,
    time: f64,
    whole: f64,
    speed: f64,
}

/// Part of the amplitude of both channels.
fn of_both(cause: &Cause, time: f64, phi: f64) -> f64 {
    match *cause {
        Cause::AmplitudeRipple {
            frequency_hz,
            depth,
            phase,
        } => depth * (TAU * frequency_hz * time + phase).cos(),
        Cause::Runout {
            order,
            depth,
            phase,
        } => depth * (order * phi + phase).cos(),
        Cause::Contamination {
            depth,
            place,
            width,
        } => {
            let off = (phi - place + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            -depth * (-0.5 * (off / width).powi(2)).exp()
        }
        _ => 0.0,
    }
}

/// What is added to a channel y, in its amplitudes.
fn of_one(cause: &Cause, which: usize, y: f64, at: &Moment) -> f64 {
    let of = |cos: f64, sin: f64| if which == 0 { cos } else { sin };
    match *cause {
        Cause::EvenNonlinearity { k_cos, k_sin } => of(k_cos, k_sin) * y * y,
        Cause::OddNonlinearity { k_cos, k_sin } => of(k_cos, k_sin) * y * y * y,
        Cause::SpatialHarmonic {
            order,
            amplitude_cos,
            phase_cos,
            amplitude_sin,
            phase_sin,
        } => of(amplitude_cos, amplitude_sin) * (order * at.alpha + of(phase_cos, phase_sin)).cos(),
        Cause::Saturation {
            threshold,
            compression,
            compression_upper,
            compression_lower,
            compression_cos_upper,
            compression_cos_lower,
            compression_sin_upper,
            compression_sin_lower,
        } => {
            let (of_rail, of_both) = if y > 0.0 {
                (
                    [compression_cos_upper, compression_sin_upper],
                    compression_upper,
                )
            } else {
                (
                    [compression_cos_lower, compression_sin_lower],
                    compression_lower,
                )
            };
            let compression = of_rail[which].or(of_both).unwrap_or(compression);
            -compression * (y.abs() - threshold).max(0.0) * y.signum()
        }
        Cause::Hysteresis {
            offset_cos,
            offset_sin,
        } => of(offset_cos, offset_sin) * at.speed.signum(),
        Cause::Interference {
            frequency_hz,
            amplitude_cos,
            phase_cos,
            amplitude_sin,
            phase_sin,
            amplitude_cos_2,
            phase_cos_2,
            amplitude_sin_2,
            phase_sin_2,
            amplitude_cos_3,
            phase_cos_3,
            amplitude_sin_3,
            phase_sin_3,
        } => [
            (of(amplitude_cos, amplitude_sin), of(phase_cos, phase_sin)),
            (
                of(amplitude_cos_2, amplitude_sin_2),
                of(phase_cos_2, phase_sin_2),
            ),
            (
                of(amplitude_cos_3, amplitude_sin_3),
                of(phase_cos_3, phase_sin_3),
            ),
        ]
        .iter()
        .zip(1..)
        .map(|((amplitude, phase), harmonic)| {
            let turns = f64::from(harmonic) * frequency_hz * at.time;
            amplitude * (TAU * turns + phase).cos()
        })
        .sum(),
        Cause::OffsetDrift {
            change_cos,
            change_sin,
        } => of(change_cos, change_sin) * (at.time / at.whole - 0.5),
        Cause::GainDrift {
            change_cos,
            change_sin,
        } => y * of(change_cos, change_sin) * (at.time / at.whole - 0.5),
        _ => 0.0,
    }
}

/// cos α or sin(α − β) behind a first-order low pass: the response at the speed of the moment, and the next term.
fn low_passed(alpha: f64, which: usize, beta: f64, speed: f64, acceleration: f64, tau: f64) -> f64 {
    let (y, slope) = if which == 0 {
        (alpha.cos(), -alpha.sin())
    } else {
        ((alpha - beta).sin(), (alpha - beta).cos())
    };
    // 1/(1 + jωτ) + j ω' τ²/(1 + jωτ)³, of which the real part takes y and the imaginary part its derivative.
    let x = speed * tau;
    let one = 1.0 + x * x;
    let (re, im) = (1.0 / one, -x / one);
    let (square_re, square_im) = (re * re - im * im, 2.0 * re * im);
    let (cube_re, cube_im) = (
        square_re * re - square_im * im,
        square_re * im + square_im * re,
    );
    let turn = acceleration * tau * tau;
    y * (re - turn * cube_im) + slope * (im + turn * cube_re)
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
