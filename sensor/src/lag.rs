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

/// cos α or sin(α − β) behind a first-order low pass: the response at the speed of the moment, and the next term.
pub(crate) fn low_passed(
    alpha: f64,
    which: usize,
    beta: f64,
    speed: f64,
    acceleration: f64,
    tau: f64,
) -> f64 {
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
