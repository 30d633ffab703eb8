//! Harmonics of the scale period: what a stored table knows of them is taken off the corrected pair.
//!
//! A channel that is not a pure cosine of the angle is, with h_c and h_s sums of amplitude · cos(order · α + phase),
//!
//! ```text
//! y_c = a_c (cos α + h_c(α)) + b_c          y_s = a_s (sin(α − β) + h_s(α)) + b_s
//! ```
//!
//! and Θ, with T = tan β, makes of it
//!
//! ```text
//! c' = cos α + h_c(α)          s' = sin α + T h_c(α) + √(1 + T²) h_s(α)
//! ```
//!
//! The table is read at the estimate α̂, and what is read is taken off the pair, not off the angle at the output: so the loop
//! need not follow the harmonics, the correction holds at any speed, and every search of the parameters sees a pure ellipse,
//! whichever residual it is made of. Where α̂ is off by e, what is left is e times the slope of the harmonics: no more than a
//! change of the loop's gain.
//!
//! A sine that is sampled later, at α + κ, is read there.

use super::{Coefficients, Structure, correction};
use crate::format::{Format, Quantiser};
use crate::rom::Rom;
use crate::signal::{Formula, Signal, Wide};

/// Columns of the table: value, and slope per turn, of the cosine channel.
pub const COSINE: [usize; 2] = [0, 1];
/// The same of the sine channel.
pub const SINE: [usize; 2] = [2, 3];

/// How far the series in tan β goes that takes the harmonics through the phase correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// s = s' − h_s: β is so small, by promise, that it does not count.
    Zeroth,
    /// s = s' − h_s − T h_c.
    First,
    /// s = s' − h_s − T (h_c + T h_s / 2).
    Second,
}

/// The stored harmonics.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    /// A period of values and slopes of both channels.
    pub table: Rom,
    /// How far the phase correction is followed.
    pub order: Order,
}

static READ: Formula = Formula {
    title: "Harmonics of the scale period",
    equation: "h(x) = value[x] + slope[x] (x - centre) in each channel",
    source: "y_c = a_c (cos(alpha) + h_c(alpha)) + b_c, y_s = a_s (sin(alpha - beta) + h_s(alpha)) + b_s",
};

static ZEROTH: Formula = Formula {
    title: "Pair without harmonics",
    equation: "c = c' - h_c,  s = s' - h_s",
    source: "",
};

static FIRST: Formula = Formula {
    title: "Pair without harmonics",
    equation: "c = c' - h_c,  s = s' - h_s - tan(beta) h_c",
    source: "",
};

static SECOND: Formula = Formula {
    title: "Pair without harmonics",
    equation: "c = c' - h_c,  s = s' - h_s - tan(beta) (h_c + tan(beta) h_s / 2)",
    source: "",
};

/// (h_c, h_s) at the estimate, in turns; the sine's at the phase (radians) `ahead` of it where it is sampled later.
pub fn stored<S: Signal>(
    alpha_hat: S,
    ahead: Option<S>,
    k: &Coefficients<S>,
    (structure, harmonics): (&Structure, &Harmonics),
) -> (S, S) {
    alpha_hat.begin(&READ);
    let formats = &structure.formats;
    let rom = &harmonics.table;
    let address = Quantiser::wrapping(formats.sine_phase.format);
    let fraction = address.format.fraction;
    let modulo = Quantiser::wrapping(Format::unsigned(fraction - rom.index_fraction, fraction));
    let channel = |phase: S, [value, slope]: [usize; 2], name: [&'static str; 4]| {
        let inside =
            (phase.quantise(&modulo) + k.half_bit - k.half_harmonic_segment).named(name[0]);
        let value = S::lookup(rom, value, phase).named(name[1]);
        let slope = S::lookup(rom, slope, phase).named(name[2]);
        // The table's value carries the half bit of rounding.
        (slope * inside + value.widen())
            .quantise(&formats.harmonic.rounded_before())
            .named(name[3])
    };
    let cos_phase = alpha_hat.quantise(&formats.sine_phase);
    let sin_phase = match ahead {
        Some(ahead) => {
            let turns = (ahead * k.turns_per_radian)
                .quantise(&formats.rate)
                .named("skew_turns");
            (alpha_hat + turns)
                .quantise(&address)
                .named("harmonic_phase_late")
        }
        None => cos_phase,
    };
    let h_c = channel(
        cos_phase,
        COSINE,
        [
            "harmonic_inside",
            "harmonic_cos_value",
            "harmonic_cos_slope",
            "harmonic_cos",
        ],
    );
    let h_s = channel(
        sin_phase,
        SINE,
        [
            "harmonic_inside_late",
            "harmonic_sin_value",
            "harmonic_sin_slope",
            "harmonic_sin",
        ],
    );
    (h_c, h_s)
}

/// The pair that Θ corrected without the harmonics `stored`; `theta_1` and `theta_5` as applied.
pub fn correct<S: Signal>(
    (c, s): (S, S),
    (h_c, h_s): (S, S),
    (theta_1, theta_5): (S, S),
    k: &Coefficients<S>,
    (structure, order): (&Structure, Order),
) -> (S, S) {
    let signal = &structure.formats.signal;
    let tan_beta = if order == Order::Zeroth {
        None
    } else {
        correction::tan_beta(theta_1, theta_5, k, structure)
    };
    c.begin(match (tan_beta, order) {
        (None, _) | (_, Order::Zeroth) => &ZEROTH,
        (_, Order::First) => &FIRST,
        (_, Order::Second) => &SECOND,
    });
    let (c, s) = (c.named("c_measured"), s.named("s_measured"));
    let pure_c = (c - h_c).quantise(signal);
    let Some(tan_beta) = tan_beta else {
        return (pure_c, (s - h_s).quantise(signal));
    };
    let through = if order == Order::Second {
        let of_sine = (tan_beta * h_s).quantise(&structure.formats.harmonic);
        (h_c + of_sine.named("harmonic_turned").scale(-1)).named("harmonic_through")
    } else {
        h_c
    };
    let pure_s = (s - h_s).widen() - tan_beta * through;
    (pure_c, pure_s.quantise(signal))
}
