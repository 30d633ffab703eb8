//! Applying Θ: the parameter sets of sections 5.2 to 5.4 and their matrix M.
//!
//! The corrected pair is M Θ in the paper's sets, which are linear in Θ. The Chebyshev sets are not: there M is the
//! derivative of the corrected pair with respect to Θ, which is what every gradient needs it for.

use nalgebra::{SMatrix, SVector};

/// Parameters θ1 … θ9; those that a set does not have are zero.
pub type Theta = SVector<f64, 9>;

/// Derivative of the corrected pair (rows cos, sin) with respect to Θ; the paper's M where that is linear.
pub type Jacobian = SMatrix<f64, 2, 9>;

/// Which parameters are calibrated, and how they correct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameters {
    /// (6): c = θ1 y_c + θ2, s = θ3 y_s + θ4.
    Four,
    /// (7): as four, and s + θ5 y_c.
    Five,
    /// Section 5.4: c = θ1 y_c + θ2 y_c² + θ3 y_c³ + θ4, s likewise with θ5 … θ8.
    Eight,
    /// As eight, and s + θ9 y_c: equation (7) carried over.
    Nine,
    /// u = θ1 y_c + θ4, c = u + θ2 T2(u) + θ3 T3(u), s likewise with θ5 … θ8: offset and gain first, then the bend in
    /// Chebyshev polynomials. The same curves as eight, but directions that hardly disturb each other.
    ChebyshevEight,
    /// As [`ChebyshevEight`](Self::ChebyshevEight), and s + θ9 c with c the *corrected* cosine: phase after bending.
    ChebyshevNine,
    /// u = θ1 y_c + θ2, c = u + θ6 T2(u) + θ8 T3(u) + θ9 (T3(u) − u); v = θ3 y_s + θ4, s likewise with θ7, θ8 and −θ9: the
    /// curves of Chebyshev eight, split into what the third orders have in common and what is opposite in them, which no
    /// radius shows. M is taken at the estimate, without bends, as the chip does: see [`at_estimate`](Self::at_estimate).
    SplitEight,
    /// As [`SplitEight`](Self::SplitEight), and s + θ5 c.
    SplitNine,
}

impl Parameters {
    /// Every set of the paper, and those in Chebyshev polynomials.
    pub const ALL: [Self; 6] = [
        Self::Four,
        Self::Five,
        Self::Eight,
        Self::Nine,
        Self::ChebyshevEight,
        Self::ChebyshevNine,
    ];

    /// How many parameters the set has.
    #[must_use]
    pub fn count(self) -> usize {
        match self {
            Self::Four => 4,
            Self::Five => 5,
            Self::Eight | Self::ChebyshevEight | Self::SplitEight => 8,
            Self::Nine | Self::ChebyshevNine | Self::SplitNine => 9,
        }
    }

    /// Where the gains and offsets stand: (θ of y_c, offset of c, θ of y_s, offset of s), counted from 0.
    #[must_use]
    pub fn linear(self) -> [usize; 4] {
        match self {
            Self::Four | Self::Five | Self::SplitEight | Self::SplitNine => [0, 1, 2, 3],
            _ => [0, 3, 4, 7],
        }
    }

    /// 1 where a parameter is of the ellipse, 0 where it is of a bend.
    #[must_use]
    pub fn of_ellipse(self) -> Theta {
        let linear = self.linear();
        Theta::from_fn(|i, _| f64::from(linear.contains(&i) || self.phase() == Some(i)))
    }

    /// Where the phase stands, counted from 0; `None`: it is not calibrated.
    #[must_use]
    pub fn phase(self) -> Option<usize> {
        match self {
            Self::Five | Self::SplitNine => Some(4),
            Self::Nine | Self::ChebyshevNine => Some(8),
            Self::Four | Self::Eight | Self::ChebyshevEight | Self::SplitEight => None,
        }
    }

