//! What the search makes of a sample: where it moves the parameters, and when those are applied.

use super::followed::Followed;
use super::measured::Measured;
use super::{Coefficients, Input, State, Structure};
use super::{
    bend, calibration, catch_up, completion, counted, gears, recall, seen, step, strays, travel,
    waits,
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
    let way = counted::way::<S, PLAIN>(measured.e, input, state, k, structure);
    let counted = counted::counted(&way, (measured, followed), state, k, structure);
    let bends_shown = if PLAIN {
        None
    } else {
        bend::shown(state, k, structure)
    };
    let seen = seen::seen::<S, PLAIN>(measured, &way, bends_shown, state, k, structure);
    let gate = calibration::Gate {
        fresh: counted.fresh,
        tick: counted.tick,
        whole_period: way.travel.whole_period,
        clear: way.travel.clear,
        dropped: counted.dropped,
        bends_taught: bend::taught(bends_shown, state, k, structure),
    };
    let searched = catch_up::searched(gate.dropped, state, structure);
    let mut updated = calibration::update::<S, PLAIN>(&seen, searched, gate, state, k, structure);
    let (hold, of) = (counted.hold, (state, k, structure));
    let completed = complete::<S, PLAIN>(&mut updated, measured, (&way, gate, hold), of);
    let running = (way.counting, way.starting);
    let mut gears = gears::gears(hold, gate, running, state, k, structure);
    let memory = hold
        .recall
        .map(|recall| recall::recall(&mut updated, recall, &mut gears, state, k, structure));
    let recalled = memory.as_ref().map(|memory| memory.recalled);
    let astray = way.catch_up.map(|of| of.after(gate, way.counting, state));
    let troubles = (input.calibrate, measured.weak, gears.restart);
    let failures = strays::failures(troubles, state, k, structure);
    let applied = waits::apply(updated.theta, way.waits, gate, recalled, state);
    Learned {
        along: seen.along,
        fresh: counted.fresh,
        travel: way.travel,
        gears,
        failures,
        astray,
        applied,
        updated,
        completed,
        memory,
    }
}

/// Moves θ9, which no radius shows, where the design completes the gradient.
#[inline(always)]
fn complete<S: Signal, const PLAIN: bool>(
    updated: &mut calibration::Update<S>,
    measured: &Measured<S>,
    (way, gate, hold): (&counted::Way<S>, calibration::Gate<S>, gears::Hold<S>),
    (state, k, structure): (&State<S>, &Coefficients<S>, &Structure),
) -> Option<completion::Completion<S>> {
    if PLAIN || structure.calibration.completed().is_none() {
        return None;
    }
    let open = way.counting.and(hold.held.not()).named("parameters_free");
    let open = gate.for_bends(open, "bends_free");
    let seen = (updated.w_null, measured.e, measured.rho);
    let motion = (&way.travel, way.catch_up);
    let completed = completion::complete(seen, open, way.counting, motion, state, k, structure);
    let (old, nominal) = (state.theta_9_deviation, gears::nominal(state, k, structure));
    updated.theta[8] = step::moved(old, completed.step, 8, nominal, k, structure);
    Some(completed)
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
