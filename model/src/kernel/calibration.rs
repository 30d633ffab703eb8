//! On-line calibration: the residual gradient in its final form.
//!
//! δΘ = −γ Mᵀ n ρ with n = (cos α̂, sin α̂) and ρ the radial residual. γ is a power of two and shifts gear: large
//! first, halved after every few periods of travel, large again when the residual shows that the signal has changed.

use super::detector::within;
use super::{Coefficients, State, Structure};
use crate::format::Quantiser;
use crate::signal::{Formula, Logic, Signal, Wide};

// Powers of two that bring the modes of the gradient (offsets 1/2, gains 1/4, phase 1/8 per unit of gamma and
// normalised amplitude) to about one speed.
const OFFSET: i32 = 0;
const GAIN: i32 = 1;
const PHASE: i32 = 2;

const GRADIENT: [&str; 5] = [
    "gradient_1",
    "gradient_2",
    "gradient_3",
    "gradient_4",
    "gradient_5",
];
const STEP: [&str; 5] = ["step_1", "step_2", "step_3", "step_4", "step_5"];

static DIRECTION: Formula = Formula {
    title: "Gradient along the radius",
    equation: "rho_c = cos(alpha_hat) rho,  rho_s = sin(alpha_hat) rho",
    source: "paper section 5.5.1: r + (sin, -cos) e = n (n^T r)",
};

static UPDATE: Formula = Formula {
    title: "Parameter update",
    equation: "theta -= gamma (2 y_c rho_c, rho_c, 2 y_s rho_s, rho_s, 4 y_c rho_s)",
    source: "paper section 5.5.1, M of equation (7)",
};

static GEARS: Formula = Formula {
    title: "Gears of gamma",
    equation: "gamma halves after some periods of travel, starts again when the residual was large",
    source: "",
};

/// n ρ.
pub fn gradient<S: Signal>(rho: S, cos_hat: S, sin_hat: S, structure: &Structure) -> (S, S) {
    rho.begin(&DIRECTION);
    let signal = &structure.formats.signal;
    (
        (cos_hat * rho).quantise(signal),
        (sin_hat * rho).quantise(signal),
    )
}

/// The parameter accumulators after this sample.
pub fn update<S: Signal>(
    (y_c, y_s): (S, S),
    (rho_c, rho_s): (S, S),
    fresh: S::Bool,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> [S; 5] {
    y_c.begin(&UPDATE);
    let old = [
        state.theta_1_deviation,
        state.theta_2_deviation,
        state.theta_3_deviation,
        state.theta_4_deviation,
        state.theta_5_deviation,
    ];
    if structure.parameters == 0 {
        return old;
    }
    let step = |gradient: S::Wide, i: usize, equaliser: i32| {
        let geared = gradient
            .scale(equaliser - structure.gamma_first as i32)
            .named(GRADIENT[i])
            .quantise_geared(
                state.gamma_gear,
                1,
                structure.gamma_gears,
                &structure.formats.step,
            );
        let step = S::select(fresh, geared, k.zero).named(STEP[i]);
        (old[i] - step).quantise(&structure.formats.deviation[i])
    };
    let fifth = if structure.parameters >= 5 {
        step(y_c * rho_s, 4, PHASE)
    } else {
        k.zero
    };
    [
        step(y_c * rho_c, 0, GAIN),
        step(rho_c.widen(), 1, OFFSET),
        step(y_s * rho_s, 2, GAIN),
        step(rho_s.widen(), 3, OFFSET),
        fifth,
    ]
}

/// γ gear, periods in it, and whether the running period was disturbed.
pub struct Gears<S: Signal> {
    /// γ gear.
    pub gear: S,
    /// Periods of travel in this gear.
    pub periods: S,
    /// The residual was large in the running period.
    pub disturbed: S::Bool,
}

/// The γ gear after this sample.
pub fn gears<S: Signal>(
    rho: S,
    fresh: S::Bool,
    whole_period: S::Bool,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Gears<S> {
    rho.begin(&GEARS);
    let gear_format = Quantiser::wrapping(structure.formats.gamma_gear);
    let period_format = Quantiser::wrapping(structure.formats.gear_periods);
    let large = within(rho, k.restart_residual)
        .not()
        .and(fresh)
        .named("residual_large");
    let tick = whole_period.and(fresh).named("period_tick");
    let restart = tick.and(state.disturbed).named("gamma_restart");
    let last = state.gamma_gear.less_than(k.gamma_gear_last).not();
    let done = state.gear_periods.less_than(k.gear_periods_last).not();
    let shift = tick.and(done).and(last.not()).named("gamma_shift");
    let gear = (state.gamma_gear + S::select(shift, k.one, k.zero)).quantise(&gear_format);
    let counted = (state.gear_periods + S::select(tick, k.one, k.zero)).quantise(&period_format);
    let again = restart.or(tick.and(done)).named("gear_periods_again");
    Gears {
        gear: S::select(restart, k.zero, gear).quantise(&gear_format),
        periods: S::select(again, k.zero, counted).quantise(&period_format),
        disturbed: large.or(state.disturbed.and(tick.not())),
    }
}
