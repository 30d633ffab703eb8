//! Standstill and vibration: without net travel the parameters stay where they are.
//!
//! Once γ has settled the parameters move where a period of travel ends: what stays within a period moves nothing, however long it
//! lasts. The sum of squares moves them with every sector, each once between two clearings of the map, which is cleared where the
//! position is a whole period from where it was last: there it takes no more than what is left of one map.

use std::f64::consts::TAU;

use crate::chip_support::bent::{RATE, bent_sensor, noise, noise_in, parameters, slow};
use crate::chip_support::shipped::variants::{Variant, searches};
use crate::chip_support::{Bench, larger};
use nonius_kept::{figure, figure_of_short, long};
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
    let rest = |way: &Vibration| {
        let each = shaken(&running, &signals, turns, *way, seconds, &noise);
        each.into_iter().fold(0.0, f64::max)
    };
    ways.iter().map(rest).collect()
}

/// How far each parameter goes from where it is, in units of this noise, while the scale vibrates about `turns`.
fn shaken(
    running: &Bench,
    signals: &impl Fn(f64) -> (f64, f64),
    turns: f64,
    (amplitude, hertz): Vibration,
    seconds: u32,
    noise: &[f64; 9],
) -> [f64; 9] {
    let mut bench = running.clone();
    let before = parameters(&bench.chip.state);
    let mut furthest = [0.0f64; 9];
    for k in 0..seconds * RATE {
        let t = f64::from(k) / f64::from(RATE);
        let place = turns + amplitude * (TAU * hertz * t).sin();
        bench.step(signals(TAU * place));
        if k % 100 == 0 {
            let now = parameters(&bench.chip.state);
            for (i, now) in now.into_iter().enumerate() {
                furthest[i] = furthest[i].max((now - before[i]).abs() / noise[i]);
            }
        }
    }
    assert!(bench.chip.state.locked);
    furthest
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

/// The furthest of each motion at 24 places of the period; in the short form at eight of them, where the searches whose figures are kept move
/// furthest, and of other searches at two.
fn anywhere(variant: &Variant) -> [f64; 3] {
    let ways: Vec<Vibration> = MOTIONS
        .iter()
        .flat_map(|(_, amplitude)| HERTZ.map(|hertz| (*amplitude, hertz)))
        .collect();
    let mut furthest = [0.0f64; 3];
    let (first, step) = match (long(), is_kept(variant)) {
        (true, _) => (0, 1),
        (false, true) => (1, 3),
        (false, false) => (0, 12),
    };
    for n in (first..24).step_by(step) {
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

/// Ten minutes at rest, and a tenth of a period to either side, at one of four places each; every search in the long form, at all.
#[test]
fn ten_minutes_of_rest_and_of_vibration_move_no_parameter() {
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
        let each = all.iter().map(|&(place, hertz, seed)| {
            let there = moved(variant, place, &[(0.0, hertz), (0.1, hertz)], 600, seed);
            [there[0], there[1]]
        });
        (variant, each.fold([0.0; 2], larger))
    });
    let measured: Vec<(&Variant, [f64; 2])> = measured.collect();
    let (mut kept, mut others) = (vec![], [0.0f64; 2]);
    for (variant, furthest) in measured {
        let (what, set) = (&variant.what, variant.spec.calibration.parameters);
        println!("{what}, {set} parameters: {furthest:.2?} of the noise");
        let [rest, vibration] = furthest;
        assert!(rest.max(vibration) <= LIMIT, "{what}, {set}: {furthest:?}");
        if is_kept(variant) {
            kept.push(format!("{set} parameters {rest:.1}, {vibration:.1}"));
        } else {
            others = larger(others, furthest);
        }
    }
    let [rest, vibration] = others;
    figure_of_short(
        "the same for ten minutes of standstill, and of ±0.1 periods, each search at one of four places; the furthest of six other searches",
        &format!("{}; {rest:.1}, {vibration:.1}", kept.join("; ")),
        "model/tests/on_line_rest.rs",
    );
}

/// Periods of travel from lock on: five parameters are found by then.
const FOUND: f64 = 6.0;

/// Before γ has settled, sixteen periods from lock on, the parameters move with every sector, so a vibration pulls at them by what it shows of a
/// sensor with bends: by more than the noise of that γ, and the most where γ is largest. At each tenth of the first two periods after five
/// parameters are found; in the long form of all until γ has settled.
#[test]
fn a_vibration_before_gamma_has_settled_pulls() {
    // How far the parameters go: θ1 … θ4, and θ5, in the noise of the γ of then; any, in thousandths.
    let pulled = |variant: &Variant| {
        let spec = slow(&variant.spec);
        let tenths = if long() { 99 } else { 20 };
        let cases: Vec<(u32, u32)> = (0..tenths)
            .flat_map(|n| (0..4).map(move |signs| (n, signs)))
            .collect();
        let each = cases.into_par_iter().map(|(n, signs)| {
            let signals = bent_sensor(&spec, signs);
            let mut running = Bench::new(&spec, u64::from(7 * n + signs));
            let (mut turns, mut locked) = (0.0, None);
            while turns < locked.unwrap_or(2.0) + FOUND + 0.1 * f64::from(n) {
                turns += 0.01;
                running.step(signals(TAU * turns));
                if running.chip.state.locked && locked.is_none() {
                    locked = Some(turns);
                }
            }
            let gear = running.chip.state.gamma_gear.raw(0) as u32;
            assert!(
                locked.is_some() && gear < running.design.spec.calibration.settled_gears(),
                "{gear}"
            );
            let noise = noise_in(&running.design, gear);
            let of = |hertz: f64| {
                let far = shaken(&running, &signals, turns, (0.1, hertz), 10, &noise);
                let most = |all: &[f64]| all.iter().copied().fold(0.0, f64::max);
                let absolute: Vec<f64> = far.iter().zip(noise).map(|(f, n)| 1e3 * f * n).collect();
                [most(&far[..4]), far[4], most(&absolute)]
            };
            HERTZ.map(of).into_iter().fold([0.0; 3], larger)
        });
        each.reduce(|| [0.0; 3], larger)
    };
    let mut kept = vec![];
    let searches = searches().into_iter();
    for variant in searches.filter(|v| v.what == "final form") {
        let ([ellipse, phase, most], set) = (pulled(&variant), variant.spec.calibration.parameters);
        println!(
            "{set} parameters: {ellipse:.1}, θ5 {phase:.1} of the noise of that γ; {most:.1} thousandths"
        );
        assert!(ellipse < 40.0 && phase < 40.0, "{ellipse} {phase}");
        kept.push(match set {
            4 => format!("{ellipse:.1}, {most:.1}"),
            _ => format!("{ellipse:.1}, {phase:.1}, {most:.1}"),
        });
    }
    figure(
        "vibrating by ±0.1 periods at 7.3, 45 and 80 Hz from 6 to 8 periods after lock on, where γ has not settled, bends of 1 and 3 %: the furthest a parameter moves in ten seconds, in its noise with the γ of then, and any in thousandths of the amplitude, final form of four parameters; of five, θ1 … θ4 and θ5",
        &kept.join("; "),
        "model/tests/on_line_rest.rs",
    );
}
