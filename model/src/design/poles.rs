//! Poles, loop coefficients, and what the loop can follow.

use std::f64::consts::TAU;

use super::DesignError;
use super::refuse::{at_most, between, limits, refuse};
use crate::spec::Spec;

/// The tracking loop in real numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// ω0 ts.
    pub omega: f64,
    /// p1 + p2.
    pub pole_sum: f64,
    /// p1 p2.
    pub pole_product: f64,
    /// Second pole of the filter; 1 for type 2.
    pub pole: f64,
    /// a, turns per radian.
    pub a: f64,
    /// a + b, turns per radian.
    pub ab: f64,
    /// Noise bandwidth as a fraction of the sample rate: Σ h² of the closed loop.
    pub noise_gain: f64,
}

/// How the loop widens in acquisition: `gears` steps of 2 in bandwidth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acquisition {
    /// Gears above the designed one. Each halves the bandwidth: what a loop makes of the errors of a sensor that is not yet
    /// calibrated is its increment's ripple, which a loop of a quarter of the bandwidth may no longer pull in.
    pub gears: u32,
}

impl Loop {
    pub(super) fn new(spec: &Spec) -> Result<Self, DesignError> {
        let t = &spec.tracking;
        if !matches!(t.method, 1..=3) {
            return refuse(
                "loop.method",
                t.method,
                "1, 2 or 3",
                "the paper has three methods",
            );
        }
        if !matches!(t.filter_type, 1 | 2) {
            return refuse(
                "loop.type",
                t.filter_type,
                "1 or 2",
                "poles of the filter at 1",
            );
        }
        if t.method == 2 && t.filter_type == 2 {
            return refuse(
                "loop.type",
                2,
                "1",
                "Method 2 uses its filter pole to place the closed loop's poles, so a type 2 filter is impossible (paper, 4.2); take Method 3",
            );
        }
        if let Some(pole) = t.pole {
            if t.filter_type == 2 || t.method == 2 {
                return refuse(
                    "loop.pole",
                    pole,
                    "absent",
                    "only a type 1 filter of Method 1 or 3 has a free second pole",
                );
            }
            between(
                "loop.pole",
                pole,
                0.0,
                0.999_999,
                "the filter's second pole lies inside the unit circle",
            )?;
        }
        between(
            "loop.damping",
            t.damping,
            0.2,
            10.0,
            "less rings, more is slow",
        )?;
        let omega = TAU * t.bandwidth_hz / spec.adc.sample_rate_hz;
        if !(omega.is_finite() && (5e-4..=1.0).contains(&omega)) {
            let rate = spec.adc.sample_rate_hz / TAU;
            return refuse(
                "loop.bandwidth_hz",
                t.bandwidth_hz,
                format!("{} Hz", limits(5e-4 * rate, rate)),
                "poles too fast for the sample rate, or so slow that the loop never locks",
            );
        }
        let xi = t.damping;
        let (pole_sum, pole_product) = if xi >= 1.0 {
            let root = (xi * xi - 1.0).sqrt();
            let (p1, p2) = ((-omega * (xi - root)).exp(), (-omega * (xi + root)).exp());
            (p1 + p2, p1 * p2)
        } else {
            let angle = omega * (1.0 - xi * xi).sqrt();
            (
                2.0 * (-omega * xi).exp() * angle.cos(),
                (-2.0 * omega * xi).exp(),
            )
        };
        let pole = if t.filter_type == 2 {
            1.0
        } else {
            t.pole.unwrap_or(pole_product)
        };
        let ab = (1.0 - pole_sum + pole_product) / TAU;
        let a = if t.method == 2 {
            ab
        } else {
            (1.0 + pole - pole_sum) / TAU
        };
        let mut this = Self {
            omega,
            pole_sum,
            pole_product,
            pole,
            a,
            ab,
            noise_gain: 0.0,
        };
        this.noise_gain = this.noise();
        let lag = this.lag(spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz);
        if lag > 0.3 {
            let limit = spec.sensor.speed_max_periods_per_s * 0.3 / lag;
            return refuse(
                "sensor.speed_max_periods_per_s",
                spec.sensor.speed_max_periods_per_s,
                format!("{} with this loop", at_most(limit)),
                "a type 1 loop lags at speed, and here by more than 0.3 rad; take type 2 or a wider loop",
            );
        }
        Ok(this)
    }

    /// Steady output of the phase detector, the sine of the lag, at `rate` turns per sample. 0 for type 2.
    #[must_use]
    pub fn lag(&self, rate: f64) -> f64 {
        (1.0 - self.pole) * rate / self.ab
    }

    fn noise(&self) -> f64 {
        let (b1, b0) = (TAU * self.a, TAU * (self.ab - self.a));
        let (mut y1, mut y2, mut u1, mut u2, mut sum) = (0.0, 0.0, 1.0, 0.0, 0.0);
        let steps = (40.0 / self.omega) as usize + 100;
        for _ in 0..steps {
            let y = self.pole_sum * y1 - self.pole_product * y2 + b1 * u1 + b0 * u2;
            sum += y * y;
            (y2, y1) = (y1, y);
            (u2, u1) = (u1, 0.0);
        }
        sum
    }
}

impl Acquisition {
    /// The widest loop that is still well damped. Nearer to g = 1 its sensitivity comes near 2 for the errors of a sensor that is
    /// not yet calibrated, at two cycles per period and top speed: it follows, but never looks like it, or goes astray in the
    /// next gear. Type 1 loops are not widened: their damping would suffer.
    pub(super) fn new(spec: &Spec, tracking: &Loop) -> Self {
        if spec.tracking.filter_type == 1 {
            return Self { gears: 0 };
        }
        let wide = |shift: i32| {
            let (g, h) = (
                TAU * tracking.a * 2f64.powi(shift),
                TAU * tracking.ab * 4f64.powi(shift),
            );
            // z² + (g − 2) z + 1 − g + h
            let (linear, constant) = (g - 2.0, 1.0 - g + h);
            let discriminant = linear * linear / 4.0 - constant;
            let radius = if discriminant < 0.0 {
                constant.sqrt()
            } else {
                linear.abs() / 2.0 + discriminant.sqrt()
            };
            radius < 0.85 && g < 0.8
        };
        let most = (1..24).rev().find(|&shift| wide(shift)).unwrap_or(0) as u32;
        Self { gears: most }
    }
}
