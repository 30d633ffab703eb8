//! Least squares of two amounts, one of each channel: how much of c and of s is in r.

use std::ops::{AddAssign, Sub};

/// Sums of c², c s, s², r c and r s.
#[derive(Clone, Copy, Default)]
pub(crate) struct PairSums([f64; 5]);

impl PairSums {
    /// Takes a sample.
    pub(crate) fn add(&mut self, c: f64, s: f64, r: f64, weight: f64) {
        let terms = [c * c, c * s, s * s, r * c, r * s];
        for (sum, term) in self.0.iter_mut().zip(terms) {
            *sum += weight * term;
        }
    }

    /// As if so many samples more had both channels and nothing of r.
    pub(crate) fn add_nothing(&mut self, samples: f64) {
        self.0[0] += samples;
        self.0[2] += samples;
    }

    /// The amounts; what is not seen, at standstill, is zero.
    pub(crate) fn amounts(&self) -> [f64; 2] {
        let [cc, cs, ss, rc, rs] = self.0;
        // A little of amounts of zero keeps them finite.
        let ridge = 1e-6 * (cc + ss) + f64::MIN_POSITIVE;
        let (cc, ss) = (cc + ridge, ss + ridge);
        let determinant = cc * ss - cs * cs;
        [
            (ss * rc - cs * rs) / determinant,
            (cc * rs - cs * rc) / determinant,
        ]
    }

    /// What these amounts take off the sum of r².
    pub(crate) fn explained(&self) -> f64 {
        let [c, s] = self.amounts();
        c * self.0[3] + s * self.0[4]
    }
}

impl AddAssign for PairSums {
    fn add_assign(&mut self, other: Self) {
        for (sum, more) in self.0.iter_mut().zip(other.0) {
            *sum += more;
        }
    }
}

impl Sub for PairSums {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - other.0[i]))
    }
}
