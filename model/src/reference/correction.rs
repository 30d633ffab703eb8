//! The corrections of sections 5.2 to 5.4: M and what it makes of a pair.

/// Which parameters correct the pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterSet {
    /// Gains and offsets, equation (6).
    Four,
    /// And the phase, equation (7).
    Five,
    /// Cubic polynomials of each channel, section 5.4.
    Eight,
    /// And the phase: θ9 y_c in the sine.
    Nine,
}

impl ParameterSet {
    /// How many there are.
    #[must_use]
    pub fn len(self) -> usize {
        match self {
            Self::Four => 4,
            Self::Five => 5,
            Self::Eight => 8,
            Self::Nine => 9,
        }
    }

    /// Never.
    #[must_use]
    pub fn is_empty(self) -> bool {
        false
    }

    /// Θ that changes nothing but the amplitude: gains `gain`, all else zero.
    #[must_use]
    pub fn nominal(self, gain: f64) -> Vec<f64> {
        let mut theta = vec![0.0; self.len()];
        theta[0] = gain;
        theta[if self.len() < 8 { 2 } else { 4 }] = gain;
        theta
    }

    /// The columns of M: the derivative of (c, s) by each parameter.
    #[must_use]
    pub fn columns(self, y_c: f64, y_s: f64) -> Vec<[f64; 2]> {
        let cubic = |y: f64| [y, y * y, y * y * y, 1.0];
        match self {
            Self::Four => vec![[y_c, 0.0], [1.0, 0.0], [0.0, y_s], [0.0, 1.0]],
            Self::Five => vec![[y_c, 0.0], [1.0, 0.0], [0.0, y_s], [0.0, 1.0], [0.0, y_c]],
            Self::Eight | Self::Nine => {
                let mut all: Vec<[f64; 2]> = cubic(y_c).map(|m| [m, 0.0]).to_vec();
                all.extend(cubic(y_s).map(|m| [0.0, m]));
                if self == Self::Nine {
                    all.push([0.0, y_c]);
                }
                all
            }
        }
    }

    /// The corrected pair M Θ.
    #[must_use]
    pub fn correct(self, theta: &[f64], y_c: f64, y_s: f64) -> (f64, f64) {
        let columns = self.columns(y_c, y_s);
        let sum = |row: usize| -> f64 {
            columns
                .iter()
                .zip(theta)
                .map(|(m, theta)| m[row] * theta)
                .sum()
        };
        (sum(0), sum(1))
    }
}
