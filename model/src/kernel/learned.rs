//! What the search makes of a sample: which samples count, where they move the parameters, and when those are applied.

use super::followed::Followed;
use super::measured::Measured;
use super::sparse::Sparse;
use super::{Coefficients, Input, State, Structure};
use super::{
    bend, calibration, catch_up, completion, gears, gradient, lock, recall, start, step, strays,
    sum_of_squares, travel, waits,
};
use crate::signal::{Logic, Signal};

/// The search after a sample.
pub struct Learned<S: Signal> {
    /// What the residual says along cos α̂ and sin α̂.
    pub along: (S, S),
    /// This sample may move the parameters.
    pub fresh: S::Bool,
    /// How far the scale has come.
    pub travel: travel::Travel<S>,
    /// The gears of γ.
    gears: gears::Gears<S>,
    /// What has failed.
    failures: strays::Failures<S>,
    /// Where the design catches up: what the running period of travel and those before have had of that.
    astray: Option<[S::Bool; 3]>,
    /// The parameters as they are applied.
    applied: waits::Applied<S>,
    /// The search.
    updated: calibration::Update<S>,
    /// The completed gradient.
    completed: Option<completion::Completion<S>>,
    /// What is remembered.
    memory: Option<recall::Memory<S>>,
}

/// One step of the search.
#[inline(always)]
pub fn learn<S: Signal, const PLAIN: bool>(
    (measured, followed): (&Measured<S>, &Followed<S>),
    input: &Input<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Learned<S> {
    let (e, rho, weak) = (measured.e, measured.rho, measured.weak);
    let (pair, estimate, window) = (measured.pair, measured.estimate, followed.window);
    let counting = travel::counting(input, state);
    let starting = (!PLAIN && structure.calibration.starts()).then(|| start::running(state, k));
    let measure = starting.map(|running| start::measure(e, running, k));
    let waits = waits::Waits::of(state, k, structure);
    let travel = travel::travel(counting, (measure, waits), state, k, structure);
    let catch_up = catch_up::catch_up(e, starting, state, k, structure);
    let follows = catch_up.map_or(window.inside, |catch_up| {
        window.inside.and(catch_up.now.not()).named("loop_follows")
    });
    let counts = counting.and(follows).named("sample_counts");
    let counted = counts.and(travel.new_sector).named("counted");
    let tick = counted.and(travel.whole_period).named("period_tick");
    let hold = gears::hold(
        rho,
        counts,
        (
            lock::present_anywhere(window, e, rho, k, structure),
            followed.lock.full,
        ),
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
        let epsilon = sum_of_squares::half_square(pair.0, pair.1, k.half, structure);
        let limited = gradient::limited(epsilon, None, structure);
        let (residual, direction) = along_which(limited, pair);
        let along = gradient::along(residual, direction, structure);
        (residual, pair, along)
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
        y: measured.y,
        frame,
        e,
        rho: residual,
        along,
        theta: measured.theta,
        start: polar,
        sparse,
    };
    let gate = calibration::Gate {
        fresh,
        tick,
        whole_period: travel.whole_period,
        clear: travel.clear,
        dropped,
        bends_taught: bend::taught(bends_shown, state, k, structure),
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
    Learned {
        along,
        fresh,
        travel,
        gears,
        failures,
        astray,
        applied,
        updated,
        completed,
        memory,
    }
}

impl<S: Signal> Learned<S> {
    /// The search's registers.
    #[inline(always)]
    pub fn keep<const PLAIN: bool>(self, next: &mut State<S>) {
        next.gamma_gear = self.gears.gear;
        next.gear_periods = self.gears.periods;
        next.held_periods = self.gears.held_periods;
        next.disturbed = self.gears.disturbed;
        next.rough = self.gears.rough;
        next.calm = self.gears.calm;
        next.risen = self.gears.risen;
        next.held = self.gears.held;
        next.unlocked_samples = self.failures.unlocked_samples;
        next.failed_periods = self.failures.failed_periods;
        next.travel_origin = self.travel.origin;
        next.travel_low = self.travel.low;
        next.travel_high = self.travel.high;
        next.ahead_used = self.travel.ahead_used;
        next.behind_used = self.travel.behind_used;
        if let Some(astray) = self.astray {
            [next.astray, next.astray_before, next.astray_long] = astray;
        }
        self.applied.keep(next);
        if !PLAIN {
            remember(next, &self.updated, self.completed.as_ref());
            next.start_periods = self.updated.start_periods;
        }
        if let Some(memory) = self.memory {
            memory.keep(next);
        }
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
