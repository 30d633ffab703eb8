//! The parameter sets of sections 5.2 to 5.4 as polynomials of the channels.

use nalgebra::{DMatrix, DVector, Matrix2, SMatrix};
use nonius_recording::Ellipse;

/// Which parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Gains and offsets, equation (6).
    Four,
    /// And the phase, equation (7).
    Five,
    /// Cubic polynomials of each channel, 5.4.
    Eight,
    /// And the phase, after the bending: s = θ5 y_s + θ6 y_s² + θ7 y_s³ + θ8 + θ9 c, with c the corrected cosine.
    Nine,
}

/// The change of the first eight of Θ, for signals of amplitude 1, that turns the angle by ½ sin 2α per unit and leaves
/// the radius alone: δc = −c + c³, δs = s − s³, and c δc + s δs = 0 on the unit circle.
pub const BLIND: [f64; 8] = [-1.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0];

impl Set {
    /// Number of parameters.
    #[must_use]
    pub fn parameters(self) -> usize {
        match self {
            Self::Four => 4,
            Self::Five => 5,
            Self::Eight => 8,
            Self::Nine => 9,
        }
    }

    /// Whether channels are bent.
    #[must_use]
    pub fn cubic(self) -> bool {
        matches!(self, Self::Eight | Self::Nine)
    }

    /// The corrected pair.
    #[must_use]
    pub fn correct(self, theta: &[f64], y_c: f64, y_s: f64) -> (f64, f64) {
        let cubic = |t: &[f64], y: f64| ((t[2] * y + t[1]) * y + t[0]) * y + t[3];
        match self {
            Self::Four => (theta[0] * y_c + theta[1], theta[2] * y_s + theta[3]),
            Self::Five => (
                theta[0] * y_c + theta[1],
                theta[2] * y_s + theta[3] + theta[4] * y_c,
            ),
            Self::Eight => (cubic(&theta[..4], y_c), cubic(&theta[4..8], y_s)),
            Self::Nine => {
                let c = cubic(&theta[..4], y_c);
                (c, cubic(&theta[4..8], y_s) + theta[8] * c)
            }
        }
    }

    /// What of the cosine stands in the sine: of the signal with five parameters, of the corrected cosine with nine; else 0.
    pub(crate) fn cross(self, theta: &[f64]) -> f64 {
        match self {
            Self::Four | Self::Eight => 0.0,
            Self::Five => theta[4],
            Self::Nine => theta[8],
        }
    }

    /// Derivative of (c, s) by Θ: M, with zeros for what the set has not.
    pub(crate) fn jacobian(self, theta: &[f64], y_c: f64, y_s: f64) -> SMatrix<f64, 2, 9> {
        let cross = self.cross(theta);
        let mut m = SMatrix::zeros();
        match self {
            Self::Four | Self::Five => {
                (m[(0, 0)], m[(0, 1)]) = (y_c, 1.0);
                (m[(1, 2)], m[(1, 3)]) = (y_s, 1.0);
                if self == Self::Five {
                    m[(1, 4)] = y_c;
                }
            }
            Self::Eight | Self::Nine => {
                for (row, y) in [(0, y_c), (1, y_s)] {
                    for (i, entry) in [y, y * y, y * y * y, 1.0].into_iter().enumerate() {
                        m[(row, 4 * row + i)] = entry;
                    }
                }
                if self == Self::Nine {
                    for i in 0..4 {
                        m[(1, i)] = cross * m[(0, i)];
                    }
                    m[(1, 8)] = self.correct(theta, y_c, y_s).0;
                }
            }
        }
        m
    }

    /// Derivative of (c, s) by the signals.
    pub(crate) fn slope_by_signals(self, theta: &[f64], y_c: f64, y_s: f64) -> Matrix2<f64> {
        let cross = self.cross(theta);
        let cubic = |t: &[f64], y: f64| (3.0 * t[2] * y + 2.0 * t[1]) * y + t[0];
        match self {
            Self::Four | Self::Five => Matrix2::new(theta[0], 0.0, cross, theta[2]),
            Self::Eight | Self::Nine => {
                let own = cubic(&theta[..4], y_c);
                Matrix2::new(own, 0.0, cross * own, cubic(&theta[4..8], y_s))
            }
        }
    }

