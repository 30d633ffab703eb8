//! The sensor: equations (1) and (4), and what Θ means in its terms.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::{ReferenceError, require};

/// Equation (4): amplitudes, offsets and phase error of the signal pair. Amplitudes and offsets in the unit of the
/// signals, β in radians, |β| < π/2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Amplitude of the cosine channel.
    pub a_c: f64,
    /// Offset of the cosine channel.
    pub b_c: f64,
    /// Amplitude of the sine channel.
    pub a_s: f64,
    /// Offset of the sine channel.
    pub b_s: f64,
    /// Phase error: the sine channel lags by it.
    pub beta: f64,
}

impl Sensor {
    /// Amplitude 1, no error.
    pub const IDEAL: Self = Self {
        a_c: 1.0,
        b_c: 0.0,
        a_s: 1.0,
        b_s: 0.0,
        beta: 0.0,
    };

    /// Equation (4): (y_c, y_s) at the angle α, radians.
    #[must_use]
    pub fn signals(&self, alpha: f64) -> [f64; 2] {
        [
            self.a_c * alpha.cos() + self.b_c,
            self.a_s * (alpha - self.beta).sin() + self.b_s,
        ]
    }

    /// The five correction parameters of section 5.3. With β = 0 the first four are those of section 5.2.
    #[must_use]
    pub fn theta(&self) -> [f64; 5] {
        let (cos, tan) = (self.beta.cos(), self.beta.tan());
        [
            1.0 / self.a_c,
            -self.b_c / self.a_c,
            1.0 / (self.a_s * cos),
            -self.b_s / (self.a_s * cos) - self.b_c * tan / self.a_c,
            tan / self.a_c,
        ]
    }

    /// The sensor that these five parameters correct: the inverse of [`theta`](Self::theta).
    ///
    /// # Errors
    /// θ1 and θ3 must be positive, or there is no such sensor.
    pub fn from_theta(theta: [f64; 5]) -> Result<Self, ReferenceError> {
        let [t1, t2, t3, t4, t5] = theta;
        let reason = "a gain is positive and finite";
        require(t1 > 0.0 && t1.is_finite(), "theta_1", t1, reason)?;
        require(t3 > 0.0 && t3.is_finite(), "theta_3", t3, reason)?;
        let a_c = 1.0 / t1;
        let b_c = -t2 * a_c;
        let beta = (t5 * a_c).atan();
        let a_s = 1.0 / (t3 * beta.cos());
        // θ4 = −b_s/(a_s cos β) − b_c tan β/a_c, and θ3 is 1/(a_s cos β).
        let b_s = -(t4 + b_c * t5) / t3;
        Ok(Self {
            a_c,
            b_c,
            a_s,
            b_s,
            beta,
        })
    }

    /// Refuses what equation (4) cannot mean.
    ///
    /// # Errors
    /// Amplitudes must be positive, |β| below a quarter turn, all of it finite.
    pub fn check(&self) -> Result<(), ReferenceError> {
        for (what, a) in [("a_c", self.a_c), ("a_s", self.a_s)] {
            require(
                a > 0.0 && a.is_finite(),
                what,
                a,
                "an amplitude is positive",
            )?;
        }
        for (what, b) in [("b_c", self.b_c), ("b_s", self.b_s)] {
            require(b.is_finite(), what, b, "an offset is a number")?;
        }
        let reason = "at a quarter turn the two channels are one";
        require(self.beta.abs() < FRAC_PI_2, "beta", self.beta, reason)
    }
}

/// Equation (1): α = k x with k = 2π / l_period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Length of a signal period, metres (or any other unit of x).
    pub l_period: f64,
}

impl Scale {
    /// α in radians at the displacement x.
    #[must_use]
    pub fn angle(&self, x: f64) -> f64 {
        TAU / self.l_period * x
    }

    /// x = α / k: the displacement at the angle α, radians.
    #[must_use]
    pub fn displacement(&self, alpha: f64) -> f64 {
        alpha * self.l_period / TAU
    }
}
