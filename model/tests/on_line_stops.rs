//! An axis that stops within one sample: what the loop's catching up does to the parameters, and that it ends.
//!
//! While the loop catches up by e, the residual holds e²/2, which is no error of the sensor. A period that ends then takes it along.

use std::f64::consts::TAU;

use crate::chip_support::Bench;
use crate::chip_support::bent::{RATE, bent_sensor, noise, parameters, slow};
use crate::chip_support::shipped::variants::{Variant, searches};
use nonius_kept::figure;
use rand::{Rng, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

/// Periods a second before the stop.
const SPEEDS: [f64; 3] = [50.0, 100.0, 250.0];
/// Stops from each of them, for each of the sensor's signs.
const STOPS: u64 = 50;
/// Milliseconds from the stop on in which the loop catches up.
const CATCHES_UP: u32 = 50;
/// What is allowed from then on, in a parameter's noise.
const LIMIT: f64 = 3.0;

/// The furthest a parameter moves within a second of a stop, in its noise; and from when the loop has caught up.
fn stopped(
    settled: &Bench,
    signals: &dyn Fn(f64) -> (f64, f64),
    (from, speed): (f64, f64),
    seed: u64,
) -> [f64; 2] {
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
    let mut settled = before;
    let mut furthest = [0.0f64; 2];
    for k in 0..RATE {
        if k == CATCHES_UP * RATE / 1000 {
            settled = parameters(&bench.chip.state);
        }
        let t = f64::from(k) / f64::from(RATE);
        bench.step(signals(TAU * (turns + amplitude * (TAU * hertz * t).sin())));
        let now = parameters(&bench.chip.state);
        for i in 0..9 {
            let way = |from: &[f64; 9]| (now[i] - from[i]).abs() / noise[i];
            furthest[0] = furthest[0].max(way(&before));
            if k >= CATCHES_UP * RATE / 1000 {
                furthest[1] = furthest[1].max(way(&settled));
            }
        }
    }
    furthest
}

/// The same of stops at any place from one speed, whatever the sensor's signs.
fn from_speed(variant: &Variant, speed: f64) -> [f64; 2] {
    let spec = slow(&variant.spec);
    let each = (0..4u32).into_par_iter().map(|signs| {
        let signals = bent_sensor(&spec, signs);
        let mut bench = Bench::new(&spec, u64::from(signs));
        let mut turns = 0.0;
        while turns < 1000.0 {
            turns += speed / f64::from(RATE);
            bench.step(signals(TAU * turns));
        }
        assert!(bench.chip.state.locked);
        let seeds = (0..STOPS).map(|n| 1000 * u64::from(signs) + n);
        let all = seeds.map(|seed| stopped(&bench, &signals, (turns, speed), seed));
        all.fold([0.0; 2], further)
    });
    each.reduce(|| [0.0; 2], further)
}

fn further(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

/// A stop within a sample moves a parameter by more than its noise, and that is over with the stop: what comes after the loop has caught up,
/// rest or vibration by a tenth of a period at any frequency, moves nothing.
#[test]
fn a_sudden_stop_moves_parameters_once() {
    let mut kept = vec![];
    for variant in searches() {
        let (what, set) = (variant.what.as_str(), variant.spec.calibration.parameters);
        let found = SPEEDS.map(|speed| from_speed(&variant, speed));
        println!("{what}, {set} parameters: {found:.2?} of the noise");
        let [at_once, after] = found.into_iter().fold([0.0; 2], further);
        assert!(after <= LIMIT, "{what}, {set}: {after}");
        if matches!((what, set), ("final form" | "exact", 5) | ("completed", 9)) {
            kept.push(format!("{what} {at_once:.1}, {after:.1}"));
        }
    }
    figure(
        "stopped within a sample from 50, 100 or 250 periods/s, then at rest or vibrating by ±0.05 or ±0.1 periods at 7 to 250 Hz, at any place, bends of 1 and 3 %, five and nine parameters: the furthest a parameter moves within a second, and from 50 ms after the stop on, in its noise",
        &kept.join("; "),
        "model/tests/on_line_stops.rs",
    );
}
