//! An estimate beside the geometric fit of the same samples, by which every method is judged: what the samples cannot tell, and what
//! else to know.

use nalgebra::Vector2;

use crate::curve::{Curve, Parameters};
use crate::estimate::{Estimate, estimate};
use crate::method::{Method, Options};
use crate::residual::{collapsed, residual, white};
use crate::samples::{self, Samples};
use crate::unbiased::Fit;
use crate::{cramer_rao, extremes, places, unbiased, words};

/// What a method makes of the samples, and what is seen of it.
pub(crate) struct Seen<'a> {
    method: Method,
    samples: &'a Samples,
    /// σ_s/σ_c, where it is given.
    given_ratio: Option<f64>,
    /// The geometric fit.
    pub(crate) fit: Fit,
    /// Rms of its radius less one.
    pub(crate) own_residual: f64,
    /// Angles of the samples on it, turns.
    turns: Vec<f64>,
    /// Longest part of the period without a sample, 0 to 1.
    pub(crate) gap: f64,
    /// What the method says.
    pub(crate) estimate: Estimate,
    /// Rms of the radius less one that it leaves.
    pub(crate) residual_rms: f64,
}

impl<'a> Seen<'a> {
    /// `None` where the samples draw no ellipse.
    pub(crate) fn by(samples: &'a Samples, method: Method, options: &Options) -> Option<Self> {
        let (c, s) = (&samples.cos[..], &samples.sin[..]);
        let mut fit = unbiased::fit(c, s, &samples.start, options.noise_ratio);
        if !fit.converged {
            fit.ellipse = samples.start;
        }
        let pairs = c.iter().zip(s);
        let turns: Vec<f64> = pairs.map(|(c, s)| fit.ellipse.angle(*c, *s)).collect();
        let gap = places::widest_gap(&turns);
        if !fit.converged && gap > words::GAP {
            return None;
        }
        let mut estimate = estimate(method, c, s, &fit)?;
        let mut residual_rms = residual(method, &estimate.theta, c, s);
        let own_residual = residual(Method::Unbiased, &fit.ellipse.theta(), c, s);
        if method.searches() && collapsed(method, &estimate.theta, &fit, c, s) {
            let why = words::of_collapse(method, residual_rms, white(&fit));
            estimate = Estimate::of(fit.ellipse, None);
            estimate.cannot_tell = vec![why];
            (estimate.theta, estimate.adrift) = (vec![], true);
            residual_rms = own_residual;
        }
        Some(Self {
            method,
            samples,
            given_ratio: options.noise_ratio,
            fit,
            own_residual,
            turns,
            gap,
            estimate,
            residual_rms,
        })
    }

    /// The least of both residuals.
    fn least(&self) -> f64 {
        self.residual_rms.min(self.own_residual)
    }

    /// Error bars and noise would be those of the numbers' last digits.
    pub(crate) fn is_rounding(&self) -> bool {
        self.least() < words::ROUNDING
    }

    /// Angles of the samples, radians.
    pub(crate) fn radians(&self) -> Vec<f64> {
        let turns = self.turns.iter();
        turns.map(|a| a * std::f64::consts::TAU).collect()
    }

    /// Smallest radius of the curve where there are samples, in standard deviations of the noise.
    fn tightest_bend(&self) -> f64 {
        let [c, s] = self.fit.noise;
        let white = |y: Vector2<f64>| Vector2::new(y.x / c, y.y / s);
        let radius = |alpha: f64| {
            let along = white(self.fit.ellipse.tangent(alpha));
            let bend = white(self.fit.ellipse.bend(alpha));
            along.norm().powi(3) / along.perp(&bend).abs()
        };
        self.radians()
            .into_iter()
            .map(radius)
            .fold(f64::INFINITY, f64::min)
    }

    /// Largest and smallest value of which channel are not seen.
    fn unseen(&self) -> [bool; 2] {
        extremes::unseen(&self.fit.ellipse, &self.radians(), self.fit.noise)
    }

