//! The three digital filters of section 4.

use super::Poles;

/// The paper's method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// 4.1: second-order filter, speed as the derivative of the position.
    One,
    /// 4.2: first-order stage and integrator.
    Two,
    /// 4.3: second-order stage and integrator.
    Three,
}

/// What section 4 says cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FilterError {
    /// Method 2 has no pole to spare.
    #[error(
        "Method 2 places the closed loop's poles with its filter pole: type 2 is impossible (4.2)"
    )]
    MethodTwoTypeTwo,
}

/// The filter with its coefficients and what it remembers. Estimates are in radians, unwrapped.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    method: Method,
    ts: f64,
    /// Coefficients of (2): numerator z a + b, denominator z² + z c + d.
    pub a: f64,
    /// See `a`.
    pub b: f64,
    /// See `a`.
    pub c: f64,
    /// See `a`.
    pub d: f64,
    alpha_hat: f64,
    alpha_hat_before: f64,
    speed: f64,
    e_before: f64,
}

impl Filter {
    /// A filter with these closed-loop poles. `second_pole` is the filter's pole besides the one at 1: 1 makes type 2.
    /// Method 2 has no such choice and takes `None`; for the others `None` is p1 p2.
    ///
    /// # Errors
    /// Method 2 with a second pole of its own.
    pub fn new(
        method: Method,
        poles: Poles,
        second_pole: Option<f64>,
        ts: f64,
    ) -> Result<Self, FilterError> {
        if method == Method::Two && second_pole.is_some() {
            return Err(FilterError::MethodTwoTypeTwo);
        }
        let p = second_pole.unwrap_or(poles.product);
        // (z − 1)(z − p)
        let (c, d) = (-(1.0 + p), p);
        Ok(Self {
            method,
            ts,
            a: -poles.sum - c,
            b: poles.product - d,
            c,
            d,
            alpha_hat: 0.0,
            alpha_hat_before: 0.0,
            speed: 0.0,
            e_before: 0.0,
        })
    }

    /// α̂_k in radians.
    #[must_use]
    pub fn alpha_hat(&self) -> f64 {
        self.alpha_hat
    }

    /// The estimate of the speed in radians per second.
    #[must_use]
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Starts from an angle in radians and a speed in radians per second.
    pub fn start(&mut self, alpha_hat: f64, speed: f64) {
        self.alpha_hat = alpha_hat;
        self.alpha_hat_before = alpha_hat - speed * self.ts;
        self.speed = speed;
        self.e_before = 0.0;
    }

    /// Takes over what another filter remembers.
    pub fn continue_from(&mut self, other: &Self) {
        self.start(other.alpha_hat, other.speed);
        self.e_before = other.e_before;
    }

    /// From e_k in radians to α̂_{k+1}.
    pub fn step(&mut self, e: f64) {
        let before = self.alpha_hat;
        match self.method {
            // Equation (9).
            Method::One => {
                let next = -self.c * self.alpha_hat - self.d * self.alpha_hat_before
                    + self.a * e
                    + self.b * self.e_before;
                self.speed = (next - before) / self.ts;
                self.alpha_hat = next;
            }
            // a/(z − b), then ts z/(z − 1); here the paper's a is a/ts and its b is d.
            Method::Two => {
                self.speed = self.d * self.speed + (self.a + self.b) / self.ts * e;
                self.alpha_hat += self.ts * self.speed;
            }
            // The numerator of (2) over ts z (z − p), then ts z/(z − 1).
            Method::Three => {
                self.speed = self.d * self.speed + (self.a * e + self.b * self.e_before) / self.ts;
                self.alpha_hat += self.ts * self.speed;
            }
        }
        self.alpha_hat_before = before;
        self.e_before = e;
    }
}
