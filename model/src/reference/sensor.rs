//! The signals, equation (4), and the five parameters that correct them, section 5.3.

/// Equation (4): y_c = a_c cos α + b_c, y_s = a_s sin(α − β) + b_s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// Amplitude of the cosine channel, in the unit of the signals.
    pub a_c: f64,
    /// Offset of the cosine channel.
    pub b_c: f64,
    /// Amplitude of the sine channel.
    pub a_s: f64,
    /// Offset of the sine channel.
    pub b_s: f64,
    /// Phase error β in radians, between −π/2 and π/2.
    pub beta: f64,
}

impl Sensor {
    /// The signals at the angle `alpha` in radians.
    #[must_use]
    pub fn signals(&self, alpha: f64) -> (f64, f64) {
        (
            self.a_c * alpha.cos() + self.b_c,
            self.a_s * (alpha - self.beta).sin() + self.b_s,
        )
    }

    /// Θ of section 5.3: cos α = θ1 y_c + θ2, sin α = θ3 y_s + θ4 + θ5 y_c.
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

    /// The sensor that `theta` corrects; θ1 and θ3 must not be zero.
    #[must_use]
    pub fn corrected_by(theta: [f64; 5]) -> Self {
        let [one, two, three, four, five] = theta;
        let (a_c, b_c) = (1.0 / one, -two / one);
        let beta = (five * a_c).atan();
        let a_s = 1.0 / (three * beta.cos());
        let b_s = -(four + b_c * beta.tan() / a_c) * a_s * beta.cos();
        Self {
            a_c,
            b_c,
            a_s,
            b_s,
            beta,
        }
    }
}
