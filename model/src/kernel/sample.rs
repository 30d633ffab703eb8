//! The whole sample: what the chip does between two strobes of the ADC.

use super::followed::{Followed, follow};
use super::learned::{Learned, learn};
use super::measured::{Measured, measure};
use super::{Coefficients, Input, Method, Probes, State, Structure};
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
    let measured = measure::<S, PLAIN>(input, state, k, structure);
    let followed = follow(&measured, input, state, k, structure);
    let learned = learn::<S, PLAIN>((&measured, &followed), input, state, k, structure);

    let lost = lock_lost(&followed, input, state);
    let speed = speed(&followed, structure);
    let probes = probes((&measured, &followed, &learned), speed, k);
    registers.lock_lost = lost;
    registers.signal_lost = measured.weak;
    registers.error_previous = measured.e;
    followed.keep(registers, structure);
    learned.keep::<PLAIN>(registers);
    probes
}

/// Whether the lock was lost since the last preset, this sample included.
#[inline(always)]
fn lock_lost<S: Signal>(followed: &Followed<S>, input: &Input<S>, state: &State<S>) -> S::Bool {
    followed.rate.begin(&FLAGS);
    let before = state.lock_lost.and(input.preset.not());
    let falls = state.locked.and(followed.lock.locked.not());
    before.named("lost_before").or(falls.named("lock_falls"))
}

/// Position increment of this sample, turns.
#[inline(always)]
fn speed<S: Signal>(followed: &Followed<S>, structure: &Structure) -> S {
    if structure.method != Method::One {
        return followed.rate;
    }
    followed.rate.begin(&SPEED);
    // Method 1: the derivative of the position estimate.
    let position = &followed.position;
    (position.alpha_hat - position.from).quantise(&structure.formats.phase_difference)
}

/// What a sample shows.
#[inline(always)]
fn probes<S: Signal>(
    (measured, followed, learned): (&Measured<S>, &Followed<S>, &Learned<S>),
    speed: S,
    k: &Coefficients<S>,
) -> Probes<S> {
    let [theta_1, theta_2, theta_3, theta_4, theta_5] = measured.theta;
    let [theta_6, theta_7, theta_8, theta_9] = match &measured.bends {
        Some(bends) => [bends.theta_6, bends.theta_7, bends.theta_8, bends.theta_9],
        None => [k.zero; 4],
    };
    let (harmonic_cos, harmonic_sin) = measured.harmonics.unwrap_or((k.zero, k.zero));
    Probes {
        y_c: measured.y.0,
        y_s: measured.y.1,
        theta_1,
        theta_2,
        theta_3,
        theta_4,
        theta_5,
        theta_6,
        theta_7,
        theta_8,
        theta_9,
        c: measured.pair.0,
        s: measured.pair.1,
        harmonic_cos,
        harmonic_sin,
        skew: measured.skew.unwrap_or(k.zero),
        cos_hat: measured.estimate.0,
        sin_hat: measured.estimate.1,
        e: measured.e,
        rho: measured.rho,
        rho_c: learned.along.0,
        rho_s: learned.along.1,
        speed,
        in_window: followed.window.inside,
        fresh: learned.fresh,
        whole_period: learned.travel.whole_period,
    }
}