    /// What of the third orders both channels have in common, as a direction; zero where they have none in Chebyshev polynomials.
    #[must_use]
    pub fn common_third(self) -> Theta {
        let mut theta = Theta::zeros();
        match self {
            Self::ChebyshevEight | Self::ChebyshevNine => (theta[2], theta[6]) = (0.5, 0.5),
            Self::SplitEight | Self::SplitNine => theta[7] = 1.0,
            Self::Four | Self::Five | Self::Eight | Self::Nine => {}
        }
        theta
    }

    /// Θ for a sensor of this amplitude without errors.
    #[must_use]
    pub fn nominal(self, amplitude: f64) -> Theta {
        let mut theta = Theta::zeros();
        let [cos, _, sin, _] = self.linear();
        theta[cos] = 1.0 / amplitude;
        theta[sin] = 1.0 / amplitude;
        theta
    }

    /// The five parameters of section 5.3 as a Θ of this set; the phase θ5 is lost in sets without phase. Exact for
    /// sensors without bend: in the Chebyshev sets θ9 c stands for θ5 y_c + its share of the offset.
    #[must_use]
    pub fn from_five(self, five: [f64; 5]) -> Theta {
        let [t1, t2, t3, t4, t5] = five;
        let mut theta = Theta::zeros();
        let [gain_c, offset_c, gain_s, offset_s] = self.linear();
        theta[gain_c] = t1;
        theta[offset_c] = t2;
        theta[gain_s] = t3;
        theta[offset_s] = t4;
        match self {
            Self::Five => theta[4] = t5,
            Self::Nine => theta[8] = t5,
            Self::ChebyshevNine | Self::SplitNine => {
                // θ5 y_c = (θ5/θ1) (c − θ2)
                theta[if self == Self::SplitNine { 4 } else { 8 }] = t5 / t1;
                theta[offset_s] = t4 - t5 / t1 * t2;
            }
            _ => {}
        }
        theta
    }

    /// The corrected pair (c, s).
    #[must_use]
    pub fn corrected(self, theta: &Theta, y: [f64; 2]) -> [f64; 2] {
        let x = match self {
            Self::ChebyshevEight | Self::ChebyshevNine => {
                let c = bend(theta, 0, y[0]).value;
                let s = bend(theta, 4, y[1]).value + theta[8] * c;
                return [c, s];
            }
            Self::SplitEight | Self::SplitNine => {
                let channel = |gain: usize, second: usize, opposite: f64| {
                    let u = theta[gain] * y[gain / 2] + theta[gain + 1];
                    let (t2, t3) = chebyshev(u);
                    u + theta[second] * t2 + theta[7] * t3 + opposite * (t3 - u)
                };
                let c = channel(0, 5, theta[8]);
                return [c, channel(2, 6, -theta[8]) + theta[4] * c];
            }
            _ => self.jacobian(theta, y) * theta,
        };
        [x[0], x[1]]
    }

    /// ∂(c, s)/∂Θ at this sample; M of (6), (7) and section 5.4, independent of Θ there.
    #[must_use]
    pub fn jacobian(self, theta: &Theta, y: [f64; 2]) -> Jacobian {
        let [c, s] = y;
        let mut m = Jacobian::zeros();
        match self {
            Self::Four | Self::Five => {
                (m[(0, 0)], m[(0, 1)]) = (c, 1.0);
                (m[(1, 2)], m[(1, 3)]) = (s, 1.0);
                if self == Self::Five {
                    m[(1, 4)] = c;
                }
            }
            Self::Eight | Self::Nine => {
                for (row, y) in [(0, c), (1, s)] {
                    for (i, entry) in [y, y * y, y * y * y, 1.0].into_iter().enumerate() {
                        m[(row, 4 * row + i)] = entry;
                    }
                }
                if self == Self::Nine {
                    m[(1, 8)] = c;
                }
            }
            Self::ChebyshevEight | Self::ChebyshevNine => {
                let (cos, sin) = (bend(theta, 0, c), bend(theta, 4, s));
                for i in 0..4 {
                    m[(0, i)] = cos.gradient[i];
                    m[(1, 4 + i)] = sin.gradient[i];
                    if self == Self::ChebyshevNine {
                        m[(1, i)] = theta[8] * cos.gradient[i];
                    }
                }
                if self == Self::ChebyshevNine {
                    m[(1, 8)] = cos.value;
                }
            }
            Self::SplitEight | Self::SplitNine => {
                let [c, s] = self.corrected(theta, y);
                let (sin, cos) = s.atan2(c).sin_cos();
                return self.at_estimate(theta, y, (cos, sin));
            }
        }
        m
    }

