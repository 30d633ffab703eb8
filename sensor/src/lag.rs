//! Channels that come late: delays and first-order low passes.

use crate::cause::Cause;
use crate::sensor::Sensor;

/// A channel's own time constant and delay.
#[derive(Clone, Copy, Default)]
pub(crate) struct Lag {
    pub(crate) tau: f64,
    pub(crate) delay: f64,
}

impl Sensor {
    /// Of cos and of sin.
    pub(crate) fn lags(&self) -> [Lag; 2] {
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

/// What reaches the ADC of a wave of a channel: later, and behind a first-order low pass.
pub(crate) struct Passed {
    /// Angle at which the channel is sampled, radians.
    pub(crate) late: f64,
    /// Radians per second.
    pub(crate) speed: f64,
    /// Radians per second squared.
    pub(crate) acceleration: f64,
    /// Time constant, s.
    pub(crate) tau: f64,
}

impl Passed {
    /// Nothing is late.
    pub(crate) fn undisturbed(alpha: f64) -> Self {
        Self {
            late: alpha,
            speed: 0.0,
            acceleration: 0.0,
            tau: 0.0,
        }
    }

    /// cos(order α + phase) behind it: the response at the wave's speed of the moment, and the next term.
    pub(crate) fn wave(&self, order: f64, phase: f64) -> f64 {
        let (sin, cos) = (order * self.late + phase).sin_cos();
        // 1/(1 + jωτ) + j ω' τ²/(1 + jωτ)³, of which the real part takes the cosine and the imaginary part its derivative.
        let x = order * self.speed * self.tau;
        let one = 1.0 + x * x;
        let (re, im) = (1.0 / one, -x / one);
        let (square_re, square_im) = (re * re - im * im, 2.0 * re * im);
        let (cube_re, cube_im) = (
            square_re * re - square_im * im,
            square_re * im + square_im * re,
        );
        let turn = order * self.acceleration * self.tau * self.tau;
        cos * (re - turn * cube_im) - sin * (im + turn * cube_re)
    }
}
