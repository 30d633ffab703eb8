//! Recall: what the parameters were before the signal began to fade.
//!
//! A fade over some periods is a small change of the amplitude before it is a large one, and the parameters follow it until
//! they are held. So the chip remembers them as they were at the last two ends of twice `gear_periods` quiet periods of travel, and where
//! they begin to be held (but for a loop that is astray while the signal is there) it goes back to the older of the two. Only in the last
//! gear: before it they still improve. A signal that comes back slowly is nearly whole before it is whole: they stay held until a part of `hold_periods` has passed quietly.
//!
//! A slower fade outlasts the hold, and the search begins again and follows it; one slower still is followed without. So nothing is
//! proven while a gain moves: what is stays as it was until the search has come to its last gear again and the gains rest. A sensor whose
//! gains move on is not what it was, either: then only a radius that is too large, as where a fade is over, or a loss of lock after four
//! periods and more with one that is too small, as where it ends, brings back what is proven, and what falls out for some samples does
//! not. Where the radius is far too large before that, the signal is back: what is proven comes back, with the last gear. So it does
//! where the signal is lost in the first gear: it may have followed the fade. Before anything is proven, and before the search has begun
//! again, that is what the last gear ended with, in the first one the last quiet period, and the search goes on from there.

use super::calibration::Update;
use super::detector::within;
use super::gears::{Gears, last_gear, nominal};
use super::strays::strays;
use super::{Coefficients, State, Structure};
use crate::signal::{Formula, Logic, Signal};
use crate::spec::CalibrationMethod;

static RECALL: Formula = Formula {
    title: "Recall",
    equation: "held where it is known, or back: theta = proven; after twice gear_periods quiet periods in the last gear: recent' = theta, proven' = recent if no gain moves",
    source: "",
};

/// What is remembered of θ1 … θ9.
pub struct Memory<S: Signal> {
    /// As at the last end of so many quiet periods; `None`: as before.
    pub recent: Option<[S; 9]>,
    /// As at the end before it; `None`: as before.
    pub proven: Option<[S; 9]>,
    /// Parameters were recalled, and the periods of a gear have not passed quietly since.
    pub returning: S::Bool,
    /// The search began again where the residual had stayed.
    pub fading: S::Bool,
    /// There are proven ones.
    pub known: S::Bool,
    /// A gain has moved away from what is proven.
    pub apart: S::Bool,
    /// Something was recalled with this sample.
    pub recalled: S::Bool,
    /// The last gear has passed once since it was remembered what they are.
    pub halfway: S::Bool,
}

