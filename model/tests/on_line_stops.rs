//! An axis that stops within one sample: while the loop catches up, nothing it sees is an error of the sensor.

use std::f64::consts::TAU;

use crate::chip_support::Bench;
use crate::chip_support::bent::{RATE, bent_sensor, noise, parameters, slow};
use crate::chip_support::shipped::variants::{Variant, searches};
use nonius_kept::{figure_of_short, long};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

/// Periods a second before the stop, up to the design's top speed.
const SPEEDS: [f64; 5] = [25.0, 50.0, 100.0, 250.0, 500.0];
/// Stops from each of them, for each of the sensor's signs.
fn stops() -> u64 {
    if long() { 200 } else { 10 }
}
/// What is allowed, in a parameter's noise.
const LIMIT: f64 = 3.0;

/// The furthest a parameter moves within a second of a stop, in its noise.
fn stopped(
    settled: &Bench,
    signals: &dyn Fn(f64) -> (f64, f64),
    (from, speed): (f64, f64),
    seed: u64,
) -> f64 {
    let mut random = StdRng::seed_from_u64(seed);
    let (mut bench, mut turns) = (settled.with_noise(seed), from);
    let place = from + random.random_range(1.0..3.0);
    while turns < place {
        turns += speed / f64::from(RATE);
        bench.step(signals(TAU * turns));
    }
    // At rest, or shaken.
    let amplitude = [0.0, 0.05, 0.1][random.random_range(0..3)];
    let hertz = random.random_range(7.0..250.0);
    let noise = noise(&bench.design);
    let before = parameters(&bench.chip.state);
    let mut furthest = 0.0f64;
    for k in 0..RATE {
        let t = f64::from(k) / f64::from(RATE);
        bench.step(signals(TAU * (turns + amplitude * (TAU * hertz * t).sin())));
        let now = parameters(&bench.chip.state);
        for i in 0..9 {
            furthest = furthest.max((now[i] - before[i]).abs() / noise[i]);
        }
    }
    furthest
}

/// The same of every stop, at any place, from one speed, whatever the sensor's signs.
fn from_speed(variant: &Variant, speed: f64) -> Vec<f64> {
    let spec = slow(&variant.spec);
    let each = (0..4u32).into_par_iter().flat_map_iter(|signs| {
        let signals = bent_sensor(&spec, signs);
        let mut bench = Bench::new(&spec, u64::from(signs));
        let mut turns = 0.0;
        while turns < 1000.0 {
            turns += speed / f64::from(RATE);
            bench.step(signals(TAU * turns));
        }
        assert!(bench.chip.state.locked);
        let seeds = (0..stops()).map(|n| 1000 * u64::from(signs) + n);
        let one = |seed| stopped(&bench, &signals, (turns, speed), seed);
        seeds.map(one).collect::<Vec<_>>()
    });
    each.collect()
}

/// A stop within a sample from any speed and at any place, and what comes after it, rest or vibration by a tenth of a period at any
/// frequency, moves no parameter of any search by more than three times its noise.
#[test]
fn a_sudden_stop_moves_no_parameter() {
    let (mut kept, mut others) = (vec![], 0.0f64);
    for variant in searches() {
        let (what, set) = (variant.what.as_str(), variant.spec.calibration.parameters);
        let mut furthest = 0.0f64;
        for speed in SPEEDS {
            let ways = from_speed(&variant, speed);
            let most = ways.iter().copied().fold(0.0, f64::max);
            let said =
                format!("{what}, {set} parameters, from {speed} periods/s: {most:.2} of the noise");
            println!("{said}");
            assert!(most <= LIMIT, "{said}");
            furthest = furthest.max(most);
        }
        if matches!((what, set), ("final form" | "exact", 5) | ("completed", 9)) {
            kept.push(format!("{what} {furthest:.1}"));
        } else {
            others = others.max(furthest);
        }
    }
    figure_of_short(
        "stopped within a sample from 25 to 500 periods/s, then at rest or vibrating by ±0.05 or ±0.1 periods at 7 to 250 Hz, at any place, bends of 1 and 3 %, five and nine parameters: the furthest a parameter moves within a second, in its noise; of any other search",
        &format!("{}; {others:.1}", kept.join(", ")),
        "model/tests/on_line_stops.rs",
    );
}
