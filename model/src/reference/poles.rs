//! The closed loop's poles (section 4.1).

use nalgebra::Complex;

use super::{ReferenceError, require};

/// Two poles in the z-plane: both real, or a conjugate pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Poles {
    /// p1.
    pub p1: Complex<f64>,
    /// p2.
    pub p2: Complex<f64>,
}

impl Poles {
    /// p1,2 = exp(−ω0 ts (ξ ∓ √(ξ² − 1))), ω0 in radians per second, ts in seconds. A conjugate pair for ξ < 1.
    ///
    /// # Errors
    /// ω0, ts and ξ must be positive: else the poles lie on or outside the unit circle. ω0 ts beyond π makes them alias.
    pub fn new(omega_0: f64, xi: f64, ts: f64) -> Result<Self, ReferenceError> {
        let positive = |what, x: f64| {
            let reason =
                "poles inside the unit circle need a positive frequency, damping and sample time";
            require(x > 0.0 && x.is_finite(), what, x, reason)
        };
        positive("omega_0", omega_0)?;
        positive("xi", xi)?;
        positive("t_s", ts)?;
        let reason = "beyond half the sample rate the poles alias";
        require(
            omega_0 * ts < std::f64::consts::PI,
            "omega_0 t_s",
            omega_0 * ts,
            reason,
        )?;
        let root = Complex::new(xi * xi - 1.0, 0.0).sqrt();
        let pole = |s: Complex<f64>| (s * (-omega_0 * ts)).exp();
        Ok(Self {
            p1: pole(Complex::from(xi) - root),
            p2: pole(Complex::from(xi) + root),
        })
    }

    /// Two real poles as they are.
    ///
    /// # Errors
    /// Both must lie inside the unit circle.
    pub fn real(p1: f64, p2: f64) -> Result<Self, ReferenceError> {
        for (what, p) in [("p1", p1), ("p2", p2)] {
            require(
                p.abs() < 1.0,
                what,
                p,
                "a stable loop has its poles inside the unit circle",
            )?;
        }
        Ok(Self {
            p1: p1.into(),
            p2: p2.into(),
        })
    }

    /// p1 + p2, real in either case.
    #[must_use]
    pub fn sum(&self) -> f64 {
        (self.p1 + self.p2).re
    }

    /// p1 p2, real in either case.
    #[must_use]
    pub fn product(&self) -> f64 {
        (self.p1 * self.p2).re
    }
}
