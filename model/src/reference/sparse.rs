//! Where samples are few: the part of the exact gradient that shows what the radius at few places cannot.
//!
//! At exactly four samples a period one combination of the gains' difference and the phase changes no radius at any of them; at
//! exactly eight so does the third order that both channels have, where cos 4α is 0 at all of them. Both
//! turn the pair forward at one sample and back at the next, which no loop follows: there (w − ∇α̂)ᵀ e of the exact gradient is wᵀ e.
//! Of every four periods two teach so, and two along the radius; of e counts what changes from sample to sample.

use super::gradient::Observation;
use super::{Parameters, Theta};

/// More than this of e is no measurement, radians.
const MOST: f64 = 0.25;

/// When samples are few.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sparse {
    /// Gains and phase are learned from e from this speed on, radians per sample.
    pub rate: f64,
    /// The third order that both channels have is between these, the latter where bends begin to rest.
    pub bends_rates: [f64; 2],
}

impl Sparse {
    /// The gradient of a sample that teaches along the circle, if this one does: at this speed (radians per sample), in this period, with
    /// this e (radians) of the sample before. The direction is that of the search's own residual: of the estimate, or of the pair itself.
    #[must_use]
    pub fn gradient(
        &self,
        parameters: Parameters,
        seen: &Observation,
        (speed, period): (f64, i64),
        (e_before, [cos, sin]): (f64, [f64; 2]),
    ) -> Option<Theta> {
        let [from, to] = self.bends_rates;
        let speed = speed.abs();
        let of_bends = speed >= from && speed < to;
        if period.rem_euclid(4) < 2 || !of_bends && speed < self.rate {
            return None;
        }
        let e = ((seen.e - e_before) / 2.0).clamp(-MOST, MOST);
        if of_bends {
            let sin_4 = 8.0 * sin * cos * (cos * cos - 0.5);
            return Some(parameters.common_third() * (-sin_4 * e));
        }
        let w = seen.w_across([cos, sin]);
        let mut gradient = Theta::zeros();
        let [gain_c, _, gain_s, _] = parameters.linear();
        (gradient[gain_c], gradient[gain_s]) = (w[gain_c] * e, w[gain_s] * e);
        if let Some(at) = parameters.phase() {
            let bends = parameters.count() > 5;
            // Behind the bends the chip leaves out what of it is the same all round.
            let w = if bends { cos * cos - 0.5 } else { w[at] };
            gradient[at] = w * e;
        }
        Some(gradient)
    }
}
