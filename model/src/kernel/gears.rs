//! γ shifts gear: large first, halved after every few periods of travel, large again when the residual shows that the
//! signal has changed. A period that is dropped counts for no gear.
//!
//! A residual that was small and is no longer may be a signal that fades. So once a gear has ended with a period in which it was small
//! throughout (`calm`) it moves no parameter: they are held to the end of the first period without it. From the first period on that was
//! quiet a large one does the same, and after a sample out of the lock window they are held until the lock level is full again.
//!
//! Where it has been large for [`hold_unknown_periods`](crate::spec::Calibration::hold_unknown_periods), not counting those that were held
//! to their end without it, or where better parameters are known for [`hold_periods`](crate::spec::Calibration::hold_periods) more than not, and lock was not
//! lost, the signal has changed, and the search begins again; at once where it has followed a signal that faded, and the radius is far
//! too large now: the signal is back. A signal that is lost before the search has begun leaves parameters of which nothing is known: they
//! begin again from their nominal values, or with recall from the best that is known. After that they stay, and the first gear goes on.

use super::calibration::Gate;
use super::detector::within;
use super::strays::{bend_near_bound, strays};
use super::{Coefficients, State, Structure, bend};
use crate::signal::{Formula, Logic, Signal};

static HOLD: Formula = Formula {
    title: "Hold",
    equation: "from the first quiet period on a large residual, once a gear has ended calm one that is not small, and all until the end of a period without one, moves no parameter",
    source: "",
};

static GEARS: Formula = Formula {
    title: "Gears of gamma",
    equation: "gamma halves after some periods of travel, starts again when the residual stays large",
    source: "",
};

/// γ gear, periods in it, and whether the parameters are held.
pub struct Gears<S: Signal> {
    /// γ gear.
    pub gear: S,
    /// Quiet periods of travel in this gear, without those that were dropped.
    pub periods: S,
    /// Periods of travel with a large residual.
    pub held_periods: S,
    /// The periods of this gear have passed without a large residual.
    pub passed: S::Bool,
    /// A period of the first gear has passed without a large residual, and was not dropped.
    pub first: S::Bool,
    /// The search begins again.
    pub restart: S::Bool,
    /// It does because the residual has stayed.
    pub stayed: S::Bool,
    /// The residual was large in the running period.
    pub disturbed: S::Bool,
    /// The residual was not small in the running period.
    pub rough: S::Bool,
    /// A gear has ended with a period in which it was small throughout.
    pub calm: S::Bool,
    /// The radius was too large in the running period.
    pub risen: S::Bool,
    /// The residual was large in the last period.
    pub held: S::Bool,
}

/// What the residual of a sample says about the ones that follow.
#[derive(Clone, Copy, Debug)]
pub struct Hold<S: Signal> {
    /// The residual of a sample that counts is large.
    pub large: S::Bool,
    /// That of a sample that counts is not small.
    pub rough: S::Bool,
    /// The residual is large, and the radius too large, not too small.
    pub risen: S::Bool,
    /// No parameter moves.
    pub held: S::Bool,
    /// Where there is recall: and what is proven is of this signal.
    pub recall: Option<S::Bool>,
}

/// Whether the parameters are held; `counts`: the sample counts, wherever in the period it is; `present`: the signal's radius is not too small;
/// `follows`: neither it nor the last ones were out of the lock window.
#[inline(always)]
pub fn hold<S: Signal>(
    rho: S,
    counts: S::Bool,
    (present, follows): (S::Bool, S::Bool),
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Hold<S> {
    rho.begin(&HOLD);
    let risen = rho.less_than(k.restart_residual).not().named("rho_high");
    let large = risen
        .or(rho.less_than(-k.restart_residual))
        .named("rho_large");
    let not_small = within(rho, k.hold_residual).not().named("rho_not_small");
    let large = large
        .or(calm(state, k, structure).and(not_small))
        .named("rho_too_large")
        .and(counts)
        .named("residual_large");
    let disturbed = large.or(state.disturbed).named("disturbed_lately");
    let disturbed = disturbed.or(state.held).named("disturbed_or_held");
    let disturbed = if structure.calibration.recalls() {
        disturbed.or(state.returning).named("disturbed_or_recalled")
    } else {
        disturbed
    };
    let suspect = disturbed.or(follows.not());
    // What follows badly finds back while they are free.
    let held = suspect
        .named("hold_cause")
        .and(begun(state, k))
        .named("hold");
    // γ is in its last gear then: where it leaves it nothing is known, or the signal may be fading.
    let recall = structure.calibration.recalls().then(|| {
        let proven = proven(state);
        // What has moved on since is recalled only where the signal rises, or was fading before it was lost.
        let rises = rho.less_than(k.hold_residual).not().named("rho_rises");
        // A gap that ends a period leaves one.
        let faded = state.held_periods.less_than(k.one.scale(2)).not();
        let faded = faded.and(state.locked.not()).named("held_and_lost");
        let better = state.apart.not().or(rises).or(faded).named("proven_better");
        let proven = proven.and(better).named("may_recall");
        // Where only the loop goes astray, nothing was learned.
        let doubt = disturbed.or(present.not()).named("signal_in_doubt");
        let doubtful = held.and(doubt).named("held_in_doubt");
        doubtful.and(proven).named("recall")
    });
    Hold {
        large,
        rough: not_small.and(counts).named("residual_rough"),
        risen: risen.and(counts).named("radius_large"),
        held,
        recall,
    }
}

/// Something is proven, and the search has not begun again since because it no longer held.
#[inline(always)]
fn proven<S: Signal>(state: &State<S>) -> S::Bool {
    state.known.and(state.fading.not()).named("proven_stand")
}

/// γ is as small as it becomes.
#[inline(always)]
pub fn last_gear<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    let before = state.gamma_gear.less_than(k.gamma_gear_last);
    before.not().named("last_gamma_gear")
}

