//! The loop filter: from phase error to phase increment.
//!
//! α̂' = α̂ + rate', rate' = p·rate + a (e − e₁) + (a + b) e₁. Written with the increment, all three methods of the
//! paper are this one line: Method 1 remembers α̂₁ and takes rate = α̂ − α̂₁; Methods 2 and 3 remember the rate, which
//! is the speed; Method 2 has b = 0 and p = p1 p2. p = 1 is type 2. a and a + b are separate coefficients because a
//! and b nearly cancel. In acquisition a is 2^(stride · gears to go) and a + b the square of that larger, which widens
//! the bandwidth by that factor.

use super::{Coefficients, Method, State, Structure};
use crate::format::Quantiser;
use crate::signal::{Formula, Signal, Wide};

static FILTER: Formula = Formula {
    title: "Loop filter",
    equation: "rate' = p rate + a (e - e_1) + (a + b) e_1, wider by powers of two in acquisition",
    source: "paper equations (2) and (9), sections 4.1 to 4.3",
};

/// The position increment of this sample, in turns.
pub fn rate<S: Signal>(e: S, state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S {
    e.begin(&FILTER);
    let formats = &structure.formats;
    let geared = |product: S::Wide, stride: u32| {
        let widest = (stride * structure.loop_gears) as i32;
        if widest == 0 {
            product.quantise(&formats.rate)
        } else {
            product.scale(widest).quantise_geared(
                state.loop_gear,
                stride,
                structure.loop_gears,
                &formats.rate,
            )
        }
    };
    let before = rate_before(state, structure);
    let kept = if structure.filter_type == 2 {
        before
    } else {
        leak(before, k, structure)
    };
    if structure.method == Method::Two {
        return (kept + geared(k.loop_a * e, structure.loop_stride)).quantise(&formats.rate);
    }
    let change = (e - state.error_previous)
        .quantise(&formats.signal)
        .named("e_change");
    let kick = geared(k.loop_a * change, structure.loop_stride).named("kick");
    let drift = geared(k.loop_ab * state.error_previous, 2 * structure.loop_stride).named("drift");
    // The drift is there long before the kick.
    (kept + drift + kick).quantise(&formats.rate)
}

/// The position increment of the sample before, in turns: the speed as it is known before this sample.
pub fn rate_before<S: Signal>(state: &State<S>, structure: &Structure) -> S {
    match structure.method {
        Method::One => (state.alpha_hat - state.alpha_hat_previous)
            .quantise(&wrapped(structure))
            .named("rate_before"),
        Method::Two | Method::Three => state.rate,
    }
}

/// A difference of two phases is known modulo one turn.
fn wrapped(structure: &Structure) -> Quantiser {
    let alpha = structure.formats.alpha;
    Quantiser::wrapping(crate::format::Format::signed(alpha.width, alpha.fraction))
}

/// p · rate as rate − (1 − p) · rate, in two products so that the multiplier need not be wider for it.
fn leak<S: Signal>(rate: S, k: &Coefficients<S>, structure: &Structure) -> S {
    let high = rate
        .quantise(&structure.formats.rate_high)
        .named("rate_high");
    let low = (rate - high).named("rate_low");
    let lost = (k.loop_leak * high + k.loop_leak * low)
        .quantise(&structure.formats.rate)
        .named("rate_lost");
    rate - lost
}
