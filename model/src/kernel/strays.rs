//! A search by sums of squares can learn what the loop does not lock to, or swing between bends at their bounds, and nothing in the
//! gradient leads back from there. Where that lasts, γ has not settled, and nothing is proven, it gives up what it has learnt.

use super::detector::within;
use super::gears::{first_gear, settled};
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Logic, Signal};

static STRAYS: Formula = Formula {
    title: "Search that has strayed",
    equation: "until gamma has settled, with nothing proven: many samples without lock though there is a signal, or in the first gear periods of travel that fail with theta_8 near its bound",
    source: "",
};

/// What speaks against the search.
pub struct Failures<S: Signal> {
    /// Samples without lock though there is a signal.
    pub unlocked_samples: S,
    /// Periods of travel of the first gear after each of which the search began again, with bends near their bounds.
    pub failed_periods: S,
}

/// What speaks against the search after this sample; nothing where it finds back by itself. `calibrate`: the pin; `weak`: there is no
/// signal; `restart`: the search begins again.
#[inline(always)]
pub fn failures<S: Signal>(
    (calibrate, weak, restart): (S::Bool, S::Bool, S::Bool),
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
    let goes_on = searching(state, k, structure);
    let goes_on = goes_on.and(enough(state, k, structure).not());
    let goes_on = goes_on.named("search_goes_on");
    let samples = &structure.formats.unlocked_samples;
    let up = S::select(weak, k.zero, k.unlocked_sample).named("unlocked_samples_up");
    let one_more = (state.unlocked_samples + up).quantise(samples);
    let unlocked = calibrate.and(state.locked.not()).named("free_without_lock");
    let counted = goes_on.and(unlocked).named("unlocked_samples_go_on");
    let failed_periods = if structure.calibration.swings() {
        let periods = &structure.formats.failed_periods;
        let fails = restart.and(bend_near_bound(state, k));
        let up = S::select(fails.named("fails_at_bound"), k.one, k.zero);
        let up = up.named("failed_periods_up");
        let failed = (state.failed_periods + up).quantise(periods);
        let counts = goes_on.and(first_gear(state, k));
        S::select(counts.named("failed_periods_go_on"), failed, k.zero).quantise(periods)
    } else {
        k.zero
    };
    Failures {
        unlocked_samples: S::select(counted, one_more, k.zero).quantise(samples),
        failed_periods,
    }
}

/// γ has not settled, and nothing is proven.
#[inline(always)]
fn searching<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    let late = settled(state, k, structure);
    let late = if structure.calibration.recalls() {
        late.or(state.known).named("settled_or_proven")
    } else {
        late
    };
    late.not().named("searching_still")
}

/// The bends stand near their bounds.
#[inline(always)]
pub fn bend_near_bound<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    let inside = within(state.theta_8_deviation, k.bend_near_bound);
    inside.not().named("bend_near_bound_reached")
}

/// So much speaks against it that it will not find its way.
#[inline(always)]
fn enough<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    let few = state.unlocked_samples.less_than(k.unlocked_samples_last);
    if !structure.calibration.swings() {
        return few.not().named("unlocked_for_long");
    }
    let short = state.failed_periods.less_than(k.failed_periods_last);
    let may = few.and(short).named("may_find_its_way");
    may.not().named("lost_its_way")
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
    let searching = searching(state, k, structure);
    Some(searching.and(enough(state, k, structure)).named("strays"))
}
