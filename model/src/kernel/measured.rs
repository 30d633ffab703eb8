//! What a sample is worth: the corrected pair against the estimate.

use super::{Coefficients, Input, State, Structure};
use super::{bend, correction, detector, harmonics, sine, skew};
use crate::signal::Signal;

/// A sample, corrected and turned back by the estimate.
pub struct Measured<S: Signal> {
    /// The normalised pair.
    pub y: (S, S),
    /// θ1 … θ5 as multiplied.
    pub theta: [S; 5],
    /// θ6 … θ9, where the design has bends.
    pub bends: Option<bend::Bends<S>>,
    /// The corrected pair.
    pub pair: (S, S),
    /// Stored harmonics of the pair at the estimate, where the design has some.
    pub harmonics: Option<(S, S)>,
    /// Phase by which the sine is sampled later, radians, where the design says that it is.
    pub skew: Option<S>,
    /// (cos α̂, sin α̂).
    pub estimate: (S, S),
    /// Both corrected signals are too small.
    pub weak: S::Bool,
    /// Phase error, radians.
    pub e: S,
    /// Radial residual.
    pub rho: S,
}

/// Corrects a sample and compares it with the estimate.
#[inline(always)]
pub fn measure<S: Signal, const PLAIN: bool>(
    input: &Input<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Measured<S> {
    let (sin_hat, cos_hat) = sine::sine(state.alpha_hat, k, structure);
    let y_c = correction::normalise(input.adc_cos, k, structure);
    let y_s = correction::normalise(input.adc_sin, k, structure);
    let theta = correction::parameters(state, k, structure);
    let mut bends = None;
    let (mut c, mut s) = if !PLAIN && structure.calibration.has_bend() {
        let bends = bends.insert(bend::parameters(state, structure));
        correction::correct_bent(y_c, y_s, theta, bends, k, structure)
    } else {
        correction::correct(y_c, y_s, theta, structure)
    };
    let [theta_1, _, _, _, theta_5] = theta;
    let late = structure.skew.filter(|_| !PLAIN);
    let late = late.map(|order| (order, skew::skew(order, state, k, structure)));
    let ahead = late.map(|(_, ahead)| ahead);
    let (uncorrected, mut stored) = ((c, s), None);
    if let (false, Some(known)) = (PLAIN, &structure.harmonics) {
        let of = (structure, known);
        let pair = stored.insert(harmonics::stored(state.alpha_hat, ahead, k, of));
        let of = (structure, known.order);
        (c, s) = harmonics::correct((c, s), *pair, (theta_1, theta_5), k, of);
    }
    if let Some(late) = late {
        s = skew::correct((c, s), late, (theta_1, theta_5), k, structure);
    }

    // What the table takes off is no signal.
    let (strong_c, strong_s) = stored.map_or((c, s), |_| uncorrected);
    let weak = detector::weak(strong_c, strong_s, k);
    let rho = detector::radial_residual(c, s, cos_hat, sin_hat, k, structure);
    let seen = detector::phase_error(c, s, cos_hat, sin_hat, structure).named("e_seen");
    // Without a signal the loop coasts at its last rate.
    let e = S::select(weak, k.zero, seen).quantise(&structure.formats.signal);

    Measured {
        y: (y_c, y_s),
        theta,
        bends,
        pair: (c, s),
        harmonics: stored,
        skew: ahead,
        estimate: (cos_hat, sin_hat),
        weak,
        e,
        rho,
    }
}
