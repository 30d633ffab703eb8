//! The digital filter of section 4: Methods 1, 2 and 3, in the paper's own form.
//!
//! Order: second, closed by the phase detector. Input: e in radians. Output: α̂ of the next sample in radians, speed in
//! radians per second. Sign: a positive e makes α̂ grow.

use std::f64::consts::{PI, TAU};

use nalgebra::Complex;

use super::poles::Poles;
use super::{ReferenceError, require};

/// Equation (2): (z a + b) / (z² + z c + d).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filter {
    /// a.
    pub a: f64,
    /// b.
    pub b: f64,
    /// c.
    pub c: f64,
    /// d.
    pub d: f64,
}

/// How many filter poles are at 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterType {
    /// One, so that a step leaves no error; the second pole is free.
    One {
        /// The second pole; −1 < p < 1.
        pole: f64,
    },
    /// Two, so that a ramp leaves no error either.
    Two,
}

/// The paper's three methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// 4.1: second-order filter; speed by taking the difference of the position.
    One(FilterType),
    /// 4.2: first-order stage and integrator; type 1, its second pole is p1 p2.
    Two,
    /// 4.3: second-order stage and integrator; Method 1's coefficients, speed without a difference.
    Three(FilterType),
}

impl Filter {
    /// Section 4.1: the numerator that places the closed loop's poles, given the denominator.
    ///
    /// # Errors
    /// The second pole of type 1 must lie inside the unit circle.
    pub fn placing(poles: &Poles, filter_type: FilterType) -> Result<Self, ReferenceError> {
        let (c, d) = match filter_type {
            FilterType::Two => (-2.0, 1.0),
            FilterType::One { pole } => {
                let reason = "the second filter pole lies inside the unit circle; a second pole at 1 is type 2";
                require(pole.abs() < 1.0, "filter pole", pole, reason)?;
                (-(1.0 + pole), pole)
            }
        };
        Ok(Self {
            a: -poles.sum() - c,
            b: poles.product() - d,
            c,
            d,
        })
    }

    /// G_filter(z).
    #[must_use]
    pub fn transfer(&self, z: Complex<f64>) -> Complex<f64> {
        (z * self.a + self.b) / (z * z + z * self.c + self.d)
    }

    /// Equation (3): G_cl = G / (1 + G), from α to α̂.
    #[must_use]
    pub fn closed_loop(&self, z: Complex<f64>) -> Complex<f64> {
        let g = self.transfer(z);
        g / (g + 1.0)
    }

    /// S = 1 − G_cl, from α to e.
    #[must_use]
    pub fn sensitivity(&self, z: Complex<f64>) -> Complex<f64> {
        (self.transfer(z) + 1.0).inv()
    }

    /// Sum and product of the closed loop's poles: D_cl = z² + (c + a) z + d + b.
    #[must_use]
    pub fn closed_loop_poles(&self) -> (f64, f64) {
        (-(self.c + self.a), self.d + self.b)
    }
}

/// Coefficients of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopConfig {
    /// The method.
    pub method: Method,
    /// The filter from e to α̂, whatever the method: equation (2), also for Methods 2 and 3.
    pub filter: Filter,
    /// Sample time, seconds.
    pub ts: f64,
}

impl LoopConfig {
    /// Works the coefficients out.
    ///
    /// # Errors
    /// What the paper says is impossible; ts must be positive.
    pub fn new(method: Method, poles: &Poles, ts: f64) -> Result<Self, ReferenceError> {
        require(
            ts > 0.0 && ts.is_finite(),
            "t_s",
            ts,
            "a sample time is positive",
        )?;
        let filter = match method {
            Method::One(kind) | Method::Three(kind) => Filter::placing(poles, kind)?,
            Method::Two => {
                // a/(z − b) · ts z/(z − 1), a ts = p1p2 − p1 − p2 + 1, b = p1p2.
                let (a, b) = Self::method_2(poles, ts);
                let reason = "Method 2 takes its filter pole from p1 p2, which must lie inside the unit circle";
                require(b.abs() < 1.0, "p1 p2", b, reason)?;
                Filter {
                    a: a * ts,
                    b: 0.0,
                    c: -(1.0 + b),
                    d: b,
                }
            }
        };
        Ok(Self { method, filter, ts })
    }

    /// As [`new`](Self::new), from what a user writes: method 1, 2 or 3, type 1 or 2, a pole for type 1 (p1 p2 where
    /// none is given, which makes Methods 1 and 3 equal to Method 2).
    ///
    /// # Errors
    /// Methods other than 1, 2, 3, types other than 1, 2, Method 2 with type 2 or with a pole of its own.
    pub fn named(
        method: u32,
        filter_type: u32,
        pole: Option<f64>,
        poles: &Poles,
        ts: f64,
    ) -> Result<Self, ReferenceError> {
        let kind = match (filter_type, pole) {
            (1, pole) => FilterType::One {
                pole: pole.unwrap_or(poles.product()),
            },
            (2, None) => FilterType::Two,
            (2, Some(_)) => {
                return Err(ReferenceError::Impossible(
                    "a type 2 filter has both poles at 1: none is left to choose",
                ));
            }
            _ => {
                return Err(ReferenceError::Impossible(
                    "a second-order filter is of type 1 or 2",
                ));
            }
        };
        let method = match (method, kind, pole) {
            (1, kind, _) => Method::One(kind),
            (3, kind, _) => Method::Three(kind),
            (2, FilterType::One { .. }, None) => Method::Two,
            (2, FilterType::Two, _) => {
                return Err(ReferenceError::Impossible(
                    "Method 2 uses its filter pole to place the closed loop's poles; a type 2 filter is impossible (4.2)",
                ));
            }
            (2, ..) => {
                return Err(ReferenceError::Impossible(
                    "the second filter pole of Method 2 cannot be freely chosen (4.2)",
                ));
            }
            _ => {
                return Err(ReferenceError::Impossible(
                    "the paper has Methods 1, 2 and 3",
                ));
            }
        };
        Self::new(method, poles, ts)
    }

