//! Position: a phase that wraps at one turn and a count of whole periods.

use super::{Coefficients, Formats, State, Structure};
use crate::format::{Format, Quantiser};
use crate::signal::{Formula, Logic, Signal};

static POSITION: Formula = Formula {
    title: "Position",
    equation: "alpha_hat' = alpha_hat + rate' (mod 1), count' = count + carry",
    source: "paper equation (9)",
};

static DIRECTION: Formula = Formula {
    title: "Direction",
    equation: "sign of the rate, with a dead band",
    source: "",
};

/// Phase, period count, and the phase that the speed is reckoned from (α̂, turned round where `flip` says so).
pub struct Position<S> {
    /// α̂ of the next sample, turns.
    pub alpha_hat: S,
    /// Whole periods of the next sample.
    pub count: S,
    /// Where α̂ started from: α̂, or its opposite if it was turned round.
    pub from: S,
}

/// Advances the position by `rate`. `flip` turns the estimate by half a period, `zero` presets the count.
#[inline(always)]
pub fn advance<S: Signal>(
    rate: S,
    flip: S::Bool,
    zero: S::Bool,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Position<S> {
    rate.begin(&POSITION);
    let Formats {
        alpha: phase,
        count,
        ..
    } = &structure.formats;
    let half_turn = S::select(flip, k.half, k.zero).named("half_turn");
    let turned = (state.alpha_hat + half_turn).named("alpha_hat_turned");
    let sum = (turned + rate).named("alpha_hat_sum");
    let alpha_hat = sum.quantise(phase);
    let carry = sum
        .quantise(&Quantiser::grid(Format::signed(3, 0)))
        .named("carry");
    let period = S::select(zero, k.zero, state.count).named("count_before");
    let counted = (period + carry.scale(-(count.format.fraction as i32))).quantise(count);
    Position {
        alpha_hat,
        count: counted,
        from: turned.quantise(phase),
    }
}

/// True while the scale runs backwards; keeps its value while the rate is too small to tell.
#[inline(always)]
pub fn direction<S: Signal>(rate: S, before: S::Bool, k: &Coefficients<S>) -> S::Bool {
    rate.begin(&DIRECTION);
    let backwards = rate.less_than(-k.direction_rate).named("backwards");
    let not_forwards = rate.less_than(k.direction_rate).named("not_forwards");
    backwards.or(before.and(not_forwards))
}
