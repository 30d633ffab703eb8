//! Shapes: what a unit of a cause does to the corrected pair.

/// A change of (c, s), sample by sample, to first order.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Change of the corrected cosine.
    pub c: Vec<f64>,
    /// Change of the corrected sine.
    pub s: Vec<f64>,
}

impl Shape {
    /// Nothing, for so many samples.
    #[must_use]
    pub fn zero(samples: usize) -> Self {
        Self {
            c: vec![0.0; samples],
            s: vec![0.0; samples],
        }
    }

    /// Along the radius and along the circle, at the angles of the pairs (`cos`, `sin`).
    #[must_use]
    pub fn rotated(&self, cos: &[f64], sin: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = cos.len();
        let radial = (0..n).map(|k| self.c[k] * cos[k] + self.s[k] * sin[k]);
        let tangential = (0..n).map(|k| self.s[k] * cos[k] - self.c[k] * sin[k]);
        (radial.collect(), tangential.collect())
    }

    /// A change along the radius.
    #[must_use]
    pub fn radial(change: &[f64], cos: &[f64], sin: &[f64]) -> Self {
        Self {
            c: change.iter().zip(cos).map(|(r, c)| r * c).collect(),
            s: change.iter().zip(sin).map(|(r, s)| r * s).collect(),
        }
    }

    /// A change of the angle in radians.
    #[must_use]
    pub fn tangential(change: &[f64], cos: &[f64], sin: &[f64]) -> Self {
        Self {
            c: change.iter().zip(sin).map(|(t, s)| -t * s).collect(),
            s: change.iter().zip(cos).map(|(t, c)| t * c).collect(),
        }
    }
}
