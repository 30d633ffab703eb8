//! Which samples count, and which of them teach.
//!
//! A sample counts while the search is allowed, the loop is locked and not catching up with a stop or a start, in a sector of
//! the period that has not been used. It teaches where the parameters are not held, unless it ends a period that is dropped.

use super::catch_up::{self, CatchUp};
use super::followed::Followed;
use super::gears::{self, Hold};
use super::measured::Measured;
use super::travel::{self, Travel};
use super::waits::Waits;
use super::{Coefficients, Input, State, Structure, lock, start};
use crate::signal::{Logic, Signal};

/// Where the scale has come to, and whether the loop is with it.
pub struct Way<S: Signal> {
    /// Calibration is allowed, from outside and by the lock.
    pub counting: S::Bool,
    /// Where the design has a start by least squares: it is still at work.
    pub starting: Option<S::Bool>,
    /// Whether what a period teaches waits for its end.
    pub waits: Waits<S>,
    /// How far the scale has come.
    pub travel: Travel<S>,
    /// Where that can be known: what the loop does that is no error of the sensor.
    pub catch_up: Option<CatchUp<S>>,
}

/// As it is with this sample, of phase error `e`.
#[inline(always)]
pub fn way<S: Signal, const PLAIN: bool>(
    e: S,
    input: &Input<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Way<S> {
    let counting = travel::counting(input, state);
    let starting = (!PLAIN && structure.calibration.starts()).then(|| start::running(state, k));
    let measure = starting.map(|running| start::measure(e, running, k));
    let waits = Waits::of(state, k, structure);
    let travel = travel::travel(counting, (measure, waits), state, k, structure);
    let catch_up = catch_up::catch_up(e, starting, state, k, structure);
    Way {
        counting,
        starting,
        waits,
        travel,
        catch_up,
    }
}

/// What a sample counts for.
pub struct Counted<S: Signal> {
    /// A period of travel ends with a sample that counts, be the parameters held or not.
    pub tick: S::Bool,
    /// What its residual says about the ones that follow.
    pub hold: Hold<S>,
    /// Where parameters move at the end of a period: it ends, and what it taught is dropped.
    pub dropped: Option<S::Bool>,
    /// This sample may move the parameters.
    pub fresh: S::Bool,
}

/// Of this sample, on this `way`.
#[inline(always)]
pub fn counted<S: Signal>(
    way: &Way<S>,
    (measured, followed): (&Measured<S>, &Followed<S>),
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Counted<S> {
    let (e, rho, window) = (measured.e, measured.rho, followed.window);
    let (travel, catch_up) = (&way.travel, way.catch_up);
    let follows = catch_up.map_or(window.inside, |catch_up| {
        window.inside.and(catch_up.now.not()).named("loop_follows")
    });
    let counts = way.counting.and(follows).named("sample_counts");
    let counted = counts.and(travel.new_sector).named("counted");
    let tick = counted.and(travel.whole_period).named("period_tick");
    let present = lock::present_anywhere(window, e, rho, k, structure);
    let of_signal = (present, followed.lock.full);
    let hold = gears::hold(rho, counts, of_signal, state, k, structure);
    let free = counted.and(hold.held.not());
    let early = catch_up.and_then(|catch_up| catch_up.teaches);
    let taught = early.map_or(free, |teaches| free.named("counted_and_free").and(teaches));
    let dropped = catch_up.and_then(|catch_up| catch_up.drops(travel.clear, state, structure));
    let fresh = dropped.map_or(taught, |dropped| {
        taught.named("sample_teaches").and(dropped.not())
    });
    Counted {
        tick,
        hold,
        dropped,
        fresh,
    }
}
