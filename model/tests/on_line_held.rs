//! How long the parameters are held, and what counts as a period of a gear.

use std::f64::consts::TAU;

use crate::chip_support::loss::{PERIOD, sensor_for};
use crate::chip_support::shipped::variants::{Variant, searches};
use crate::chip_support::{Bench, optical};
use nonius_model::spec::Calibration;
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
/// each does, not for good. (Without lock nothing is held: bends by sums of squares and in batches lose it to so large a residual.)
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
                let same = bench.chip.state.locked && now == before;
                still = if same { still + 1 } else { 0 };
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

/// Where there is only one gear a search that has begun stays so: a signal that is lost takes nothing back, whenever it is lost.
#[test]
fn one_gear_begins_once() {
    let mut spec = optical();
    spec.calibration.gamma_last = spec.calibration.gamma_first;
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
    while gear(&bench) < i64::from(Calibration::SETTLED) {
        travel(&mut bench, &mut at, 1, |_, a| signals(a), |_| ());
    }
    let settled = gear(&bench);
    let per_gear = spec.calibration.gear_periods();
    travel(&mut bench, &mut at, 2 * per_gear - 4, jolts(2), |_| ());
    assert_eq!(gear(&bench), settled);
    travel(&mut bench, &mut at, 8, jolts(2), |_| ());
    assert!(gear(&bench) != settled);
}
