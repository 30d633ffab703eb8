//! Noise that is louder at some angles, speeds or times than at others.
//!
//! The sums of a recording know one noise for all samples of a row. A channel with a tenth of the other's amplitude has ten times its
//! noise once both are corrected, and so has the radius at every angle where that channel makes it: a shape that stands where noise is
//! loud explains more of it by chance than one number does of even noise. How much more the samples tell themselves: what is left of
//! each, times what the shape does there (the heteroskedasticity-consistent variance of H. White, 1980).

use super::{Fit, System};
use crate::numerics::solve::dot;

impl System<'_> {
    /// So many times the variance of even noise what noise does to the difference of two fits, `with` some shapes and `without` them; at
    /// least 1. Radius and circle of a sample are taken together: the noise of a channel is in both.
    pub(crate) fn unevenness(&self, without: &Fit, with: &Fit) -> f64 {
        let [before, after] = [without, with].map(|fit| self.samples.left(&fit.amounts()));
        let mut products = vec![0.0; self.context.samples()];
        let mut square = 0.0;
        for ((before, after), whitener) in before.iter().zip(&after).zip(&self.samples.whiteners) {
            if after.is_empty() {
                continue;
            }
            let does: Vec<f64> = before.iter().zip(after).map(|(b, a)| b - a).collect();
            let does = whitener.unpredictable(&does);
            square += dot(&does, &does);
            let left = whitener.unpredictable(after);
            for (product, (does, left)) in products.iter_mut().zip(does.iter().zip(left)) {
                *product += does * left;
            }
        }
        let seen = dot(&products, &products) / square.max(f64::MIN_POSITIVE);
        if seen.is_finite() { seen.max(1.0) } else { 1.0 }
    }
}
