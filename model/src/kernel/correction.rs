//! Correction of the raw pair by Θ.

use super::bend::{self, Bends};
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Signal, Wide};

static NORMALISE: Formula = Formula {
    title: "ADC codes",
    equation: "y = code, as a fraction of the range that the nominal amplitude needs",
    source: "equation (4): y_c = a_c cos(alpha) + b_c, y_s = a_s sin(alpha - beta) + b_s",
};

static THETA: Formula = Formula {
    title: "Parameters as multiplied",
    equation: "theta = nominal + deviation, rounded to what the multiplier takes",
    source: "paper section 5.3",
};

static NOMINAL: Formula = Formula {
    title: "Parameters as multiplied",
    equation: "theta_1 and theta_3 nominal: nothing is calibrated",
    source: "",
};

static SCALE: Formula = Formula {
    title: "Scaling",
    equation: "c = theta_1 y_c,  s = theta_3 y_s",
    source: "",
};

static CORRECT: Formula = Formula {
    title: "Correction",
    equation: "c = theta_1 y_c + theta_2,  s = theta_3 y_s + theta_4",
    source: "paper section 5.2",
};

static CORRECT_PHASE: Formula = Formula {
    title: "Correction",
    equation: "c = theta_1 y_c + theta_2,  s = theta_3 y_s + theta_4 + theta_5 y_c",
    source: "paper section 5.3",
};

static CORRECT_BENT: Formula = Formula {
    title: "Correction",
    equation: "u_c = theta_1 y_c + theta_2,  u_s = theta_3 y_s + theta_4",
    source: "paper section 5.4, offset and gain first",
};

static CORRECT_BENT_PHASE: Formula = Formula {
    title: "Correction",
    equation: "u_c = theta_1 y_c + theta_2,  u_s = theta_3 y_s + theta_4,  after the bend: s + theta_5 c",
    source: "paper section 5.4, offset and gain first, phase last",
};

fn formula(structure: &Structure) -> &'static Formula {
    match (
        structure.calibration.has_bend(),
        structure.calibration.has_phase(),
    ) {
        _ if !structure.calibration.is_on() => &SCALE,
        (false, false) => &CORRECT,
        (false, true) => &CORRECT_PHASE,
        (true, false) => &CORRECT_BENT,
        (true, true) => &CORRECT_BENT_PHASE,
    }
}

/// An ADC code, given as a fraction of the ADC's range, as a signal: `y` has the nominal amplitude between ½ and 1.
#[inline(always)]
pub fn normalise<S: Signal>(code: S, k: &Coefficients<S>, structure: &Structure) -> S {
    code.begin(&NORMALISE);
    let centred = if structure.offset_binary {
        code - k.adc_middle
    } else {
        code
    };
    centred.scale(structure.formats.adc.fraction as i32 - structure.formats.y.fraction as i32)
}

/// θ1 … θ5 as they are applied. The offsets θ2 and θ4 are not multiplied and keep every bit.
#[inline(always)]
pub fn parameters<S: Signal>(
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> [S; 5] {
    let fixed = !structure.calibration.is_on();
    state.alpha_hat.begin(if fixed { &NOMINAL } else { &THETA });
    let [first, third, fifth] = &structure.formats.theta;
    let theta_1 = (k.theta_1_nominal + state.theta_1_deviation).quantise(first);
    let theta_3 = (k.theta_3_nominal + state.theta_3_deviation).quantise(third);
    let theta_5 = if structure.calibration.has_phase() {
        state.theta_5_deviation.quantise(fifth)
    } else {
        k.zero
    };
    [
        theta_1,
        state.theta_2_deviation,
        theta_3,
        state.theta_4_deviation,
        theta_5,
    ]
}

/// The corrected pair (c, s) of 8 and 9 parameters: offset and gain, bend, phase.
pub fn correct_bent<S: Signal>(
    y_c: S,
    y_s: S,
    theta: [S; 5],
    bends: &Bends<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> (S, S) {
    y_c.begin(formula(structure));
    let [theta_1, theta_2, theta_3, theta_4, theta_5] = theta;
    let signal = &structure.formats.signal;
    let u_c = (theta_1 * y_c + theta_2.widen())
        .named("u_c_exact")
        .quantise(signal);
    let u_s = (theta_3 * y_s + theta_4.widen())
        .named("u_s_exact")
        .quantise(signal);
    let (c, s) = bend::bend((u_c.named("u_c"), u_s.named("u_s")), bends, k, structure);
    if !structure.calibration.has_phase() {
        return (c, s);
    }
    c.begin(formula(structure));
    let s = s.named("s_before_phase").widen() + theta_5 * c;
    (c, s.named("s_exact").quantise(signal))
}

/// The corrected pair (c, s).
#[inline(always)]
pub fn correct<S: Signal>(y_c: S, y_s: S, theta: [S; 5], structure: &Structure) -> (S, S) {
    y_c.begin(formula(structure));
    let [theta_1, theta_2, theta_3, theta_4, theta_5] = theta;
    let signal = &structure.formats.signal;
    let c = theta_1 * y_c + theta_2.widen();
    let mut s = theta_3 * y_s + theta_4.widen();
    if structure.calibration.has_phase() {
        s = s + theta_5 * y_c;
    }
    (
        c.named("c_exact").quantise(signal),
        s.named("s_exact").quantise(signal),
    )
}

/// tan β: θ5 where it acts on the corrected cosine, else θ5/θ1 by a step of Newton's from the nominal amplitude. `None` without
/// phase.
pub fn tan_beta<S: Signal>(
    theta_1: S,
    theta_5: S,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Option<S> {
    let signal = &structure.formats.signal;
    if !structure.calibration.has_phase() {
        return None;
    }
    if structure.calibration.has_bend() {
        return Some(theta_5);
    }
    let gain = (k.nominal_amplitude * theta_1)
        .quantise(signal)
        .named("relative_gain");
    let less = (k.one.scale(1) - gain)
        .quantise(signal)
        .named("relative_gain_inverse");
    let cross = (theta_5 * less).quantise(signal).named("relative_cross");
    Some(
        (k.nominal_amplitude * cross)
            .quantise(signal)
            .named("tan_beta"),
    )
}
