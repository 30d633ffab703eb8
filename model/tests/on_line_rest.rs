//! Standstill and vibration: without net travel the parameters stay where they are.
//!
//! Once γ has settled the parameters move where a period of travel ends: what stays within a period moves nothing, however long it
//! lasts. The sum of squares moves them with every sector, each once between two clearings of the map, which is cleared where the
//! position is a whole period from where it was last: there it takes no more than what is left of one map.

use std::f64::consts::TAU;

use crate::chip_support::Bench;
use crate::chip_support::bent::{RATE, bent_sensor, noise, parameters, slow};
use crate::chip_support::shipped::variants::{Variant, searches};
use nonius_kept::{every, figure, figure_of_short, long};
use rayon::prelude::*;

/// A vibration: amplitude in periods, frequency in hertz.
type Vibration = (f64, f64);

/// How far the furthest parameter goes, in units of its noise, while the scale rests, or vibrates about `place` in each of these
/// ways.
fn moved(variant: &Variant, place: f64, ways: &[Vibration], seconds: u32, seed: u32) -> Vec<f64> {
    let spec = slow(&variant.spec);
    // Every sign at every place, whatever the noise.
    let signals = bent_sensor(&spec, seed / 5);
    let mut running = Bench::new(&spec, u64::from(seed));
    // 50 periods a second for twenty seconds, then it stops there.
    let mut turns = 0.0;
    while turns < 1000.0 + place {
        turns += 0.01;
        running.step(signals(TAU * turns));
    }
    assert!(running.chip.state.locked);
    let before = parameters(&running.chip.state);
    let awake = running.design.structure.calibration.completed().is_none() || before[8] != 0.0;
    assert!(awake, "the completion sleeps");
    let noise = noise(&running.design);
    let rest = |(amplitude, hertz): &Vibration| {
        let mut bench = running.clone();
        let mut furthest = 0.0f64;
        for k in 0..seconds * RATE {
            let t = f64::from(k) / f64::from(RATE);
            let place = turns + amplitude * (TAU * hertz * t).sin();
            bench.step(signals(TAU * place));
            if k % 100 == 0 {
                let now = parameters(&bench.chip.state);
                for (i, now) in now.into_iter().enumerate() {
                    furthest = furthest.max((now - before[i]).abs() / noise[i]);
                }
            }
        }
        assert!(bench.chip.state.locked);
        furthest
    };
    ways.iter().map(rest).collect()
}

/// At rest, a tenth of a period from end to end, and twice that: amplitudes in periods.
const MOTIONS: [(&str, f64); 3] = [("standstill", 0.0), ("±0.05", 0.05), ("±0.1", 0.1)];
/// What is allowed, in a parameter's noise.
const LIMIT: f64 = 3.0;

/// What an axis shakes with, hertz: slowly, near the loop's bandwidth where that is narrow, and between.
const HERTZ: [f64; 3] = [7.3, 45.0, 80.0];

/// The searches whose figures are kept.
fn is_kept(variant: &Variant) -> bool {
    variant.what == "final form" || variant.what == "completed"
}

/// The furthest of each motion at 24 places of the period; of the searches whose figures are not kept, at each sixth of them, and in
/// the long form at all.
fn anywhere(variant: &Variant) -> [f64; 3] {
    let ways: Vec<Vibration> = MOTIONS
        .iter()
        .flat_map(|(_, amplitude)| HERTZ.map(|hertz| (*amplitude, hertz)))
        .collect();
    let mut furthest = [0.0f64; 3];
    for n in every(if is_kept(variant) { 1 } else { 6 }, 0..24) {
        let there = moved(variant, f64::from(n) / 24.0 + 0.01, &ways, 2, n);
        for (all, there) in furthest.iter_mut().zip(there.chunks(HERTZ.len())) {
            *all = there.iter().copied().fold(*all, f64::max);
        }
    }
    furthest
}

/// Two seconds at 24 places of the period, sensors with all signs of offsets, 5° of phase where it is calibrated, 1 % of even and 3 %
/// of cubic distortion, an axis that comes at 50 periods a second and stops within a sample: no parameter of any search moves by
/// more than three times its noise, at rest or vibrating by a tenth of a period to either side, slowly or fast.
#[test]
fn neither_standstill_nor_vibration_moves_a_parameter() {
    let searches = searches();
    let measured: Vec<(&Variant, [f64; 3])> =
        searches.par_iter().map(|v| (v, anywhere(v))).collect();
    let mut kept = vec![];
    for (variant, furthest) in measured {
        let (what, set) = (&variant.what, variant.spec.calibration.parameters);
        println!("{what}, {set} parameters: {furthest:.2?} of the noise");
        if is_kept(variant) {
            let [rest, tenth, fifth] = furthest;
            kept.push(format!(
                "{set} parameters {rest:.1}, {tenth:.1}, {fifth:.1}"
            ));
        }
        for ((when, _), furthest) in MOTIONS.into_iter().zip(furthest) {
            assert!(furthest <= LIMIT, "{what}, {set}, {when}: {furthest}");
        }
    }
    figure(
        "stopped from 50 periods/s, then at rest, vibrating by ±0.05 and by ±0.1 periods at 7.3, 45 and 80 Hz, at 24 places, bends of 1 and 3 %: the furthest a parameter moves, in its noise",
        &kept.join("; "),
        "model/tests/on_line_rest.rs",
    );
}

/// Place of the period, hertz and seed of ten minutes.
const PLACES: [(f64, f64, u32); 4] = [
    (0.3, 45.0, 10),
    (0.05, 7.3, 5),
    (0.62, 80.0, 15),
    (0.8, 23.0, 0),
];

/// Ten minutes, a tenth of a period to either side, at one of four places each; every search in the long form, at all.
#[test]
fn ten_minutes_of_vibration_move_no_parameter() {
    let searches = searches().into_iter().enumerate();
    let searches: Vec<(usize, Variant)> = searches
        .filter(|(i, v)| long() || is_kept(v) || i % 3 == 0)
        .collect();
    let measured = searches.par_iter().map(|(i, variant)| {
        let all = if long() {
            &PLACES[..]
        } else {
            &PLACES[i % PLACES.len()..][..1]
        };
        let each = all
            .iter()
            .flat_map(|&(place, hertz, seed)| moved(variant, place, &[(0.1, hertz)], 600, seed));
        (variant, each.fold(0.0, f64::max))
    });
    let measured: Vec<(&Variant, f64)> = measured.collect();
    let (mut kept, mut others) = (vec![], 0.0f64);
    for (variant, furthest) in measured {
        let (what, set) = (&variant.what, variant.spec.calibration.parameters);
        println!("{what}, {set} parameters: {furthest:.2} of the noise");
        assert!(furthest <= LIMIT, "{what}, {set}: {furthest}");
        if is_kept(variant) {
            kept.push(format!("{set} parameters {furthest:.1}"));
        } else {
            others = others.max(furthest);
        }
    }
    figure_of_short(
        "the same for ten minutes of ±0.1 periods, each search at one of four places; the furthest of six other searches",
        &format!("{}; {others:.1}", kept.join("; ")),
        "model/tests/on_line_rest.rs",
    );
}