/// γ has settled. With fewer gears it never has.
#[inline(always)]
pub fn settled<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    if !structure.calibration.settles() {
        return k.never();
    }
    let early = state.gamma_gear.less_than(k.gamma_gear_settled);
    early.not().named("gamma_settled")
}

/// A gear of this search has ended with a period in which the residual was small. What never settles has nothing to hold.
#[inline(always)]
fn calm<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    if structure.calibration.settles() {
        state.calm
    } else {
        k.never()
    }
}

/// The signal is lost before the search has begun: nothing is known, and the parameters are nominal. With recall what is proven is
/// better in all of the first gear: it may have followed a fade. Bends that swing widely on their way can come to their bounds, where the
/// loop does not lock any more: without lock these begin again in the same way. A search that [`strays`] begins again from nothing.
#[inline(always)]
pub fn nominal<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    let lost = if structure.calibration.swings() {
        state
            .signal_lost
            .or(bend_near_bound(state, k))
            .named("signal_or_bend_lost")
    } else {
        state.signal_lost
    };
    let lost = lost.and(state.locked.not());
    let lost = first_gear(state, k).and(lost).named("lost_in_first_gear");
    let unknown = begun(state, k).not();
    let unknown = if structure.calibration.recalls() {
        unknown.or(state.known).named("proven_or_unknown")
    } else {
        unknown
    };
    let lost = lost.and(unknown);
    strays(state, k, structure)
        .map_or(lost, |strays| lost.named("lost_and_unknown").or(strays))
        .named("nominal")
}

/// A period of travel has passed without a large residual, and was not dropped, since γ was as large as it begins; in the first gear a
/// loss of lock does not take that back.
#[inline(always)]
pub fn begun<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    let any = state.gear_periods.less_than(k.one).not();
    first_gear(state, k).not().or(any).named("search_begun")
}

/// γ is as large as it begins.
#[inline(always)]
pub fn first_gear<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    state.gamma_gear.less_than(k.one)
}

/// A period of travel ends in which the residual was large.
#[inline(always)]
fn disturbed_period<S: Signal>(gate: Gate<S>, state: &State<S>) -> S::Bool {
    gate.tick.and(state.disturbed).named("disturbed_period")
}

/// A period had a large residual, and the parameters have not followed for one since.
#[inline(always)]
fn held_before<S: Signal>(state: &State<S>, k: &Coefficients<S>) -> S::Bool {
    state
        .held_periods
        .less_than(k.one)
        .not()
        .named("held_before")
}

/// As many periods have been counted as a signal is waited for that may come back: where better parameters are known, for longer.
#[inline(always)]
fn long<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    let some = state.held_periods.less_than(k.held_periods_last).not();
    let some = some.named("held_some_periods");
    if !structure.calibration.recalls() {
        return some;
    }
    let many = state.held_periods.less_than(k.hold_periods_last).not();
    let unknown = some.and(proven(state).not()).named("held_unknown");
    many.or(unknown).named("held_long")
}

