//! The whole sample: what the chip does between two strobes of the ADC.

use super::{Coefficients, Input, Method, Probes, State, Structure};
use super::{calibration, correction, detector, lock, loop_filter, position, sine, travel};
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
    let (c, s) = correction::correct(y_c, y_s, theta, structure);

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
    let (rho_c, rho_s) = calibration::gradient(rho, cos_hat, sin_hat, structure);
    let updated = calibration::update((y_c, y_s), (rho_c, rho_s), fresh, state, k, structure);
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
        theta_1_deviation: updated[0],
        theta_2_deviation: updated[1],
        theta_3_deviation: updated[2],
        theta_4_deviation: updated[3],
        theta_5_deviation: updated[4],
        lock_level: lock.level,
        loop_gear: lock.gear,
        gamma_gear: gears.gear,
        gear_periods: gears.periods,
        travel_origin: travel.origin,
        travel_low: travel.low,
        travel_high: travel.high,
        locked: lock.locked,
        lock_lost: lost,
        signal_lost: weak,
        direction,
        disturbed: gears.disturbed,
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
