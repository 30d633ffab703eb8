//! What warms up, or settles: from some moment on it goes to its end as an exponential does, fast at first. Lines need many knots
//! for that and polynomials of a few numbers do not follow it, where this has four numbers.

use nalgebra::{DMatrix, DVector};

use crate::polygon::sampled;

/// Moments at which it may begin, evenly spaced over the recording.
const MOMENTS: usize = 20;
/// Time constants, in recordings: the shortest, the ratio of one to the one before, how many.
const SHORTEST: f64 = 0.03;
const RATIO: f64 = 1.35;
const CONSTANTS: usize = 12;

/// Log-likelihood that the best such course of each channel explains, each number at its price but for `free` of them; the moment and the
/// time constant are numbers, too. From the sums that [`crate::polygon::Polygon::new`] takes.
pub(crate) fn explained(gram: &DMatrix<f64>, right: &DVector<f64>, price: f64, free: usize) -> f64 {
    /// The moment and the time constant.
    const PLACES: usize = 2;
    let mut most = f64::MIN;
    for moment in 0..MOMENTS {
        // From −1 to 1.
        let begins = 2.0 * moment as f64 / MOMENTS as f64 - 1.0;
        for constant in 0..CONSTANTS {
            let tau = 2.0 * SHORTEST * RATIO.powi(constant as i32);
            let functions: [&dyn Fn(f64) -> f64; 2] =
                [&|_| 1.0, &|x: f64| (-(x - begins).max(0.0) / tau).exp()];
            let found = sampled(gram, right, &functions);
            let numbers = (found.rank + PLACES) as f64 - free as f64;
            most = most.max(found.gain() - price * numbers);
        }
    }
    most
}