    /// a and b of section 4.2.
    #[must_use]
    pub fn method_2(poles: &Poles, ts: f64) -> (f64, f64) {
        ((poles.product() - poles.sum() + 1.0) / ts, poles.product())
    }

    /// The steady error e, radians, at constant speed v, radians per second: zero for type 2.
    ///
    /// Final value of the ramp v ts z/(z − 1)² through (z − 1)(z − p)/D_cl(z): v ts (1 − p)/D_cl(1), D_cl(1) = a + b.
    #[must_use]
    pub fn lag(&self, speed: f64) -> f64 {
        let Filter { a, b, d, .. } = self.filter;
        speed * self.ts * (1.0 - d) / (a + b)
    }
}

/// State of a loop between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopState {
    /// Whole turns taken out of the phases, so that hours of travel cost no resolution. The filter's equations hold
    /// for what remains as they hold for α̂, because 1 + c + d = 0 in every type.
    turns: i64,
    /// α̂_k less the turns, radians.
    alpha_hat: f64,
    /// α̂_{k−1} less the same turns (Method 1).
    alpha_hat_1: f64,
    /// Output of the first stage: the speed, radians per second (Methods 2 and 3).
    v: f64,
    /// e_{k−1}, radians (Methods 1 and 3).
    e_1: f64,
}

/// A loop: configuration and state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// The coefficients.
    pub config: LoopConfig,
    state: LoopState,
}

impl Loop {
    /// A loop at rest at α̂ = 0.
    #[must_use]
    pub fn new(config: LoopConfig) -> Self {
        Self::moving(config, 0.0, 0.0, 0.0)
    }

    /// A loop at α̂ (radians) that moves at this speed (radians per second), with e_{k−1}.
    #[must_use]
    pub fn moving(config: LoopConfig, alpha_hat: f64, speed: f64, e_1: f64) -> Self {
        let mut this = Self {
            config,
            state: LoopState {
                turns: 0,
                alpha_hat,
                alpha_hat_1: alpha_hat - speed * config.ts,
                v: speed,
                e_1,
            },
        };
        this.take_out_turns();
        this
    }

    /// α̂_k, unwrapped, radians.
    #[must_use]
    pub fn alpha_hat(&self) -> f64 {
        self.state.turns as f64 * TAU + self.state.alpha_hat
    }

    /// α̂_k as whole turns and the phase, −π … π, that remains.
    #[must_use]
    pub fn turns_and_phase(&self) -> (i64, f64) {
        (self.state.turns, self.state.alpha_hat)
    }

    /// The speed estimate, radians per second: the difference of the position in Method 1, the first stage's output in
    /// the others.
    #[must_use]
    pub fn speed(&self) -> f64 {
        match self.config.method {
            Method::One(_) => (self.state.alpha_hat - self.state.alpha_hat_1) / self.config.ts,
            Method::Two | Method::Three(_) => self.state.v,
        }
    }

    /// Takes e_k, goes from α̂_k to α̂_{k+1}.
    pub fn advance(&mut self, e: f64) {
        let LoopConfig { method, filter, ts } = self.config;
        let LoopState {
            alpha_hat,
            alpha_hat_1,
            v,
            e_1,
            ..
        } = self.state;
        let Filter { a, b, c, d } = filter;
        let s = &mut self.state;
        match method {
            // (9)
            Method::One(_) => s.alpha_hat = -c * alpha_hat - d * alpha_hat_1 + a * e + b * e_1,
            // a/(z − b), then ts z/(z − 1); here a = filter.a/ts and b = filter.d.
            Method::Two => {
                s.v = d * v + a / ts * e;
                s.alpha_hat = alpha_hat + ts * s.v;
            }
            // (z a + b)/(ts z (z − p)), then ts z/(z − 1); p = d. The pole and the zero at the origin cancel.
            Method::Three(_) => {
                s.v = d * v + (a * e + b * e_1) / ts;
                s.alpha_hat = alpha_hat + ts * s.v;
            }
        }
        s.alpha_hat_1 = alpha_hat;
        s.e_1 = e;
        self.take_out_turns();
    }

    fn take_out_turns(&mut self) {
        let s = &mut self.state;
        if s.alpha_hat.abs() > PI && s.alpha_hat.is_finite() {
            let turns = (s.alpha_hat / TAU).round();
            s.alpha_hat -= turns * TAU;
            s.alpha_hat_1 -= turns * TAU;
            s.turns += turns as i64;
        }
    }
}

/// Section 3: e = s cos α̂ − c sin α̂ ≈ α − α̂.
#[must_use]
pub fn phase_detector(corrected: [f64; 2], alpha_hat: f64) -> f64 {
    let (sin, cos) = alpha_hat.sin_cos();
    corrected[1] * cos - corrected[0] * sin
}
