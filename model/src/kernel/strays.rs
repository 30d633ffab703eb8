//! A search by sums of squares can learn what the loop does not lock to, or swing between bends at their bounds, and nothing in the
//! gradient leads back from there. Where that lasts, and γ has not settled, it gives up what it has learnt.

use super::calibration::Gate;
use super::gears::{first_gear, restart, settled};
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Logic, Signal};

static STRAYS: Formula = Formula {
    title: "Search that has strayed",
    equation: "until gamma has settled: many samples without lock though there is a signal, or periods of travel that fail, one after the other",
    source: "",
};

/// What speaks against the search.
pub struct Failures<S: Signal> {
    /// Samples without lock though there is a signal.
    pub unlocked_samples: S,
    /// Periods of travel after each of which the search began again.
    pub failed_periods: S,
}

/// What speaks against the search after this sample; nothing where it finds back by itself.
#[inline(always)]
pub fn failures<S: Signal>(
    (gate, weak): (Gate<S>, S::Bool),
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Failures<S> {
    if !structure.calibration.may_stray() {
        return Failures {
            unlocked_samples: k.zero,
            failed_periods: k.zero,
        };
    }
    state.gamma_gear.begin(&STRAYS);
    let searching = settled(state, k, structure)
        .or(strays_at_last(state, k))
        .not()
        .named("search_goes_on");
    let samples = &structure.formats.unlocked_samples;
    let up = S::select(weak, k.zero, k.unlocked_sample).named("unlocked_samples_up");
    let one_more = (state.unlocked_samples + up).quantise(samples);
    let counted = searching
        .and(state.locked.not())
        .named("unlocked_samples_go_on");
    let counts = searching
        .and(first_gear(state, k))
        .named("failed_periods_go_on");
    let periods = &structure.formats.failed_periods;
    let fails = restart(gate, state, k, structure);
    let up = S::select(fails, k.one, k.zero).named("failed_periods_up");
    let failed = (state.failed_periods + up).quantise(periods);
    Failures {
        unlocked_samples: S::select(counted, one_more, k.zero).quantise(samples),
        failed_periods: S::select(counts, failed, k.zero).quantise(periods),
    }
}

/// It will not find its way.
#[inline(always)]
fn strays_at_last<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    let few = state.unlocked_samples.less_than(k.unlocked_samples_last);
    let short = state.failed_periods.less_than(k.failed_periods_last);
    few.and(short).not().named("lost_its_way")
}

/// Whether the search gives up what it has learnt; `None` where it finds back by itself.
#[inline(always)]
pub fn strays<S: Signal>(
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Option<S::Bool> {
    if !structure.calibration.may_stray() {
        return None;
    }
    state.gamma_gear.begin(&STRAYS);
    let searching = settled(state, k, structure).not();
    Some(searching.and(strays_at_last(state, k)).named("strays"))
}
