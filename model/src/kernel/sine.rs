//! sin α̂ and cos α̂: a quarter-wave table of values and slopes, linear in between.
//!
//! The phase is cut to the bits that the table uses and stands for the middle of what was cut off. So reflecting the
//! phase is inverting its bits, and truncation is no bias. Each segment is expanded about its centre.

use super::{Coefficients, Structure};
use crate::signal::{Formula, Logic, Signal, Wide};

/// Column of the table that holds values.
pub const VALUE: usize = 0;
/// Column of the table that holds slopes per turn.
pub const SLOPE: usize = 1;

static SINE: Formula = Formula {
    title: "Sine and cosine of the estimate",
    equation: "sin(x) = value[x] + slope[x] (x - centre), quarter wave, folded by quadrant",
    source: "paper section 3, for the phase detector",
};

/// (sin α̂, cos α̂) of a phase in turns.
#[inline(always)]
pub fn sine<S: Signal>(alpha_hat: S, k: &Coefficients<S>, structure: &Structure) -> (S, S) {
    alpha_hat.begin(&SINE);
    let [half, quarter, _] = &structure.formats.sine_modulo;
    let phase = alpha_hat
        .quantise(&structure.formats.sine_phase)
        .named("sine_phase");
    let upper_half = phase.less_than(k.half).not().named("upper_half");
    let odd = phase
        .quantise(half)
        .less_than(k.quarter)
        .not()
        .named("odd_quadrant");
    let rising = phase.quantise(quarter).named("quarter_phase");
    let falling = (k.quarter_turn - rising).named("quarter_phase_mirrored");

    let sin = of_quarter(
        S::select(odd, falling, rising).named("sin_address"),
        ["sin_inside", "sin_value", "sin_slope", "sin_magnitude"],
        k,
        structure,
    );
    let cos = of_quarter(
        S::select(odd, rising, falling).named("cos_address"),
        ["cos_inside", "cos_value", "cos_slope", "cos_magnitude"],
        k,
        structure,
    );
    let sin_hat = S::select(upper_half, -sin, sin).quantise(&structure.formats.signal);
    let cos_negative = upper_half.xor(odd).named("cos_negative");
    let cos_hat = S::select(cos_negative, -cos, cos).quantise(&structure.formats.signal);
    (sin_hat, cos_hat)
}

/// The first quarter of the wave.
#[inline(always)]
fn of_quarter<S: Signal>(
    address: S,
    name: [&'static str; 4],
    k: &Coefficients<S>,
    structure: &Structure,
) -> S {
    let [_, _, segment] = &structure.formats.sine_modulo;
    let rom = &structure.sine;
    let inside = (address.quantise(segment) + k.half_bit - k.half_segment).named(name[0]);
    let value = S::lookup(rom, VALUE, address).named(name[1]);
    let slope = S::lookup(rom, SLOPE, address).named(name[2]);
    // The table's value carries the half bit of rounding.
    (slope * inside + value.widen())
        .quantise(&structure.formats.signal_rounded)
        .named(name[3])
}
