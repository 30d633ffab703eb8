//! What the loop makes of a sample: whether it follows, and where it goes.

use super::measured::Measured;
use super::{Coefficients, Input, Method, State, Structure};
use super::{lock, loop_filter, position};
use crate::signal::{Logic, Signal};

/// The loop after a sample.
pub struct Followed<S: Signal> {
    /// What the sample looks like.
    pub window: lock::Window<S>,
    /// The lock detector.
    pub lock: lock::Lock<S>,
    /// Phase increment per sample, turns.
    pub rate: S,
    /// Where the next sample is expected.
    pub position: position::Position<S>,
    /// The scale runs backwards.
    pub direction: S::Bool,
}

/// One step of the loop.
#[inline(always)]
pub fn follow<S: Signal>(
    measured: &Measured<S>,
    input: &Input<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Followed<S> {
    let (e, rho, weak) = (measured.e, measured.rho, measured.weak);
    let window = lock::in_window(e, rho, weak, k, structure);
    let flip = lock::flip(rho, weak, state, k).named("flip");
    let lock = lock::update(window.inside, state, k, structure);

    let rate = loop_filter::rate(e, state, k, structure);
    let position = position::advance(rate, flip, input.preset, state, k, structure);
    let direction = position::direction(rate, state.direction, k);
    Followed {
        window,
        lock,
        rate,
        position,
        direction,
    }
}

impl<S: Signal> Followed<S> {
    /// The loop's registers.
    #[inline(always)]
    pub fn keep(&self, next: &mut State<S>, structure: &Structure) {
        if structure.method == Method::One {
            next.alpha_hat_previous = self.position.from;
        } else {
            next.rate = self.rate;
        }
        next.alpha_hat = self.position.alpha_hat;
        next.count = self.position.count;
        next.direction = self.direction;
        next.lock_level = self.lock.level;
        next.loop_gear = self.lock.gear;
        next.locked = self.lock.locked;
    }
}
