//! The loop filter: from phase error to phase increment.
//!
//! α̂' = α̂ + rate', rate' = p·rate + a (e − e₁) + (a + b) e₁. Written with the increment, all three methods of the
//! paper are this one line: Method 1 remembers α̂₁ and takes rate = α̂ − α̂₁; Methods 2 and 3 remember the rate, which
//! is the speed; Method 2 has b = 0 and p = p1 p2. p = 1 is type 2. a and a + b are separate coefficients because a
//! and b nearly cancel. In acquisition a is 2^(gears to go) and a + b the square of that larger, which widens
//! the bandwidth by that factor.

use super::{Coefficients, Method, State, Structure};
use crate::signal::{Formula, Signal, Wide};

/// The filter with one gear, and with more.
macro_rules! filter {
    ($equation:literal, $wider:literal, $source:literal) => {
        [
            Formula {
                title: "Loop filter",
                equation: $equation,
                source: $source,
            },
            Formula {
                title: "Loop filter",
                equation: concat!($equation, "; ", $wider, " in acquisition"),
                source: $source,
            },
        ]
    };
}

static METHOD_1_TYPE_1: [Formula; 2] = filter!(
    "rate' = p (alpha_hat - alpha_hat_1) + a (e - e_1) + (a + b) e_1",
    "a times 2^n, a + b times 4^n",
    "paper section 4.1, equations (2) and (9) with c = -(1 + p), d = p; rate' = alpha_hat' - alpha_hat"
);

static METHOD_1_TYPE_2: [Formula; 2] = filter!(
    "rate' = alpha_hat - alpha_hat_1 + a (e - e_1) + (a + b) e_1",
    "a times 2^n, a + b times 4^n",
    "paper section 4.1, equations (2) and (9) with c = -2, d = 1; rate' = alpha_hat' - alpha_hat"
);

static METHOD_2: [Formula; 2] = filter!(
    "rate' = p rate + a e, p = p1 p2, a = p1 p2 - p1 - p2 + 1",
    "a times 2^n",
    "paper section 4.2: first-order stage a/(z - p), then the integrator z/(z - 1); the rate is the speed"
);

static METHOD_3_TYPE_1: [Formula; 2] = filter!(
    "rate' = p rate + a (e - e_1) + (a + b) e_1",
    "a times 2^n, a + b times 4^n",
    "paper section 4.3: Method 1's a and b, c = -(1 + p), d = p; the rate is kept, it is the speed"
);

static METHOD_3_TYPE_2: [Formula; 2] = filter!(
    "rate' = rate + a (e - e_1) + (a + b) e_1",
    "a times 2^n, a + b times 4^n",
    "paper section 4.3: Method 1's a and b, c = -2, d = 1; the rate is kept, it is the speed"
);

fn formula(structure: &Structure) -> &'static Formula {
    let [one_gear, gears] = match (structure.method, structure.filter_type) {
        (Method::One, 2) => &METHOD_1_TYPE_2,
        (Method::One, _) => &METHOD_1_TYPE_1,
        (Method::Two, _) => &METHOD_2,
        (Method::Three, 2) => &METHOD_3_TYPE_2,
        (Method::Three, _) => &METHOD_3_TYPE_1,
    };
    if structure.loop_gears == 0 {
        one_gear
    } else {
        gears
    }
}

/// The position increment of this sample, in turns.
#[inline(always)]
pub fn rate<S: Signal>(e: S, state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S {
    e.begin(formula(structure));
    let formats = &structure.formats;
    let before = rate_before(state, structure);
    let kept = if structure.filter_type == 2 {
        before
    } else {
        leak(before, k, structure)
    };
    if structure.method == Method::Two {
        return (kept + geared(k.loop_a * e, 1, state, structure)).quantise(&formats.rate);
    }
    let change = (e - state.error_previous)
        .quantise(&formats.signal)
        .named("e_change");
    let kick = geared(k.loop_a * change, 1, state, structure).named("kick");
    let drift = geared(k.loop_ab * state.error_previous, 2, state, structure).named("drift");
    // The drift is there long before the kick.
    ((kept + drift).named("rate_drifted") + kick).quantise(&formats.rate)
}

/// What a coefficient adds to the rate in the present gear of the loop, each gear narrower by 2^`stride`.
#[inline(always)]
fn geared<S: Signal>(product: S::Wide, stride: u32, state: &State<S>, structure: &Structure) -> S {
    let to = &structure.formats.rate;
    let widest = (stride * structure.loop_gears) as i32;
    if widest == 0 {
        return product.quantise(to);
    }
    product
        .scale(widest)
        .quantise_geared(state.loop_gear, stride, structure.loop_gears, to)
}

/// The position increment of the sample before, in turns: the speed as it is known before this sample.
pub fn rate_before<S: Signal>(state: &State<S>, structure: &Structure) -> S {
    match structure.method {
        Method::One => (state.alpha_hat - state.alpha_hat_previous)
            .quantise(&structure.formats.phase_difference)
            .named("rate_before"),
        Method::Two | Method::Three => state.rate,
    }
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
