//! γ shifts gear: large first, halved after every few periods of travel, large again when the residual shows that the
//! signal has changed.

use super::calibration::Gate;
use super::detector::within;
use super::{Coefficients, State, Structure};
use crate::format::Quantiser;
use crate::signal::{Formula, Logic, Signal};

static GEARS: Formula = Formula {
    title: "Gears of gamma",
    equation: "gamma halves after some periods of travel, starts again when the residual was large",
    source: "",
};

/// γ gear, periods in it, and whether the running period was disturbed.
pub struct Gears<S: Signal> {
    /// γ gear.
    pub gear: S,
    /// Periods of travel in this gear.
    pub periods: S,
    /// The residual was large in the running period.
    pub disturbed: S::Bool,
}

/// A period of travel ends, with a sample that counts.
pub fn tick<S: Signal>(gate: Gate<S>) -> S::Bool {
    gate.whole_period.and(gate.fresh).named("period_tick")
}

/// The period that ends was disturbed: the search begins again.
pub fn restart<S: Signal>(gate: Gate<S>, state: &State<S>) -> S::Bool {
    tick::<S>(gate).and(state.disturbed).named("gamma_restart")
}

/// The γ gear after this sample. A period that was solved by least squares (`starting`) is worth a whole gear.
pub fn gears<S: Signal>(
    rho: S,
    gate: Gate<S>,
    starting: Option<S::Bool>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Gears<S> {
    rho.begin(&GEARS);
    let gear_format = Quantiser::wrapping(structure.formats.gamma_gear);
    let period_format = Quantiser::wrapping(structure.formats.gear_periods);
    let large = within(rho, k.restart_residual)
        .not()
        .and(gate.fresh)
        .named("residual_large");
    let tick = tick::<S>(gate);
    let restart = restart(gate, state);
    let last = state.gamma_gear.less_than(k.gamma_gear_last).not();
    let done = state.gear_periods.less_than(k.gear_periods_last).not();
    let done = starting.map_or(done, |starting| done.or(starting));
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
