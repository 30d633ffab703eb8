//! The whole sample: what the chip does between two strobes of the ADC.

use super::{Coefficients, Input, Method, Probes, State, Structure};
use super::{
    bend, calibration, completion, correction, detector, gradient, lock, loop_filter, position,
    sine, sum_of_squares, travel,
};
use crate::format::Quantiser;
use crate::signal::{Formula, Logic, Signal};

static FLAGS: Formula = Formula {
    title: "Flags",
    equation: "what the machine control needs to know",
    source: "",
};

/// The registers after the sample and its named internal signals.
pub fn sample<S: Signal>(
    input: &Input<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> (State<S>, Probes<S>) {
    let (sin_hat, cos_hat) = sine::sine(state.alpha_hat, k, structure);
    let y_c = correction::normalise(input.adc_cos, k, structure);
    let y_s = correction::normalise(input.adc_sin, k, structure);
    let theta = correction::parameters(state, k, structure);
    let mut bends = None;
    let (c, s) = if structure.has_bend() {
        let bends = bends.insert(bend::parameters(state, structure));
        correction::correct_bent(y_c, y_s, theta, bends, k, structure)
    } else {
        correction::correct(y_c, y_s, theta, structure)
    };

    let weak = detector::weak(c, s, k);
    let rho = detector::radial_residual(c, s, cos_hat, sin_hat, k, structure);
    let seen = detector::phase_error(c, s, cos_hat, sin_hat, structure).named("e_seen");
    // Without a signal the loop coasts at its last rate.
    let e = S::select(weak, k.zero, seen).quantise(&structure.formats.signal);

    let in_window = lock::in_window(e, rho, weak, k);
    let flip = lock::flip(rho, weak, state, k).named("flip");
    let lock = lock::update(in_window, state, k, structure);

    let rate = loop_filter::rate(e, state, k, structure);
    let position = position::advance(rate, flip, input.preset, state, k, structure);
    let direction = position::direction(rate, state.direction, k);

    let counting = state.locked.and(input.calibrate).named("counting");
    let travel = travel::travel(counting, state, k, structure);
    let fresh = counting.and(in_window).and(travel.new_sector);
    let (rho_c, rho_s) = if structure.gathers() {
        let epsilon = sum_of_squares::half_square(c, s, k.half, structure);
        gradient::along(epsilon, (c, s), structure)
    } else {
        gradient::along(rho, (cos_hat, sin_hat), structure)
    };
    let seen = gradient::Seen {
        y: (y_c, y_s),
        estimate: (cos_hat, sin_hat),
        e,
        rho,
        along: (rho_c, rho_s),
    };
    let whole = travel.whole_period;
    let mut updated = calibration::update(&seen, fresh, whole, state, k, structure);
    let completed = structure.completion.map(|_| {
        let open = counting.and(in_window);
        let w = updated.w_null;
        completion::complete((w, e), open, counting, &travel, state, k, structure)
    });
    if let Some(completed) = &completed {
        updated.theta[8] =
            (state.theta_9_deviation - completed.step).quantise(&structure.formats.deviation[8]);
    }
    let gears = calibration::gears(rho, fresh, travel.whole_period, state, k, structure);

    rate.begin(&FLAGS);
    let lost = state
        .lock_lost
        .and(input.preset.not())
        .or(state.locked.and(lock.locked.not()));
    let one = structure.method == Method::One;
    let speed = if one {
        // Method 1: the derivative of the position estimate.
        let alpha = structure.formats.alpha;
        let difference =
            Quantiser::wrapping(crate::format::Format::signed(alpha.width, alpha.fraction));
        (position.alpha_hat - position.from).quantise(&difference)
    } else {
        rate
    };
    let null = completed.as_ref().map(|c| c.sensitivity);
    let next = State {
        alpha_hat: position.alpha_hat,
        count: position.count,
        alpha_hat_previous: if one {
            position.from
        } else {
            state.alpha_hat_previous
        },
        rate: if one { state.rate } else { rate },
        error_previous: e,
        theta_1_deviation: updated.theta[0],
        theta_2_deviation: updated.theta[1],
        theta_3_deviation: updated.theta[2],
        theta_4_deviation: updated.theta[3],
        theta_5_deviation: updated.theta[4],
        theta_6_deviation: updated.theta[5],
        theta_7_deviation: updated.theta[6],
        theta_8_deviation: updated.theta[7],
        theta_9_deviation: updated.theta[8],
        lock_level: lock.level,
        loop_gear: lock.gear,
        gamma_gear: gears.gear,
        gear_periods: gears.periods,
        travel_origin: travel.origin,
        travel_low: travel.low,
        travel_high: travel.high,
        alpha_gradient_1: updated.sensitivities[0].gradient,
        alpha_gradient_rate_1: updated.sensitivities[0].rate,
        alpha_gradient_error_1: updated.sensitivities[0].error,
        alpha_gradient_2: updated.sensitivities[1].gradient,
        alpha_gradient_rate_2: updated.sensitivities[1].rate,
        alpha_gradient_error_2: updated.sensitivities[1].error,
        alpha_gradient_3: updated.sensitivities[2].gradient,
        alpha_gradient_rate_3: updated.sensitivities[2].rate,
        alpha_gradient_error_3: updated.sensitivities[2].error,
        alpha_gradient_4: updated.sensitivities[3].gradient,
        alpha_gradient_rate_4: updated.sensitivities[3].rate,
        alpha_gradient_error_4: updated.sensitivities[3].error,
        alpha_gradient_5: updated.sensitivities[4].gradient,
        alpha_gradient_rate_5: updated.sensitivities[4].rate,
        alpha_gradient_error_5: updated.sensitivities[4].error,
        gathered_1: updated.gathered[0],
        gathered_2: updated.gathered[1],
        gathered_3: updated.gathered[2],
        gathered_4: updated.gathered[3],
        gathered_5: updated.gathered[4],
        null_gradient: null.map_or(k.zero, |n| n.gradient),
        null_gradient_rate: null.map_or(k.zero, |n| n.rate),
        null_gradient_error: null.map_or(k.zero, |n| n.error),
        travel_samples: completed.as_ref().map_or(k.zero, |c| c.samples),
        locked: lock.locked,
        lock_lost: lost,
        signal_lost: weak,
        direction,
        disturbed: gears.disturbed,
        moving: completed.as_ref().map_or(state.moving, |c| c.moving),
    };
    let [theta_1, theta_2, theta_3, theta_4, theta_5] = theta;
    let whole_period = travel.whole_period;
    let probes = Probes {
        y_c,
        y_s,
        theta_1,
        theta_2,
        theta_3,
        theta_4,
        theta_5,
        theta_6: bends.map_or(k.zero, |b| b.theta_6),
        theta_7: bends.map_or(k.zero, |b| b.theta_7),
        c,
        s,
        cos_hat,
        sin_hat,
        e,
        rho,
        rho_c,
        rho_s,
        speed,
        in_window,
        fresh,
        whole_period,
    };
    (next, probes)
}