/// Puts proven parameters in the place of the others where `recall` says so.
pub fn recall<S: Signal>(
    updated: &mut Update<S>,
    recall: S::Bool,
    gears: &mut Gears<S>,
    state: &State<S>,
    k: &Coefficients<S>,
    structure: &Structure,
) -> Memory<S> {
    state.gamma_gear.begin(&RECALL);
    let passed = gears.passed;
    let last = last_gear(state, k);
    // The signal is back that the search had followed down, or it is lost before the search knew it again.
    let risen = gears.restart.and(state.risen).named("restart_risen");
    let back = risen.and(state.fading);
    let lost = nominal(state, k, structure);
    let again = back.or(lost).and(state.known).named("recall_again");
    let all = recall.or(again).or(lost).named("recall_any");
    if !all.is_known_false() {
        let mut proven = proven(state);
        if let Some(strays) = strays(state, k, structure) {
            // The best of a search that has strayed is of where it strayed to.
            proven = proven.map(|theta| S::select(strays, k.zero, theta));
        }
        updated.theta = std::array::from_fn(|i| S::select(all, proven[i], updated.theta[i]));
    }
    if structure.calibration.method == CalibrationMethod::SumOfSquares {
        // A mean gradient of the way down would be the first to act on what was recalled.
        updated.gathered = updated.gathered.map(|sum| S::select(all, k.zero, sum));
    }
    if structure.calibration.starts() {
        // What is proven need not be solved.
        updated.start_periods = S::select(again, k.start_periods_last, updated.start_periods)
            .quantise(&structure.formats.start_periods);
    }
    // And what is larger than small is no error of theirs.
    gears.calm = gears.calm.or(again).named("known_to_be_calm");
    let searched = gears.gear.named("gamma_gear_searched");
    gears.gear =
        S::select(again, k.gamma_gear_last, searched).quantise(&structure.formats.gamma_gear);
    let quiet = passed.and(last).named("last_gear_passed");
    // What has just been recalled says nothing new.
    let quiet = quiet.and(state.returning.not()).named("quiet_periods_pass");
    let ends = quiet.and(state.halfway).named("quiet_periods_end");
    // The first time something is better than nothing.
    let steady = steady(state, k, structure);
    let better = steady.or(state.known.not()).named("proves");
    let proved = ends.and(better).named("proved");
    let moves = ends.and(steady.not()).named("gain_moved");
    // Until something is proven, the end of the last gear is the best that is known.
    let yet = state.known.or(last).not().named("nothing_proven_yet");
    let older = proved.or(yet).named("remember");
    // What was recent where something is recalled is of the way down.
    let newer = passed
        .or(gears.first)
        .and(last.not())
        .named("search_improves")
        .or(ends)
        .named("remember_better")
        .or(all)
        .named("remember_recent");
    let recent = || {
        let before = self::recent(state);
        std::array::from_fn(|i| {
            let theta = updated.theta[i].quantise(&structure.formats.remembered[i]);
            S::select(newer, theta, before[i])
        })
    };
    let proven = || {
        let (recent, before) = (self::recent(state), self::proven(state));
        std::array::from_fn(|i| S::select(older, recent[i], before[i]))
    };
    // What comes back over some periods is small again before it is whole.
    let returns = passed.or(gears.restart).not();
    let returning = recall.and(returns).named("return_goes_on");
    // A radius that stays too large is another signal's.
    let another = risen.and(state.fading.not()).named("signal_changed");
    let known = state.known.and(another.not()).named("still_known");
    let fades = gears.stayed.or(state.fading).named("fades");
    let ends = again.or(proved).or(another).named("fade_ends");
    let together = proved.or(all).named("together_again");
    Memory {
        recent: (!newer.is_known_false()).then(recent),
        proven: (!older.is_known_false()).then(proven),
        returning: returning.or(again),
        fading: fades.and(ends.not()),
        halfway: state.halfway.xor(quiet).and(all.not()),
        known: known.or(proved),
        apart: moves.or(state.apart).and(together.not()),
        recalled: all,
    }
}

/// No gain has moved much since it was last remembered, nor is one near its bound: a signal that fades slowly takes them along, up to
/// there.
fn steady<S: Signal>(state: &State<S>, k: &Coefficients<S>, structure: &Structure) -> S::Bool {
    let gain = &structure.formats.gain_watched;
    let of = |now: S, before: S, name: [&'static str; 2]| {
        let [now, before] = [now, before].map(|theta| theta.quantise(gain));
        let inside = now.less_than(k.gain_near_bound).named(name[0]);
        within(now - before, k.steady_gain)
            .named(name[1])
            .and(inside)
    };
    let (c, s) = (state.theta_1_deviation, state.theta_3_deviation);
    let c = of(c, state.recent_1, ["gain_c_inside", "gain_c_rests"]);
    let s = of(s, state.recent_3, ["gain_s_inside", "gain_s_rests"]);
    c.and(s).named("gains_steady")
}

fn recent<S: Signal>(state: &State<S>) -> [S; 9] {
    [
        state.recent_1,
        state.recent_2,
        state.recent_3,
        state.recent_4,
        state.recent_5,
        state.recent_6,
        state.recent_7,
        state.recent_8,
        state.recent_9,
    ]
}

fn proven<S: Signal>(state: &State<S>) -> [S; 9] {
    [
        state.proven_1,
        state.proven_2,
        state.proven_3,
        state.proven_4,
        state.proven_5,
        state.proven_6,
        state.proven_7,
        state.proven_8,
        state.proven_9,
    ]
}

impl<S: Signal> Memory<S> {
    /// Into the registers.
    pub fn keep(self, next: &mut State<S>) {
        if let Some(recent) = self.recent {
            [
                next.recent_1,
                next.recent_2,
                next.recent_3,
                next.recent_4,
                next.recent_5,
                next.recent_6,
                next.recent_7,
                next.recent_8,
                next.recent_9,
            ] = recent;
        }
        if let Some(proven) = self.proven {
            [
                next.proven_1,
                next.proven_2,
                next.proven_3,
                next.proven_4,
                next.proven_5,
                next.proven_6,
                next.proven_7,
                next.proven_8,
                next.proven_9,
            ] = proven;
        }
        next.returning = self.returning;
        next.fading = self.fading;
        next.known = self.known;
        next.halfway = self.halfway;
        next.apart = self.apart;
    }
}
