//! On-line calibration: the step of the parameters against the gradient.
//!
//! δΘ = −γ Mᵀ n ρ with n = (cos α̂, sin α̂) and ρ the radial residual. γ is a power of two and shifts gear: large
//! first, halved after every few periods of travel, large again when the residual shows that the signal has changed.

use super::detector::within;
use super::gradient::{self, Seen};
use super::sensitivity::Sensitivity;
use super::{Coefficients, State, Structure, sum_of_squares};
use crate::format::Quantiser;
use crate::signal::{Formula, Logic, Signal, Wide};
use crate::spec::CalibrationMethod;

/// Powers of two that equalise the modes of the gradient: offsets 1/2, gains 1/4 and 1/2, phase 1/8, per unit of gamma
/// and amplitude.
struct Equaliser {
    offset: i32,
    gain: i32,
    phase: i32,
    bend: i32,
}

impl Equaliser {
    fn of(structure: &Structure) -> Self {
        let amplitude = structure.amplitude_shift as i32;
        // With bends the gradients by offset and phase are made of the estimate, whose amplitude is 1, and the offset's
        // has its factor.
        let bent = structure.has_bend();
        let (offset, gain, phase) = match structure.gradient {
            _ if bent => (0, 1, 2),
            // The phase waits for the others in the first periods; twice as fast it is done with them.
            CalibrationMethod::Final | CalibrationMethod::Exact => (0, 1, 4),
            // What is remembered lags, and must not be as fast.
            CalibrationMethod::SumOfSquares => (0, 1, 3),
            // The inverse of the modes, with [3 -1; -1 3] for the gains: a period is a step of Newton's.
            CalibrationMethod::Batch => (1, 0, 3),
        };
        Self {
            offset,
            gain: gain + amplitude,
            phase: phase + if bent { 0 } else { amplitude },
            bend: 0,
        }
    }
}

const GRADIENT: [&str; 8] = [
    "gradient_1",
    "gradient_2",
    "gradient_3",
    "gradient_4",
    "gradient_5",
    "gradient_6",
    "gradient_7",
    "gradient_8",
];
const STEP: [&str; 8] = [
    "step_1", "step_2", "step_3", "step_4", "step_5", "step_6", "step_7", "step_8",
];

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

/// The parameters after a sample, and what their search remembers.
pub struct Update<S: Signal> {
    /// Accumulators of θ1 … θ9.
    pub theta: [S; 9],
    /// ∇α̂ by θ1 … θ5.
    pub sensitivities: [Sensitivity<S>; 5],
    /// Gathered gradients by θ1 … θ5.
    pub gathered: [S; 5],
    /// sin α̂ cos α̂, where bends are calibrated.
    pub w_null: S,
}

/// The parameter accumulators after this sample, all but θ9. `whole_period`: a period of travel ends. `PLAIN` as
/// [`Structure::is_plain`].
#[inline(always)]
pub fn update<S: Signal, const PLAIN: bool>(
    seen: &Seen<S>,
    fresh: S::Bool,
    whole_period: S::Bool,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Update<S> {
    seen.rho.begin(&UPDATE);
    let mut this = Update {
        theta: [
            state.theta_1_deviation,
            state.theta_2_deviation,
            state.theta_3_deviation,
            state.theta_4_deviation,
            state.theta_5_deviation,
            state.theta_6_deviation,
            state.theta_7_deviation,
            state.theta_8_deviation,
            state.theta_9_deviation,
        ],
        sensitivities: [Sensitivity {
            gradient: k.zero,
            rate: k.zero,
            error: k.zero,
        }; 5],
        gathered: sum_of_squares::gathered(state),
        w_null: k.zero,
    };
    if structure.parameters == 0 {
        return this;
    }
    let mut gradient = gradient::linear(seen, k, structure);
    // θ1 … θ4, and θ5 where there is phase.
    let linear = if structure.has_phase() { 5 } else { 4 };
    let method = if PLAIN {
        CalibrationMethod::Final
    } else {
        structure.gradient
    };
    match method {
        CalibrationMethod::Final => {}
        CalibrationMethod::Exact => {
            this.sensitivities = gradient::sensitivities(seen, state, k, structure);
            let calibrated = gradient.iter_mut().zip(&this.sensitivities);
            for (gradient, sensitivity) in calibrated.take(linear) {
                *gradient = *gradient + sensitivity.error * seen.e;
            }
        }
        CalibrationMethod::SumOfSquares | CalibrationMethod::Batch => {
            let calibrated = gradient.iter_mut().zip(&mut this.gathered);
            for (gradient, before) in calibrated.take(linear) {
                let (zero, whole) = (k.zero, whole_period);
                let gathered =
                    sum_of_squares::gather(*gradient, *before, fresh, whole, zero, structure);
                *gradient = gathered.gradient.widen();
                *before = gathered.next;
            }
            seen.rho.begin(&UPDATE);
        }
    }
    // A batch acts where its period ends.
    let due = if method == CalibrationMethod::Batch {
        fresh.and(whole_period).named("batch_due")
    } else {
        fresh
    };
    let mut bends = None;
    if !PLAIN && structure.has_bend() {
        let bent = gradient::bent(seen, k, structure);
        (gradient[1], gradient[3], gradient[4]) = (bent.offsets[0], bent.offsets[1], bent.phase);
        bends = Some((bent.second, bent.third));
        this.w_null = bent.w;
        seen.rho.begin(&UPDATE);
    }
    let by = Equaliser::of(structure);
    if method == CalibrationMethod::Batch {
        let newton = |own: S::Wide, other: S::Wide| own.scale(2) - own - other;
        (gradient[0], gradient[2]) = (
            newton(gradient[0], gradient[2]),
            newton(gradient[2], gradient[0]),
        );
    }
    let old = this.theta;
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
        let step = S::select(due, geared, k.zero).named(STEP[i]);
        (old[i] - step).quantise(&structure.formats.deviation[i])
    };
    if structure.has_phase() {
        this.theta[4] = step(gradient[4], 4, by.phase);
    }
    this.theta[0] = step(gradient[0], 0, by.gain);
    this.theta[1] = step(gradient[1], 1, by.offset);
    this.theta[2] = step(gradient[2], 2, by.gain);
    this.theta[3] = step(gradient[3], 3, by.offset);
    if let Some(([second_c, second_s], third)) = bends {
        this.theta[5] = step(second_c, 5, by.bend);
        this.theta[6] = step(second_s, 6, by.bend);
        this.theta[7] = step(third, 7, by.bend);
    }
    this
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
