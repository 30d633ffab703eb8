//! Where samples are few: what the radius at few places of the period cannot show, the phase error does.
//!
//! At exactly four samples a period the radius tells one combination of the gains' difference and the phase from the radius of a
//! circle, and not the other. At exactly eight the bend of third order that both channels have shows by cos 4α, which can be 0 at all
//! of them. What changes no radius there turns the pair, forward at one sample and back at the next, and no loop follows that: in the exact
//! gradient, Mᵀ n ρ + (w − ∇α̂)ᵀ e, ∇α̂ is next to nothing, and no recursion is needed. So of every four periods at such a speed two
//! teach along the radius, by n ρ, and two along the circle, by n⊥ e: the same multipliers, no product more. Of e counts what changes from sample to sample:
//! what a loop lags is no error of the sensor.

use super::detector::within;
use super::travel::Travel;
use super::{Coefficients, State, Structure, loop_filter};
use crate::signal::{Formula, Logic, Signal};

static SPARSE: Formula = Formula {
    title: "Few samples a period",
    equation: "of every four periods two teach by e_alternating = (e - e_1)/2 along the circle instead of by rho along the radius: gains and phase from a rate of \
               7/32 on; theta_8 alone, by -sin(4 alpha_hat), from 15/128 on, until bends rest",
    source: "paper equation (11) where no loop follows, no part of its final form",
};

/// What a sample teaches along the circle.
#[derive(Clone, Copy, Debug)]
pub struct Sparse<S: Signal> {
    /// Gains and phase are taught so, and nothing else.
    pub ellipse: Option<S::Bool>,
    /// The third order of both channels is, and nothing else.
    pub third: Option<S::Bool>,
    /// What of the phase error changes from sample to sample, radians.
    pub e: S,
}

impl<S: Signal> Sparse<S> {
    /// Whether a design needs it, and what this sample is for. Not while the start by least squares is `running`, nor of bends that this
    /// speed does not show.
    pub fn of(
        e: S,
        travel: &Travel<S>,
        (running, bends_shown): (Option<S::Bool>, Option<S::Bool>),
        state: &State<S>,
        k: &Coefficients<S>,
        structure: &Structure,
    ) -> Option<Self> {
        if !(structure.sparse || structure.sparse_bends) {
            return None;
        }
        e.begin(&SPARSE);
        let rate = loop_filter::rate_before(state, structure);
        let turn = travel.periods.less_than(k.zero).named("periods_of_turning");
        let turn = running.map_or(turn, |running| {
            turn.and(running.not()).named("periods_turn_now")
        });
        let from = |limit: S, name: &'static str| within(rate, limit).not().and(turn).named(name);
        let ellipse = structure
            .sparse
            .then(|| from(k.sparse_rate, "ellipse_by_e"));
        let third = structure.sparse_bends.then(|| {
            let third = from(k.sparse_bends_rate, "third_by_e");
            bends_shown.map_or(third, |shown| third.and(shown).named("third_shown_by_e"))
        });
        let e = (e - state.error_previous)
            .scale(-1)
            .quantise(&structure.formats.residual)
            .named("e_alternating");
        Some(Self { ellipse, third, e })
    }

    /// What n ρ is made of: residual and direction; of what shows along the circle n⊥ e, and nothing where only θ8 is taught.
    pub fn along(self, rho: S, (cos, sin): (S, S), k: &Coefficients<S>) -> (S, (S, S)) {
        let (mut residual, mut direction) = (rho, (cos, sin));
        if let Some(ellipse) = self.ellipse {
            residual = S::select(ellipse, self.e, residual);
            direction = (
                S::select(ellipse, -sin, cos).named("direction_c"),
                S::select(ellipse, cos, sin).named("direction_s"),
            );
        }
        if let Some(third) = self.third {
            residual = S::select(third, k.zero, residual);
        }
        (residual.named("residual_along"), direction)
    }
}
