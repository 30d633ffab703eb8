//! Correction of channel skew: the sine is sampled later than the cosine.
//!
//! At the speed ω a sine that is sampled `delay` later is a_s sin(α + κ − β) + b_s with κ = ω · delay. What Θ makes of it,
//! with T = tan β, is
//!
//! ```text
//! s' = (cos κ + T sin κ) sin α + (sin κ + T (1 − cos κ)) cos α
//! ```
//!
//! The correction stands behind Θ (behind the bend and the phase too: they know no time) and takes off what κ put in, so
//! that phase error, radial residual and with them the gradient see the pair of a sensor without skew: θ5 stays at β at any
//! speed. κ is the delay times the speed before this sample, as the loop filter knows it, held at what the design's
//! largest speed allows. Before lock there is no speed to speak of, and κ is 0: acquisition is that of the chip without it.
//!
//! The first order leaves a gain error of κ²/2 − κ T in the sine. The second takes that off too and leaves an error of s of
//! κ³/12 and of κ T times the square of the cosine's relative gain error (with bends that of κ T²): see
//! [`Skew`](crate::design::Skew), which says what is left at the largest speed.

use super::{Coefficients, State, Structure, correction, loop_filter};
use crate::signal::{Formula, Signal, Wide};

/// How far the series in κ goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// s = s' − κ c.
    First,
    /// And (1 + κ²/2 − κ tan β) for the gain.
    Second,
}

static SKEW: Formula = Formula {
    title: "Channel skew",
    equation: "skew = delay * speed in radians, in lock; s = s' - skew c + (skew^2/2 - skew tan(beta)) (s' - skew c / 2)",
    source: "y_s = a_s sin(alpha + skew - beta) + b_s: the sine is sampled later",
};

static FIRST: Formula = Formula {
    title: "Channel skew",
    equation: "skew = delay * speed in radians, in lock; s = s' - skew c",
    source: "y_s = a_s sin(alpha + skew - beta) + b_s: the sine is sampled later",
};

/// κ: by how much the sine's phase runs ahead because it is sampled later, radians.
pub fn skew<S: Signal>(
    order: Order,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S {
    state.alpha_hat.begin(formula(order));
    let formats = &structure.formats;
    let speed = loop_filter::rate_before(state, structure)
        .quantise(&formats.skew_rate)
        .named("skew_rate");
    let ahead = (k.skew_delay * speed)
        .quantise(&formats.skew)
        .named("skew_moving");
    S::select(state.locked, ahead, k.zero).quantise(&formats.skew)
}

/// The sine of the pair that Θ corrected as it was when the cosine was sampled; `theta_1` and `theta_5` as applied.
pub fn correct<S: Signal>(
    (c, s): (S, S),
    (order, skew): (Order, S),
    (theta_1, theta_5): (S, S),
    k: &Coefficients<S>,
    structure: &Structure,
) -> S {
    s.begin(formula(order));
    let signal = &structure.formats.signal;
    let s = s.named("s_late");
    let turned = skew * c;
    if order == Order::First {
        return (s.widen() - turned).quantise(signal);
    }
    let half = skew.scale(-1);
    let slope = match correction::tan_beta(theta_1, theta_5, k, structure) {
        Some(tan_beta) => half - tan_beta,
        None => half,
    };
    let slope = slope.quantise(signal).named("skew_slope");
    let gain = (skew * slope).quantise(signal).named("skew_gain");
    let middle = (s.widen() - turned.scale(-1))
        .quantise(signal)
        .named("s_between");
    (s.widen() - turned + gain * middle).quantise(signal)
}

fn formula(order: Order) -> &'static Formula {
    match order {
        Order::First => &FIRST,
        Order::Second => &SKEW,
    }
}
