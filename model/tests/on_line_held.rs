//! How long the parameters are held, and what counts as a period of a gear.

use std::f64::consts::TAU;

use crate::chip_support::loss::{PERIOD, sensor_for};
use crate::chip_support::shipped::{
    self,
    variants::{Variant, searches},
};
use crate::chip_support::{Bench, largest, optical};
use nonius_kept::long;
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use rand::{Rng, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

/// `hold_periods` of these designs.
const HOLD: u32 = 40;

/// Steps by whole periods of travel, in each by the signals of its own.
fn travel(
    bench: &mut Bench,
    begin: &mut u32,
    periods: u32,
    signals: impl Fn(u32, f64) -> (f64, f64),
    mut watch: impl FnMut(&Bench),
) {
    for k in *begin..*begin + periods * PERIOD {
        bench.step(signals(k / PERIOD, TAU * f64::from(k) / f64::from(PERIOD)));
        watch(bench);
    }
    *begin += periods * PERIOD;
}

/// A residual that is large for an eighth of every second period of travel holds the parameters for as many such periods as one in
/// each does, not for good. Bends by sums of squares and in batches, which lose lock to so large a residual, find back to it.
#[test]
fn every_second_period_disturbed_counts_as_each() {
    searches().par_iter().for_each(|variant| {
        let Variant { mut spec, what, .. } = variant.clone();
        if spec.calibration.recalls() {
            spec.calibration.hold_periods = Some(HOLD);
        }
        let signals = sensor_for(&spec, 5);
        let held = |periods_before: u32, every: u32| {
            let disturbed = |period: u32, alpha: f64| {
                let (c, s) = signals(alpha);
                let large = period.is_multiple_of(every) && (alpha / TAU).fract() < 0.125;
                if large { (1.35 * c, 1.35 * s) } else { (c, s) }
            };
            let mut bench = Bench::new(&spec, 5);
            let mut at = 0;
            travel(
                &mut bench,
                &mut at,
                periods_before,
                |_, a| signals(a),
                |_| (),
            );
            let (mut before, mut still, mut longest) = (bench.chip.theta(), 0u32, 0u32);
            travel(&mut bench, &mut at, 300, disturbed, |bench| {
                let now = bench.chip.theta();
                still = if now == before { still + 1 } else { 0 };
                longest = longest.max(still);
                before = now;
            });
            longest.div_ceil(PERIOD)
        };
        // From soon after lock, and from where a gear has ended calm.
        for before in [4, 40] {
            let [each, second] = [1, 2].map(|every| held(before, every));
            let what = format!("{what}, {}, after {before}", spec.calibration.parameters);
            println!("{what}: held for {each} and {second} periods");
            assert!(
                each <= HOLD + 1 && second <= 2 * HOLD,
                "{what}: {each}, {second}"
            );
        }
    });
}

/// Without recall parameters are held too, for as long; only where γ never settles none is.
#[test]
fn held_periods_are_refused_only_where_nothing_is_held() {
    let with = |lines: &str| {
        let text = shipped::text("optical");
        let text = text.replace("parameters = 5", &format!("parameters = 5\n{lines}"));
        Design::new(&Spec::from_toml(&text, "d.toml").expect("well formed"))
    };
    for periods in [1, 31, 64, 4096] {
        let design = with(&format!("recall = false\nhold_periods = {periods}"));
        let last = design.expect("held").constants.held_periods_last.value();
        assert_eq!(last, f64::from(periods - 1));
    }
    for recall in ["", "recall = false\n"] {
        let refused = with(&format!("{recall}gamma_last = 5\nhold_periods = 64"));
        let refused = refused.expect_err("never settles");
        assert_eq!(refused.field(), "calibration.hold_periods");
        let message = refused.to_string();
        for words in [
            "leave it out, or gamma_last at least 8",
            "once gamma has settled",
            "no effect",
        ] {
            assert!(message.contains(words), "{message}");
        }
    }
}

/// Where there is only one gear a search that has begun stays so: a signal that is lost takes nothing back, whenever it is lost.
#[test]
fn one_gear_begins_once() {
    let mut spec = optical();
    spec.calibration.gamma_last = Some(spec.calibration.gamma_first);
    spec.calibration.gear_periods = Some(4);
    let signals = sensor_for(&spec, 5);
    let mut running = Bench::new(&spec, 5);
    let mut at = 0;
    travel(&mut running, &mut at, 20, |_, a| signals(a), |_| ());
    for after in 0..9 {
        let mut bench = running.clone();
        travel(
            &mut bench,
            &mut at.clone(),
            after,
            |_, a| signals(a),
            |_| (),
        );
        let before = bench.chip.theta();
        for _ in 0..3000 {
            bench.step((0.0, 0.0));
        }
        assert!(!bench.chip.state.locked);
        assert_eq!(before, bench.chip.theta(), "after {after} periods");
    }
}

/// An axis whose every second period has a jolt that the loop must catch up with learns from the others only, and its gears count no more
/// than those.
#[test]
fn a_period_that_is_dropped_counts_for_no_gear() {
    let spec = optical();
    let signals = sensor_for(&spec, 5);
    let mut bench = Bench::new(&spec, 5);
    let mut at = 0;
    let jolts = |every: u32| {
        let signals = &signals;
        move |period: u32, alpha: f64| {
            let jolt = period.is_multiple_of(every) && (alpha / TAU).fract() < 0.5;
            signals(alpha + if jolt { 0.09 } else { 0.0 })
        }
    };
    let gear = |bench: &Bench| bench.chip.state.gamma_gear.raw(0);
    while gear(&bench) < i64::from(bench.design.spec.calibration.settled_gears()) {
        travel(&mut bench, &mut at, 1, |_, a| signals(a), |_| ());
    }
    let settled = gear(&bench);
    let per_gear = spec.calibration.gear_periods();
    travel(&mut bench, &mut at, 2 * per_gear - 4, jolts(2), |_| ());
    assert_eq!(gear(&bench), settled);
    travel(&mut bench, &mut at, 8, jolts(2), |_| ());
    assert!(gear(&bench) != settled);
}

/// Whatever happens within forty periods of power-up, gains that jump, channels that go, jolts and stops, of any length: all searches
/// along the radius find back. Sums of squares and batches learn what they do not lock to, or another ellipse, on one of two hundred courses, and
/// give it up; on one of 3200 they do not.
#[test]
fn what_happens_early_is_forgotten() {
    let cases = if long() { 400 } else { 12 };
    let squares = |of: &Variant| of.spec.calibration.squares();
    let searches = searches();
    let (along, squares): (Vec<Variant>, Vec<Variant>) =
        searches.into_iter().partition(|of| !squares(of));
    let lost = |searches: &[Variant]| -> Vec<String> {
        let each = searches
            .par_iter()
            .flat_map(|of| (0..cases).into_par_iter().map(move |case| (of, case)));
        each.filter_map(|(of, case)| {
            (!finds_back(of, case)).then(|| {
                format!(
                    "{}, {}, case {case}",
                    of.what, of.spec.calibration.parameters
                )
            })
        })
        .collect()
    };
    let of_squares = lost(&squares);
    println!(
        "{} of {} by sums of squares do not find back: {of_squares:?}",
        of_squares.len(),
        squares.len() as u64 * cases
    );
    assert!(of_squares.len() as u64 <= squares.len() as u64 * cases / 3000);
    assert_eq!(lost(&along), [""; 0]);
}

/// Whether one search is calibrated again, in lock, 400 periods (where it may stray, up to 1600) after forty with whatever can happen.
fn finds_back(variant: &Variant, case: u64) -> bool {
    let mut spec = variant.spec.clone();
    if spec.calibration.recalls() {
        spec.calibration.hold_periods = Some(HOLD);
    }
    let mut random = StdRng::seed_from_u64(case);
    let signals = sensor_for(&spec, random.random_range(0..16));
    let mut bench = Bench::new(&spec, case);
    let first = largest(&bench.miscalibration_at(72, &signals));
    let mut turns = 0.0;
    let mut left = 40.0;
    while left > 0.0 {
        let periods = 0.03 * 100f64.powf(random.random());
        left -= periods;
        let gain: [f64; 2] = std::array::from_fn(|_| match random.random_range(0..6) {
            0 => random.random_range(0.0..1.4),
            1 => 0.0,
            _ => 1.0,
        });
        let jolt = [0.0, 0.1, 0.25][random.random_range(0..3)];
        let speed = [1.0, 1.0, -1.0, 0.0][random.random_range(0..4)] / f64::from(PERIOD);
        for _ in 0..(periods * f64::from(PERIOD)) as u32 {
            turns += speed;
            let (c, s) = signals(TAU * (turns + jolt));
            bench.step((gain[0] * c, gain[1] * s));
        }
    }
    // What strays is given up after some time, and found then.
    let tries = if spec.calibration.may_stray() { 4 } else { 1 };
    for _ in 0..tries {
        for _ in 0..400 * PERIOD {
            turns += 1.0 / f64::from(PERIOD);
            bench.step(signals(TAU * turns));
        }
        let after = largest(&bench.miscalibration_at(72, &signals));
        if bench.chip.state.locked && after < 0.05 * first {
            return true;
        }
    }
    false
}