/// Periods with a large residual, until the parameters have followed for one; where better parameters are known, as many more as those in
/// which they have.
#[inline(always)]
fn held_periods<S: Signal>(
    (gate, quiet_ends): (Gate<S>, S::Bool),
    restart: S::Bool,
    counting: S::Bool,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S {
    let up = S::select(disturbed_period(gate, state), k.one, k.zero).named("held_periods_up");
    // Every second one holds them as well as one after the other: what follows one is held to its end.
    let goes_on = quiet_ends.not().named("no_quiet_period_ends");
    let (step, goes_on) = if structure.calibration.recalls() {
        let free = quiet_ends.and(state.returning.not());
        let free = free.named("parameters_followed");
        let down = free.and(held_before(state, k));
        let step = S::select(down.named("free_period"), -k.one, up).named("held_periods_step");
        (step, goes_on.or(state.known).named("goes_on_or_known"))
    } else {
        (up, goes_on)
    };
    // Without lock nothing is travelled.
    let stays = goes_on.and(counting).named("held_periods_go_on");
    let stays = stays.or(state.held).named("held_or_going_on");
    let stays = stays.and(restart.not()).named("held_periods_stay");
    let counted = (state.held_periods + step).quantise(&structure.formats.held_periods);
    S::select(stays, counted, k.zero).quantise(&structure.formats.held_periods)
}

/// The search begins again: the residual was large before it had ever been small, or for so long that the signal must have changed, or the
/// radius is too large and it had followed a fade.
#[inline(always)]
pub fn restart<S: Signal>(
    gate: Gate<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S::Bool {
    let early = calm(state, k, structure).not();
    let early = if structure.calibration.guards_early() {
        // A signal that is lost where a period ends disturbs one.
        let again = begun(state, k).not().or(held_before(state, k));
        let again = again.named("disturbed_again");
        early.and(again).named("search_fails")
    } else {
        early
    };
    let cause = early.or(long(state, k, structure));
    let cause = if structure.calibration.recalls() {
        cause.or(state.risen.and(state.fading).named("rises_again"))
    } else {
        cause
    };
    let cause = cause.named("restart_cause");
    disturbed_period(gate, state)
        .and(cause)
        .named("gamma_restart")
}

/// The γ gear after this sample. A period that was solved by least squares (`starting`) is worth a whole gear.
#[inline(always)]
pub fn gears<S: Signal>(
    hold: Hold<S>,
    gate: Gate<S>,
    (counting, starting): (S::Bool, Option<S::Bool>),
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Gears<S> {
    state.gamma_gear.begin(&GEARS);
    let tick = gate.tick;
    let restart = restart(gate, state, k, structure);
    let last = last_gear(state, k);
    let done = state.gear_periods.less_than(k.gear_periods_last).not();
    let done = if structure.calibration.recalls() {
        // What comes back slowly is small again before it is whole, for about the tenth part of the way.
        let early = state.gear_periods.less_than(k.returning_periods);
        let early = state.returning.and(early).named("returned_lately");
        done.and(early.not()).named("gear_periods_done")
    } else {
        done
    };
    let done = starting.map_or(done, |starting| done.or(starting));
    let before = state.disturbed.or(state.held).named("disturbed_before");
    let quiet = before.not().named("quiet");
    let done = done.and(quiet).named("gear_done");
    // A period that is dropped has taught nothing.
    let learned = gate
        .dropped
        .map_or(tick, |dropped| tick.and(dropped.not()).named("period_kept"));
    let passed = learned.and(done).named("gear_passed");
    let shift = passed.and(last.not()).named("gamma_shift");
    let up = S::select(shift, k.one, k.zero).named("gamma_gear_up");
    let gear = (state.gamma_gear + up)
        .quantise(&structure.formats.gamma_gear)
        .named("gamma_gear_counted");
    let quiet_ends = tick.and(quiet).named("quiet_period_ends");
    let kept = learned.and(quiet).named("quiet_period_kept");
    let one_more = S::select(kept, k.one, k.zero).named("gear_periods_up");
    let counted = (state.gear_periods + one_more).quantise(&structure.formats.gear_periods);
    // Periods before one that was not quiet, or before a loss of lock, were not quiet. In the first gear they say that there is
    // something to keep.
    let breaks = tick.and(quiet.not()).named("disturbed_period_ends");
    let breaks = hold
        .recall
        .map_or(breaks, |_| breaks.or(counting.not()))
        .named("quiet_breaks_off")
        .and(first_gear(state, k).not())
        .named("gear_breaks_off");
    // What has only one gear has begun once and for all.
    let (counted, passed_again) = if structure.calibration.gears() == 0 {
        let counted = S::select(passed, k.one, counted).named("gear_periods_begun");
        (counted, k.never())
    } else {
        (counted, passed)
    };
    // One that has strayed begins in the first gear, too.
    let begins = strays(state, k, structure)
        .map_or(restart, |strays| restart.or(strays).named("search_begins"));
    let again = passed_again.or(begins).named("gear_ends").or(breaks);
    let again = again.named("gear_periods_again");
    let held_periods = held_periods((gate, quiet_ends), restart, counting, state, k, structure);
    let within = tick.not().and(counting).named("within_period");
    let smooth = passed.and(state.rough.not());
    // While bends by sums of squares rest, what they will do is not known.
    let smooth = if structure.calibration.swings() {
        smooth.and(bend::rest(state, k).not())
    } else {
        smooth
    };
    let smooth = smooth.named("gear_ends_calm");
    let calm = smooth.or(state.calm).and(begins.not()).named("stays_calm");
    let still_held = state.held.and(tick.not()).named("still_held");
    let held = disturbed_period(gate, state)
        .and(restart.not())
        .or(still_held)
        .named("holding");
    Gears {
        gear: S::select(begins, k.zero, gear).quantise(&structure.formats.gamma_gear),
        periods: S::select(again, k.zero, counted).quantise(&structure.formats.gear_periods),
        held_periods,
        passed,
        first: kept.and(first_gear(state, k)).named("first_gear_period"),
        restart,
        stayed: restart.and(long(state, k, structure)),
        // Where nothing counts, a new period begins without suspicion.
        disturbed: hold.large.or(state.disturbed.and(within)),
        rough: hold.rough.or(state.rough.and(within)),
        calm,
        risen: hold.risen.or(state.risen.and(within)),
        held: held.and(counting),
    }
}