    /// The same where α̂ is known: of the split sets with (cos α̂, sin α̂) in the place of u, v and the corrected cosine, and without
    /// the bends and the phase's share of the cosine's parameters, which are small. T2 is cos 2α̂ and −cos 2α̂ then, T3 cos 3α̂ and −sin 3α̂.
    #[must_use]
    pub fn at_estimate(self, theta: &Theta, y: [f64; 2], (cos, sin): (f64, f64)) -> Jacobian {
        if !matches!(self, Self::SplitEight | Self::SplitNine) {
            return self.jacobian(theta, y);
        }
        let mut m = Jacobian::zeros();
        for (row, u, sign) in [(0, cos, 1.0), (1, sin, -1.0)] {
            let (t2, t3) = chebyshev(u);
            (m[(row, 2 * row)], m[(row, 2 * row + 1)]) = (y[row], 1.0);
            m[(row, 5 + row)] = t2;
            (m[(row, 7)], m[(row, 8)]) = (t3, sign * (t3 - u));
        }
        if self == Self::SplitNine {
            m[(1, 4)] = cos;
        }
        m
    }

    /// The direction v in which Θ changes no radius, for sets with a cubic; `None` for four and five.
    ///
    /// cos⁴ − sin⁴ = cos² − sin²: the change (cos³α − cos α, sin α − sin³α) is tangential everywhere and moves the angle
    /// by ½ sin 2α per unit. In the raw signals of amplitude a and offset b, with g = 1/a and o = −b/a,
    /// v = (3go² − g, 3g²o, g³, o³ − o) for the cosine and its negative for the sine: −1/a and 1/a³ without offset.
    /// Exact where the signals are orthogonal (β = 0) and the present bend is small.
    #[must_use]
    pub fn null_direction(self, theta: &Theta) -> Option<Theta> {
        let mut v = Theta::zeros();
        for (first, sign) in [(0, 1.0), (4, -1.0)] {
            let (g, o) = (theta[first], theta[first + 3]);
            let channel = match self {
                Self::Four | Self::Five => return None,
                // (T3(u) − u)/4 of one channel, less that of the other.
                Self::SplitEight | Self::SplitNine => {
                    v[8] = 0.25;
                    return Some(v);
                }
                Self::Eight | Self::Nine => [
                    3.0 * g * o * o - g,
                    3.0 * g * g * o,
                    g * g * g,
                    o * o * o - o,
                ],
                // u³ − u = (T3(u) − u)/4
                Self::ChebyshevEight | Self::ChebyshevNine => [-g / 4.0, 0.0, 0.25, -o / 4.0],
            };
            for (i, entry) in channel.into_iter().enumerate() {
                v[first + i] = sign * entry;
            }
        }
        Some(v)
    }
}

/// T2 and T3.
fn chebyshev(u: f64) -> (f64, f64) {
    (2.0 * u * u - 1.0, 4.0 * u * u * u - 3.0 * u)
}

struct Bend {
    value: f64,
    /// With respect to gain, T2, T3 and offset.
    gradient: [f64; 4],
}

/// u + θ T2(u) + θ T3(u) with u = gain · y + offset; the four parameters stand in Θ from `first` on.
fn bend(theta: &Theta, first: usize, y: f64) -> Bend {
    let [gain, second, third, offset] = [0, 1, 2, 3].map(|i| theta[first + i]);
    let u = gain * y + offset;
    let (t2, t3) = chebyshev(u);
    let slope = 1.0 + second * 4.0 * u + third * (12.0 * u * u - 3.0);
    Bend {
        value: u + second * t2 + third * t3,
        gradient: [slope * y, t2, t3, slope],
    }
}