    /// The ellipse about which the set searches: one without phase, where it has none.
    pub(crate) fn frame(self, ellipse: &Ellipse) -> Ellipse {
        Ellipse {
            beta: match self {
                Self::Five | Self::Nine => ellipse.beta,
                Self::Four | Self::Eight => 0.0,
            },
            ..*ellipse
        }
    }

    /// Derivative of ‖(c, s)‖² by Θ.
    pub(crate) fn slope(self, theta: &[f64], y_c: f64, y_s: f64, out: &mut [f64]) {
        let (c, s) = self.correct(theta, y_c, y_s);
        let m = self.jacobian(theta, y_c, y_s);
        for (to, by) in out.iter_mut().zip(m.column_iter()) {
            *to = 2.0 * (c * by[0] + s * by[1]);
        }
    }

    /// Unit of each parameter: 1/column^power.
    #[must_use]
    pub fn powers(self) -> Vec<i32> {
        let all = match self {
            Self::Four | Self::Five => [1, 0, 1, 0, 1, 0, 0, 0, 0],
            Self::Eight | Self::Nine => [1, 2, 3, 0, 1, 2, 3, 0, 0],
        };
        all[..self.parameters()].to_vec()
    }

    /// Θ that does nothing to signals normalised by `frame`, but for the phase.
    pub(crate) fn start(self, frame: &Ellipse) -> DVector<f64> {
        let (cos, tan) = (frame.beta.cos(), frame.beta.tan());
        DVector::from_vec(match self {
            Self::Four => vec![1.0, 0.0, 1.0, 0.0],
            Self::Five => vec![1.0, 0.0, 1.0 / cos, 0.0, tan],
            Self::Eight => vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            Self::Nine => vec![1.0, 0.0, 0.0, 0.0, 1.0 / cos, 0.0, 0.0, 0.0, tan],
        })
    }

    /// Orthogonal directions in which to search: all but the blind one.
    pub(crate) fn directions(self) -> DMatrix<f64> {
        let n = self.parameters();
        if !self.cubic() {
            return DMatrix::identity(n, n);
        }
        let blind = DVector::from_fn(n, |i, _| BLIND.get(i).copied().unwrap_or(0.0)).normalize();
        // A reflection that turns the first axis into the blind direction; its other columns are orthogonal to it.
        let mut mirror = -blind;
        mirror[0] += 1.0;
        let mirror = mirror.normalize();
        let reflection = DMatrix::identity(n, n) - &mirror * mirror.transpose() * 2.0;
        reflection.columns(1, n - 1).into_owned()
    }

    /// Θ of normalised signals as a linear map to Θ of raw ones: u = (y − b)/a put into the polynomials.
    pub(crate) fn to_raw(self, frame: &Ellipse) -> DMatrix<f64> {
        let n = self.parameters();
        let mut map = DMatrix::zeros(n, n);
        let channel = |a: f64, b: f64| (1.0 / a, -b / a);
        let (c, s) = (channel(frame.a_c, frame.b_c), channel(frame.a_s, frame.b_s));
        match self {
            Self::Four | Self::Five => {
                for (i, (g, h)) in [(0, c), (2, s)] {
                    map[(i, i)] = g;
                    map[(i + 1, i)] = h;
                    map[(i + 1, i + 1)] = 1.0;
                }
                if self == Self::Five {
                    map[(4, 4)] = c.0;
                    map[(3, 4)] = c.1;
                }
            }
            Self::Eight | Self::Nine => {
                for (i, (g, h)) in [(0, c), (4, s)] {
                    // Rows y, y², y³, 1; columns u, u², u³, 1 with u = g y + h.
                    let block = [
                        [g, 2.0 * g * h, 3.0 * g * h * h, 0.0],
                        [0.0, g * g, 3.0 * g * g * h, 0.0],
                        [0.0, 0.0, g * g * g, 0.0],
                        [h, h * h, h * h * h, 1.0],
                    ];
                    for (r, row) in block.iter().enumerate() {
                        for (k, value) in row.iter().enumerate() {
                            map[(i + r, i + k)] = *value;
                        }
                    }
                }
                if self == Self::Nine {
                    map[(8, 8)] = 1.0;
                }
            }
        }
        map
    }
}
