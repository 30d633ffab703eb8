//! The whole sample: what the chip does between two strobes of the ADC.

use super::sparse::Sparse;
use super::{Coefficients, Input, Method, Probes, State, Structure};
use super::{
    bend, calibration, catch_up, completion, correction, detector, gears, gradient, harmonics,
    lock, loop_filter, position, recall, sine, skew, start, step, strays, sum_of_squares, travel,
    waits,
};
use crate::signal::{Formula, Logic, Signal};

static FLAGS: Formula = Formula {
    title: "Flags",
    equation: "what the machine control needs to know",
    source: "",
};

static SPEED: Formula = Formula {
    title: "Speed",
    equation: "speed = alpha_hat' - alpha_hat (mod 1), without the half turn of a flip",
    source: "paper section 4.1: the derivative of the position",
};

/// The registers after the sample and its named internal signals.
pub fn sample<S: Signal>(
    input: &Input<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> (State<S>, Probes<S>) {
    let mut next = *state;
    let probes = advance(input, &mut next, k, structure);
    (next, probes)
}

/// The same in place: the registers go on to the next sample.
#[inline]
pub fn advance<S: Signal>(
    input: &Input<S>,
    state: &mut State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Probes<S> {
    // The same code twice: where the design has neither bends nor skew nor harmonics nor another gradient than the final form,
    // the compiler leaves them out, which makes the bit-true model faster by two thirds.
    if structure.is_plain() {
        advance_of::<S, true>(input, state, k, structure)
    } else {
        advance_of::<S, false>(input, state, k, structure)
    }
}

#[inline]
fn advance_of<S: Signal, const PLAIN: bool>(
    input: &Input<S>,
    registers: &mut State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Probes<S> {
    let state = &*registers;
    let (sin_hat, cos_hat) = sine::sine(state.alpha_hat, k, structure);
    let y_c = correction::normalise(input.adc_cos, k, structure);
    let y_s = correction::normalise(input.adc_sin, k, structure);
    let theta = correction::parameters(state, k, structure);
    let mut bends = None;
    let (mut c, mut s) = if !PLAIN && structure.calibration.has_bend() {
        let bends = bends.insert(bend::parameters(state, structure));
        correction::correct_bent(y_c, y_s, theta, bends, k, structure)
    } else {
        correction::correct(y_c, y_s, theta, structure)
    };
    let [theta_1, _, _, _, theta_5] = theta;
    let late = structure.skew.filter(|_| !PLAIN);
    let late = late.map(|order| (order, skew::skew(order, state, k, structure)));
    let ahead = late.map(|(_, ahead)| ahead);
    let (measured, mut stored) = ((c, s), None);
    if let (false, Some(known)) = (PLAIN, &structure.harmonics) {
        let of = (structure, known);
        let pair = stored.insert(harmonics::stored(state.alpha_hat, ahead, k, of));
        let of = (structure, known.order);
        (c, s) = harmonics::correct((c, s), *pair, (theta_1, theta_5), k, of);
    }
    if let Some(late) = late {
        s = skew::correct((c, s), late, (theta_1, theta_5), k, structure);
    }
    let (harmonic_cos, harmonic_sin) = stored.unwrap_or((k.zero, k.zero));

    // What the table takes off is no signal.
    let (strong_c, strong_s) = stored.map_or((c, s), |_| measured);
    let weak = detector::weak(strong_c, strong_s, k);
    let rho = detector::radial_residual(c, s, cos_hat, sin_hat, k, structure);
    let seen = detector::phase_error(c, s, cos_hat, sin_hat, structure).named("e_seen");
    // Without a signal the loop coasts at its last rate.
    let e = S::select(weak, k.zero, seen).quantise(&structure.formats.signal);

    let window = lock::in_window(e, rho, weak, k, structure);
    let in_window = window.inside;
    let flip = lock::flip(rho, weak, state, k).named("flip");
    let lock = lock::update(in_window, state, k, structure);

    let rate = loop_filter::rate(e, state, k, structure);
    let position = position::advance(rate, flip, input.preset, state, k, structure);
    let direction = position::direction(rate, state.direction, k);

    let counting = travel::counting(input, state);
    let starting = (!PLAIN && structure.calibration.starts()).then(|| start::running(state, k));
    let measure = starting.map(|running| start::measure(e, running, k));
    let waits = waits::Waits::of(state, k, structure);
    let travel = travel::travel(counting, (measure, waits), state, k, structure);
    let catch_up = catch_up::catch_up(e, starting, state, k, structure);
    let follows = catch_up.map_or(in_window, |catch_up| {
        in_window.and(catch_up.now.not()).named("loop_follows")
    });
    let counts = counting.and(follows).named("sample_counts");
    let counted = counts.and(travel.new_sector).named("counted");
    let tick = counted.and(travel.whole_period).named("period_tick");
    let hold = gears::hold(
        rho,
        counts,
        (lock::present_anywhere(window, e, rho, k), lock.full),
        state,
        k,
        structure,
    );
    let free = counted.and(hold.held.not());
    let early = catch_up.and_then(|catch_up| catch_up.teaches);
    let taught = early.map_or(free, |teaches| free.named("counted_and_free").and(teaches));
    let dropped = catch_up.and_then(|catch_up| catch_up.drops(travel.clear, state, structure));
    let fresh = dropped.map_or(taught, |dropped| {
        taught.named("sample_teaches").and(dropped.not())
    });
    let estimate = (cos_hat, sin_hat);
    let mut polar = None;
    let bends_shown = if PLAIN {
        None
    } else {
        bend::shown(state, k, structure)
    };
    let sparse = if PLAIN {
        None
    } else {
        Sparse::of(e, &travel, (starting, bends_shown), state, k, structure)
    };
    let along_which = |residual: S, direction: (S, S)| {
        sparse.map_or((residual, direction), |of| of.along(residual, direction, k))
    };
    // What the gradient is made of: the residual, and the pair or its estimate.
    let (residual, frame, along) = if !PLAIN && structure.calibration.squares() {
        let epsilon = sum_of_squares::half_square(c, s, k.half, structure);
        let limited = gradient::limited(epsilon, None, structure);
        let (residual, direction) = along_which(limited, (c, s));
        let along = gradient::along(residual, direction, structure);
        (residual, (c, s), along)
    } else {
        let lags = structure.calibration.allows_for_lag().then_some(e);
        let limited = gradient::limited(rho, lags, structure);
        polar = starting
            .map(|running| start::polar((rho, limited, e), estimate, running, &travel, structure));
        let (rho, direction) = match &polar {
            Some(polar) => (polar.residual, polar.direction),
            None => (limited, estimate),
        };
        let (rho, direction) = along_which(rho, direction);
        let along = gradient::along(rho, direction, structure);
        let residual = match (sparse, starting) {
            (None, _) => limited,
            (Some(_), None) => rho,
            // The start's own is weighed.
            (Some(_), Some(running)) => {
                S::select(running, limited, rho).named("residual_not_weighed")
            }
        };
        (residual, estimate, along)
    };
    let seen = gradient::Seen {
        y: (y_c, y_s),
        frame,
        e,
        rho: residual,
        along,
        theta,
        start: polar,
        sparse,
    };
    let gate = calibration::Gate {
        fresh,
        tick,
        whole_period: travel.whole_period,
        clear: travel.clear,
        dropped,
        bends_shown,
    };
    let searched = catch_up::searched(dropped, state, structure);
    let mut updated = calibration::update::<S, PLAIN>(&seen, searched, gate, state, k, structure);
    let completion = if PLAIN {
        None
    } else {
        structure.calibration.completed()
    };
    let completed = completion.map(|_| {
        let open = counting.and(hold.held.not()).named("parameters_free");
        let open = gate.for_bends(open, "bends_free");
        let seen = (updated.w_null, e, rho);
        completion::complete(
            seen,
            open,
            counting,
            (&travel, catch_up),
            state,
            k,
            structure,
        )
    });
    if let Some(completed) = &completed {
        let (old, nominal) = (state.theta_9_deviation, gears::nominal(state, k, structure));
        updated.theta[8] = step::moved(old, completed.step, 8, nominal, k, structure);
    }
    let mut gears = gears::gears(hold, gate, (counting, starting), state, k, structure);
    let memory = hold
        .recall
        .map(|recall| recall::recall(&mut updated, recall, &mut gears, state, k, structure));
    let recalled = memory.as_ref().map(|memory| memory.recalled);
    let astray = catch_up.map(|catch_up| catch_up.after(gate, counting, state));
    let failures = strays::failures((input.calibrate, weak, gears.restart), state, k, structure);
    let applied = waits::apply(updated.theta, waits, gate, recalled, state);

    rate.begin(&FLAGS);
    let lost_before = state.lock_lost.and(input.preset.not()).named("lost_before");
    let lost_now = state.locked.and(lock.locked.not()).named("lock_falls");
    let lost = lost_before.or(lost_now);
    let one = structure.method == Method::One;
    let speed = if one {
        rate.begin(&SPEED);
        // Method 1: the derivative of the position estimate.
        (position.alpha_hat - position.from).quantise(&structure.formats.phase_difference)
    } else {
        rate
    };
    let next_alpha_hat_previous = if one {
        position.from
    } else {
        state.alpha_hat_previous
    };
    let next_rate = if one { state.rate } else { rate };
    registers.alpha_hat = position.alpha_hat;
    registers.count = position.count;
    registers.alpha_hat_previous = next_alpha_hat_previous;
    registers.rate = next_rate;
    registers.error_previous = e;
    registers.lock_level = lock.level;
    registers.loop_gear = lock.gear;
    registers.gamma_gear = gears.gear;
    registers.gear_periods = gears.periods;
    registers.held_periods = gears.held_periods;
    registers.unlocked_samples = failures.unlocked_samples;
    registers.failed_periods = failures.failed_periods;
    registers.travel_origin = travel.origin;
    registers.travel_low = travel.low;
    registers.travel_high = travel.high;
    registers.ahead_used = travel.ahead_used;
    registers.behind_used = travel.behind_used;
    registers.locked = lock.locked;
    registers.lock_lost = lost;
    registers.signal_lost = weak;
    registers.direction = direction;
    registers.disturbed = gears.disturbed;
    registers.rough = gears.rough;
    registers.calm = gears.calm;
    registers.risen = gears.risen;
    registers.held = gears.held;
    if let Some(astray) = astray {
        [
            registers.astray,
            registers.astray_before,
            registers.astray_long,
        ] = astray;
    }
    applied.keep(registers);
    if !PLAIN {
        remember(registers, &updated, completed.as_ref());
        registers.start_periods = updated.start_periods;
    }
    if let Some(memory) = memory {
        memory.keep(registers);
    }
    let [theta_1, theta_2, theta_3, theta_4, theta_5] = theta;
    let whole_period = travel.whole_period;
    Probes {
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
        harmonic_cos,
        harmonic_sin,
        skew: ahead.unwrap_or(k.zero),
        cos_hat,
        sin_hat,
        e,
        rho,
        rho_c: along.0,
        rho_s: along.1,
        speed,
        in_window,
        fresh,
        whole_period,
    }
}

/// The registers of the searches that not every design has.
fn remember<S: Signal>(
    next: &mut State<S>,
    updated: &calibration::Update<S>,
    completed: Option<&completion::Completion<S>>,
) {
    [
        next.alpha_gradient_1,
        next.alpha_gradient_2,
        next.alpha_gradient_3,
        next.alpha_gradient_4,
        next.alpha_gradient_5,
    ] = updated.sensitivities.map(|s| s.gradient);
    [
        next.alpha_gradient_rate_1,
        next.alpha_gradient_rate_2,
        next.alpha_gradient_rate_3,
        next.alpha_gradient_rate_4,
        next.alpha_gradient_rate_5,
    ] = updated.sensitivities.map(|s| s.rate);
    [
        next.alpha_gradient_error_1,
        next.alpha_gradient_error_2,
        next.alpha_gradient_error_3,
        next.alpha_gradient_error_4,
        next.alpha_gradient_error_5,
    ] = updated.sensitivities.map(|s| s.error);
    [
        next.gathered_1,
        next.gathered_2,
        next.gathered_3,
        next.gathered_4,
        next.gathered_5,
        next.gathered_6,
        next.gathered_7,
        next.gathered_8,
    ] = updated.gathered;
    if let Some(completed) = completed {
        next.null_gradient = completed.sensitivity.gradient;
        next.null_gradient_rate = completed.sensitivity.rate;
        next.null_gradient_error = completed.sensitivity.error;
        next.travel_samples = completed.samples;
        next.gathered_9 = completed.gathered;
        next.moving = completed.moving;
    }
}
