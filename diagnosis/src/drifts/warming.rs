//! What warms up, or settles: from some moment on it goes to its end as an exponential does, fast at first. Lines need many knots
//! for that and polynomials of a few numbers do not follow it, where this has four numbers. Here it is looked for on a grid.

use nalgebra::{DMatrix, DVector};

use crate::numerics::polygon::sampled;

/// Moments at which it may begin, evenly spaced over the recording.
const MOMENTS: usize = 20;
/// Time constants, in recordings: the shortest, the ratio of one to the one before, how many.
const SHORTEST: f64 = 0.03;
const RATIO: f64 = 1.35;
const CONSTANTS: usize = 12;

/// Courses that are looked at.
pub(crate) const COURSES: f64 = (MOMENTS * CONSTANTS) as f64;

/// A course that both channels follow.
#[derive(Clone, Copy)]
pub(crate) struct Warming {
    /// When it begins, and its time constant, in recordings.
    pub(crate) start: f64,
    pub(crate) tau: f64,
    /// Log-likelihood that it explains.
    gain: f64,
    /// Numbers of it, but for start and time constant.
    rank: usize,
}

impl Warming {
    /// Log-likelihood that it explains, each number at its price but for `free` of them; start and time constant are numbers, too.
    pub(crate) fn paid(&self, price: f64, free: usize) -> f64 {
        /// Start and time constant.
        const PLACES: usize = 2;
        self.gain - price * ((self.rank + PLACES) as f64 - free as f64)
    }
}

/// The course that explains most; from the sums that [`crate::numerics::polygon::Polygon::new`] takes.
pub(crate) fn best(gram: &DMatrix<f64>, right: &DVector<f64>) -> Option<Warming> {
    let mut best: Option<Warming> = None;
    for moment in 0..MOMENTS {
        let start = moment as f64 / MOMENTS as f64;
        for constant in 0..CONSTANTS {
            let tau = SHORTEST * RATIO.powi(constant as i32);
            let left = |x: f64| (-(0.5 * (x + 1.0) - start).max(0.0) / tau).exp();
            let functions: [&dyn Fn(f64) -> f64; 2] = [&|_| 1.0, &left];
            let found = sampled(gram, right, &functions);
            if best.is_none_or(|b| found.gain() > b.gain) {
                best = Some(Warming {
                    start,
                    tau,
                    gain: found.gain(),
                    rank: found.rank,
                });
            }
        }
    }
    best
}