    /// Of which of a_c, b_c, a_s, b_s, β the samples tell no error bar.
    pub(crate) fn untold(&self) -> [bool; 5] {
        if self.estimate.adrift || self.is_rounding() {
            return [true; 5];
        }
        let mut untold = if self.fit.converged {
            words::vague(&self.fit)
        } else {
            [false; 5]
        };
        if self.method == Method::Extremes {
            let unseen = self.unseen();
            for (i, untold) in untold[..4].iter_mut().enumerate() {
                *untold |= unseen[i / 2];
            }
        }
        untold
    }

    /// What the samples cannot tell.
    pub(crate) fn cannot_tell(&self) -> Vec<String> {
        let (method, fit, rounding) = (self.method, &self.fit, self.is_rounding());
        let mut told = self.estimate.cannot_tell.clone();
        if rounding {
            told.push(words::of_no_noise(self.least()));
        }
        if !self.estimate.theta.is_empty() {
            told.extend(words::of_method(method));
        }
        if !fit.converged && method == Method::Unbiased {
            told.push(words::OF_A_CONIC.into());
        }
        if fit.converged {
            let whole = whole(fit, self.samples.cos.len());
            told.extend(words::of_arc(method, self.gap, fit, whole));
        }
        if method == Method::Extremes {
            told.extend(words::of_extremes(self.unseen(), self.gap > words::GAP));
        }
        // The bound beside every method is made of the ratio, but only one weighs the channels by it.
        if (method == Method::Unbiased || fit.ratio_extreme) && !rounding {
            told.extend(words::of_ratio(fit));
        }
        if !rounding {
            told.extend(words::of_residuals(method, fit, self.own_residual));
        }
        if fit.converged && !rounding && method == Method::Unbiased {
            told.extend(words::of_tight_bend(self.tightest_bend()));
            told.extend(fit.together.map(words::of_noise_together));
        }
        told.extend(places::on_the_curve(self.turns.clone()).and_then(words::of_places));
        if !(rounding || fit.ratio_extreme || fit.ratio_assumed) {
            let steps = [&self.samples.cos, &self.samples.sin].map(|y| samples::code_step(y));
            told.extend(words::of_rounding(fit.noise, steps));
        }
        told
    }

    /// What else to know about the numbers.
    pub(crate) fn remarks(&self) -> Vec<String> {
        let (method, fit, samples) = (self.method, &self.fit, self.samples);
        let untold = self.untold();
        let mut remarks = vec![];
        if let Some(given) = self.given_ratio {
            let own = unbiased::fit(&samples.cos, &samples.sin, &samples.start, None);
            remarks.extend(words::of_given_ratio(given, &own));
        }
        if let Some(bias) = self.estimate.bias {
            remarks.push(words::of_bias(bias, !untold.contains(&true)));
        }
        if self.gap > words::GAP && untold.contains(&false) {
            remarks.extend(words::of_bias_on_an_arc(method));
        }
        remarks.extend(words::of_outliers(samples.outliers));
        if method != Method::Unbiased && fit.converged && self.own_residual > words::ROUNDING {
            let own = self.estimate.ellipse.parameters();
            remarks.extend(words::beside_unbiased(method, &own, fit, untold));
        }
        if method.set().cubic() && !self.estimate.theta.is_empty() {
            remarks.push(words::of_an_ellipse(self.own_residual));
        }
        remarks
    }
}

/// Standard errors from as many samples over whole periods.
fn whole(fit: &Fit, samples: usize) -> Option<Parameters> {
    let step = std::f64::consts::TAU / 360.0;
    let angles: Vec<f64> = (0..360).map(|k| f64::from(k) * step).collect();
    let bound = cramer_rao::bound(&fit.ellipse, &angles, fit.noise)?;
    let share = 360.0 / samples as f64;
    Some(bound.covariance.diagonal().map(|v| (v * share).sqrt()))
}
