//! The completed gradient: one scalar sensitivity for θ9, the direction that no radius shows.
//!
//! The pair turns by 2 sin 2α per unit of θ9, so w = ½ sin 2α̂ = sin α̂ cos α̂ up to a factor that γ takes. θ9 learns at
//! γ |S(2f)|²/2 per sector of travel, S the loop's sensitivity at twice the signal's frequency f: what a wide loop follows, it
//! cannot tell from motion. Hence the gate: whole periods of net travel must follow one another fast enough, and θ9 moves where
//! one of them ends, by what its 64 sectors gathered. What a loop lags behind an axis that gathers speed or brakes is nearly the
//! same all round the period, and w is zero on average. A period in which the axis stops is dropped with what it shakes with there,
//! and so is one with a sample whose |e| is more than a sensor's error, a stop or a start, and one in which bends rest. Standstill, slow motion and vibration,
//! however fast, rest.

use super::catch_up::CatchUp;
use super::detector::within;
use super::sensitivity::{self, Sensitivity, names};
use super::travel::Travel;
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Logic, Signal, Wide};

static COMPLETION: Formula = Formula {
    title: "Completion of the gradient",
    equation: "theta_9 -= gamma_v sum of (w - grad alpha_hat) e over a period of travel, w = sin(alpha_hat) cos(alpha_hat)",
    source: "paper section 5.5, equation (11), along the null direction of section 5.4",
};

static MOVING: Formula = Formula {
    title: "Travel fast enough for the completion",
    equation: "moving from one whole period of travel to the next, while they take few samples; one with a stop, large e or large rho, or in which bends rest, teaches nothing",
    source: "",
};

/// What the completion decides and remembers.
pub struct Completion<S: Signal> {
    /// What θ9 moves back by.
    pub step: S,
    /// ∇α̂ along the direction.
    pub sensitivity: Sensitivity<S>,
    /// Samples since the last whole period of travel.
    pub samples: S,
    /// The gradient of the running period of travel so far.
    pub gathered: S,
    /// Net travel is fast enough.
    pub moving: S::Bool,
}

/// The completion of this sample; `w` is sin α̂ cos α̂, `open` says that samples count and bends may move.
pub fn complete<S: Signal>(
    (w, e, rho): (S, S, S),
    open: S::Bool,
    counting: S::Bool,
    (travel, catch_up): (&Travel<S>, Option<CatchUp<S>>),
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Completion<S> {
    let before = Sensitivity {
        gradient: state.null_gradient,
        rate: state.null_gradient_rate,
        error: state.null_gradient_error,
    };
    let sensitivity = sensitivity::advance(w, before, names!("null"), k, structure);
    e.begin(&MOVING);
    let late = state
        .travel_samples
        .less_than(k.travel_samples_last)
        .not()
        .named("travel_late");
    let fast = late.not().and(counting).named("fast_enough");
    // A period of which a part is missing would pull to one side.
    let follows = follows((e, rho), catch_up, open, k, structure);
    let spoilt = travel.new_sector.and(follows.not()).named("period_spoilt");
    let learns = state.moving.and(spoilt.not()).named("completion_learns");
    let moving = fast.and(travel.whole_period.or(learns));
    let clear = travel.whole_period.or(counting.not());
    let one_more = S::select(late, k.zero, k.one).named("travel_samples_up");
    let samples = (state.travel_samples + one_more).quantise(&structure.formats.travel_samples);
    e.begin(&COMPLETION);
    let gamma = structure.calibration.completed().unwrap_or(0) as i32;
    let step = (sensitivity.error * e)
        .scale(-gamma)
        .named("gradient_9")
        .quantise(&structure.formats.step)
        .named("sector_step_9");
    let adds = learns.and(travel.new_sector).named("sector_learned");
    let gathered = (state.gathered_9 + S::select(adds, step, k.zero))
        .quantise(&structure.formats.deviation[8]);
    let done = learns.and(travel.whole_period).named("period_learned");
    let goes_on = learns.and(clear.not()).named("period_goes_on");
    Completion {
        step: S::select(done, gathered, k.zero).named("step_9"),
        gathered: S::select(goes_on, gathered, k.zero),
        sensitivity,
        samples: S::select(clear, k.zero, samples).quantise(&structure.formats.travel_samples),
        moving,
    }
}

/// The loop follows, on a circle.
fn follows<S: Signal>(
    (e, rho): (S, S),
    catch_up: Option<CatchUp<S>>,
    open: S::Bool,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S::Bool {
    // What fades or is not yet calibrated along the radius teaches nothing across it.
    let small = within(rho, k.small_error).named("rho_small");
    let round = open.and(small).named("completion_open");
    // Where the loop catches up with motion, e is no error of the sensor. A loop of type 1 always lags.
    let calm = match catch_up {
        Some(catch_up) => catch_up.of_sensor,
        None if structure.filter_type == 1 => return round,
        None => within(e, k.small_error).named("e_small"),
    };
    round.and(calm).named("completion_follows")
}
