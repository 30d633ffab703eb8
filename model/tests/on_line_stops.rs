//! An axis that stops within one sample: while the loop catches up, nothing it sees is an error of the sensor.

use std::f64::consts::TAU;

use crate::chip_support::Bench;
use crate::chip_support::bent::{RATE, bent_sensor, noise_in, parameters, slow};
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
/// Periods after which all searches have settled; and after lock, in which γ has not.
const SETTLED: f64 = 1000.0;
const ON_THE_WAY: [f64; 4] = [3.0, 5.0, 8.0, 12.0];
/// How far the axis went before.
#[derive(Clone, Copy)]
enum Moved {
    Settled,
    /// So many periods after lock.
    OnTheWay(f64),
}

/// What is allowed, in a parameter's noise.
const LIMIT: f64 = 3.0;

/// The furthest a parameter moves within a second of a stop, in its noise with the γ of then.
fn stopped(
    moving: &Bench,
    signals: &dyn Fn(f64) -> (f64, f64),
    (from, speed): (f64, f64),
    seed: u64,
) -> f64 {
    let mut random = StdRng::seed_from_u64(seed);
    let (mut bench, mut turns) = (moving.with_noise(seed), from);
    let place = from + random.random_range(1.0..3.0);
    while turns < place {
        turns += speed / f64::from(RATE);
        bench.step(signals(TAU * turns));
    }
    // At rest, or shaken.
    let amplitude = [0.0, 0.05, 0.1][random.random_range(0..3)];
    let hertz = random.random_range(7.0..250.0);
    let noise = noise_in(&bench.design, bench.chip.state.gamma_gear.raw(0) as u32);
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

/// The same of every stop, at any place, from one speed, after so much travel, whatever the sensor's signs.
fn from_speed(variant: &Variant, speed: f64, moved: Moved) -> Vec<f64> {
    let spec = slow(&variant.spec);
    let each = (0..4u32).into_par_iter().flat_map_iter(|signs| {
        let signals = bent_sensor(&spec, signs);
        let mut bench = Bench::new(&spec, u64::from(signs));
        let (mut turns, mut locked) = (0.0, None);
        let goes_on = |turns: f64, locked: Option<f64>| match moved {
            Moved::Settled => turns < SETTLED,
            Moved::OnTheWay(periods) => locked.is_none_or(|from| turns < from + periods),
        };
        while goes_on(turns, locked) {
            turns += speed / f64::from(RATE);
            bench.step(signals(TAU * turns));
            if bench.chip.state.locked && locked.is_none() {
                locked = Some(turns);
            }
            assert!(locked.is_some() || turns < 100.0, "no lock");
        }
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
            let ways = from_speed(&variant, speed, Moved::Settled);
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

/// Before γ has settled parameters move with every sector, and what bends show within the arc that follows a stop pulls at them: the less,
/// the smaller γ is by then. How far is measured, for it is more than three times their noise.
#[test]
fn a_stop_before_gamma_has_settled_pulls() {
    let kept = |v: &Variant| {
        let (what, set) = (v.what.as_str(), v.spec.calibration.parameters);
        matches!((what, set), ("final form" | "exact", 5) | ("completed", 9))
    };
    let of = |variant: Variant| {
        let most = ON_THE_WAY.map(|periods| {
            let ways = SPEEDS.map(|speed| from_speed(&variant, speed, Moved::OnTheWay(periods)));
            ways.concat().into_iter().fold(0.0, f64::max)
        });
        println!("{}: {most:.1?}", variant.what);
        // Once γ has hardly been halved it may be large; on the way it falls.
        assert!(most[0] < 200.0 && most[3] < 0.5 * most[0], "{most:?}");
        format!(
            "{} {}",
            variant.what,
            most.map(|m| format!("{m:.0}")).join(", ")
        )
    };
    let all: Vec<String> = searches().into_iter().filter(kept).map(of).collect();
    figure_of_short(
        "stopped within a sample 4 to 6, 6 to 8, 9 to 11 and 13 to 15 periods after lock, where γ has not settled, and otherwise as from 25 to 500 periods/s: the furthest a parameter moves, in its noise with the γ of then",
        &all.join("; "),
        "model/tests/on_line_stops.rs",
    );
}
