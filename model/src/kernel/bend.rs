//! Bends of the two channels: polynomials of second and third order on the normalised signal.
//!
//! Offset and gain come first and make u, then the bend, then the phase. T2 and T3 (Chebyshev) disturb each other and
//! the linear terms little. The third orders of the two channels are not corrected apart but as what they have in
//! common, θ8, which changes the radius by cos 4α, and what is opposite in them, θ9, which turns the pair by 2 sin 2α and
//! changes no radius: T3(u) − u = 4 (u³ − u) of one channel, less that of the other.

use super::detector::within;
use super::{Coefficients, State, Structure, loop_filter};
use crate::signal::{Formula, Logic, Signal, Wide};

static BEND: Formula = Formula {
    title: "Bend",
    equation: "c = u + theta_6 T2(u) + theta_8 T3(u) + theta_9 (T3(u) - u);  sine: theta_7, theta_8, -theta_9",
    source: "paper section 5.4, in Chebyshev polynomials T2 = 2 u^2 - 1, T3 = 4 u^3 - 3 u",
};

/// The parameters of both bends, as they are applied.
#[derive(Clone, Copy, Debug)]
pub struct Bends<S: Signal> {
    /// θ6.
    pub theta_6: S,
    /// θ7.
    pub theta_7: S,
    /// θ8, as it is added to both.
    pub theta_8: S,
    /// θ9, as it is added to the cosine's and taken off the sine's.
    pub theta_9: S,
    /// 4 (θ8 + θ9) as multiplied by u², and 4 (θ8 + θ9) − θ8.
    cubic_c: (S, S),
    /// 4 (θ8 − θ9) as multiplied by u², and 4 (θ8 − θ9) − θ8.
    cubic_s: (S, S),
}

/// θ6 … θ9 as the chip applies them.
pub fn parameters<S: Signal>(state: &State<S>, structure: &Structure) -> Bends<S> {
    state.theta_6_deviation.begin(&BEND);
    let formats = &structure.formats;
    let (both, opposite) = (state.theta_8_deviation, state.theta_9_deviation);
    let cubic = |sum: S, name: [&'static str; 2]| {
        let by_square = sum.scale(2);
        (
            by_square.quantise(&formats.theta_cubic).named(name[0]),
            (by_square - both).named(name[1]),
        )
    };
    Bends {
        theta_6: state.theta_6_deviation.quantise(&formats.theta_bend),
        theta_7: state.theta_7_deviation.quantise(&formats.theta_bend),
        theta_8: both,
        theta_9: opposite,
        cubic_c: cubic(both + opposite, ["cubic_c", "cubic_c_constant"]),
        cubic_s: cubic(both - opposite, ["cubic_s", "cubic_s_constant"]),
    }
}

static SHOWN: Formula = Formula {
    title: "Bends that a speed shows",
    equation: "-17/128 <= rate < 17/128, or bends rest: fewer than 7.5 samples a period",
    source: "",
};

/// Whether a period has samples enough to tell bends from gains and offsets, where bends are calibrated. Exactly seven samples and fewer
/// stand at seven places of the period, which are fewer than there are parameters: what fits these fits no other. Between such speeds more is
/// seen, but with a sensor that is not yet calibrated the rate is not known so well.
pub fn shown<S: Signal>(
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Option<S::Bool> {
    if !structure.calibration.has_bend() {
        return None;
    }
    state.alpha_hat.begin(&SHOWN);
    let rate = loop_filter::rate_before(state, structure);
    Some(within(rate, k.bend_rate).named("bends_shown"))
}

/// Bends by sums of squares rest.
pub fn rest<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    let early = state.gamma_gear.less_than(k.gamma_gear_bends);
    early.named("bends_rest")
}

/// Whether bends are calibrated in a sample whose speed shows them. By sums of squares they rest until the ellipse is nearly found: all
/// nine parameters at once, far from what they will be, swing from bound to bound.
pub fn taught<S: Signal>(
    shown: Option<S::Bool>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Option<S::Bool> {
    if !structure.calibration.swings() {
        return shown;
    }
    let rest = rest(state, k);
    shown.map(|shown| shown.and(rest.not()).named("bends_taught"))
}

/// (c, s) before the phase, of (u_c, u_s).
pub fn bend<S: Signal>(
    (u_c, u_s): (S, S),
    bends: &Bends<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> (S, S) {
    u_c.begin(&BEND);
    let signal = &structure.formats.signal;
    let channel = |u: S, second: S, (cubic, constant): (S, S), name: [&'static str; 4]| {
        let square = (u * u).quantise(signal).named(name[0]);
        let slope = (cubic * square - constant.widen())
            .quantise(signal)
            .named(name[1]);
        // T2 = 2 (u² − ½)
        let half_t2 = (square - k.half).named(name[2]);
        let odd = (u.widen() + u * slope).named(name[3]);
        (odd + (second * half_t2).scale(1)).quantise(signal)
    };
    (
        channel(
            u_c,
            bends.theta_6,
            bends.cubic_c,
            ["u_c_square", "bend_c", "half_t2_c", "c_bent_odd"],
        ),
        channel(
            u_s,
            bends.theta_7,
            bends.cubic_s,
            ["u_s_square", "bend_s", "half_t2_s", "s_bent_odd"],
        ),
    )
}
