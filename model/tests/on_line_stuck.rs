//! A channel that is stuck at any level for any time leaves nothing in the parameters; a sensor that has
//! changed for good is learned again.

use std::f64::consts::TAU;

use crate::chip_support::loss::{Loss, PERIOD, each_settled, sensor_for, watch};
use crate::chip_support::shipped::variants::{Variant, searches};
use crate::chip_support::{Bench, largest, optical};
use nonius_kept::{figure, long};
use nonius_model::spec::{CalibrationMethod, Spec};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

/// Levels and times of each search.
fn cases() -> usize {
    if long() { 600 } else { 24 }
}
/// What stays below `hold_residual`, for some samples, may move them by so much, radians.
const SMALL: f64 = 1e-3;

/// Periods of travel that a fade takes, the channels, and the periods before.
const EARLY_FADES: [(u32, [f64; 2], u32); 8] = [
    (3, [1.0, 0.0], 10),
    (10, [1.0, 1.0], 10),
    (10, [0.0, 1.0], 8),
    (30, [1.0, 0.0], 8),
    (100, [1.0, 0.0], 8),
    (100, [0.0, 1.0], 12),
    (300, [0.0, 1.0], 8),
    (300, [1.0, 1.0], 8),
];

#[test]
fn a_stuck_channel_leaves_nothing() {
    searches().par_iter().for_each(|variant| {
        let Variant { spec, what, .. } = variant;
        let each = each_settled(spec);
        let mut random = StdRng::seed_from_u64(11);
        for case in 0..cases() {
            let from = &each[case % each.len()];
            let least = 5.0f64;
            let share = random.random_range(0.0..1.0);
            let away = least * (100.0 * f64::from(PERIOD) / least).powf(share);
            let stuck = Loss {
                lost: from.lost,
                level: random.random_range(-1.4..1.4),
                fade: [0; 2],
                away: away as u32,
                moves: true,
            };
            let from = from.moved(random.random_range(0..PERIOD));
            let seen = watch(&from, stuck);
            assert!(
                seen.after < 2.0 * seen.before + SMALL,
                "{what}, {}: {stuck:?}, {seen:?}",
                spec.calibration.parameters
            );
        }
    });
}

/// A third larger, or a quarter smaller: held for `hold_periods`, with recall and without, then searched for anew.
#[test]
fn another_amplitude_is_learned() {
    let times = [
        (true, None),
        (true, Some(32)),
        (false, None),
        (false, Some(8)),
        (false, Some(100)),
    ];
    let cases = times
        .into_iter()
        .flat_map(|hold| [(0.85, 1.15, hold), (1.15, 0.85, hold)]);
    for (before, after, (recall, hold)) in cases {
        let mut spec = optical();
        spec.calibration.recall = Some(recall);
        spec.calibration.hold_periods = hold;
        let mut bench = Bench::new(&spec, 3);
        let signals = |scale: f64| {
            move |alpha: f64| {
                (
                    scale * (alpha.cos() + 0.05),
                    scale * ((alpha - 0.05).sin() - 0.05),
                )
            }
        };
        let mut turns = 0.0;
        let mut run = |bench: &mut Bench, scale: f64, periods: u32| {
            for _ in 0..periods * PERIOD {
                bench.step(signals(scale)(TAU * turns));
                turns += 1.0 / f64::from(PERIOD);
            }
            assert!(bench.chip.state.locked);
            let radius = |theta: [f64; 9]| theta[0] * scale;
            (
                largest(&bench.miscalibration_at(72, &signals(scale))),
                radius(bench.chip.theta()),
            )
        };
        let (settled, radius) = run(&mut bench, before, 300);
        let hold = hold.unwrap_or(if recall { 256 } else { 32 });
        let (_, held) = run(&mut bench, after, hold - 7);
        let (learned, again) = run(&mut bench, after, 175);
        println!(
            "{before} -> {after}: {settled:.1e} rad, radius {radius:.3}, {held:.3}; {learned:.1e} rad, {again:.3}"
        );
        let ratio = held / radius / (after / before);
        assert!((ratio - 1.0).abs() < 0.01, "held: {ratio}");
        assert!(learned < 2.0 * settled && (again / radius - 1.0).abs() < 0.01);
    }
}

/// Samples without one channel, or both.
const GAPS: [u32; 3] = [1, 20, 3000];

/// Periods of travel after a loss in which the parameters are no worse than they are at their worst within as many without it: on
/// their way they swing, those of bends and of sums of squares widely.
const WATCHED: u32 = 4;

/// How much worse than that, of the first miscalibration.
fn worse_by(spec: &Spec) -> f64 {
    let calibration = &spec.calibration;
    match calibration.method {
        // Bends by sums of squares are not guarded: what they learn on their way cannot be told from a loss.
        // Without one they are there within so few periods that this is the loss alone.
        _ if calibration.swings() => 0.32,
        // A part of a period says little of bends, and what is remembered goes on acting.
        _ if calibration.has_bend() && !calibration.starts() => 0.1,
        CalibrationMethod::SumOfSquares | CalibrationMethod::Exact => 0.07,
        _ => 0.012,
    }
}

/// Once a period of travel has passed in which no residual was large, a loss leaves what was known: the parameters are hardly worse
/// than they would be at their worst in the four periods after it without it. Once a gear has ended calm, a loss of any length moves next
/// to nothing.
#[test]
fn a_loss_soon_after_lock() {
    const PLACES: u32 = 8;
    let searches = searches();
    let rows: Vec<(&Spec, [f64; 3])> = searches
        .par_iter()
        .map(|variant| {
            let Variant { spec, what, .. } = variant;
            let signals = sensor_for(spec, 5);
            let mut settling = Bench::new(spec, 5);
            let wrong = |bench: &Bench| largest(&bench.miscalibration_at(72, &signals));
            let first = wrong(&settling);
            let mut turns = 0.0;
            let mut go = |bench: &mut Bench| {
                let begun = turns;
                for _ in 0..PERIOD / PLACES {
                    bench.step(signals(TAU * turns));
                    turns += 1.0 / f64::from(PERIOD);
                }
                begun
            };
            let course: Vec<(Bench, f64)> = (0..PLACES * (16 + WATCHED))
                .map(|_| {
                    go(&mut settling);
                    (settling.clone(), wrong(&settling))
                })
                .collect();
            let (mut worst, mut looked, mut beyond) = ([0.0f64; 2], [0; 2], 0.0f64);
            for place in 0..PLACES * 16 {
                let at = place as usize;
                let (settling, before) = &course[at];
                let state = &settling.chip.state;
                let begun = state.gamma_gear.raw(0) > 0 || state.gear_periods.raw(0) > 0;
                if !(begun && state.locked) {
                    continue;
                }
                let calm = usize::from(state.calm);
                looked[calm] += 1;
                let ahead = &course[at..=at + (PLACES * WATCHED) as usize];
                let without = ahead.iter().map(|(_, wrong)| *wrong).fold(0.0, f64::max);
                let gap = GAPS[at % GAPS.len()];
                let from = (place + 1) * (PERIOD / PLACES);
                for left in [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]] {
                    let mut bench = settling.clone();
                    for k in 0..gap + WATCHED * PERIOD {
                        let [left_c, left_s] = if k < gap { left } else { [1.0; 2] };
                        let (c, s) = signals(TAU * f64::from(from + k) / f64::from(PERIOD));
                        bench.step((left_c * c, left_s * s));
                        if k >= gap && (k - gap).is_multiple_of(30) {
                            let after = wrong(&bench);
                            worst[calm] = worst[calm].max((after - before) / first);
                            beyond = beyond.max((after - without) / first);
                        }
                    }
                }
            }
            let set = spec.calibration.parameters;
            println!("{what}, {set}: {worst:.3?}, {beyond:.3} beyond what it is without");
            assert!(beyond < worse_by(spec), "{what}, {set}: {beyond} beyond");
            assert!(worst[0] < 0.5, "{what}, {set}: {worst:?}");
            // Sums of squares are calm from the first gear on in which bends are searched.
            let calm = if spec.calibration.swings() { 5 } else { 8 };
            assert!(
                looked[0] >= 8 && looked[1] >= 8 * calm,
                "{what}: {looked:?}"
            );
            assert!(
                worst[1] < 0.015,
                "{what}: {worst:?} of the first miscalibration"
            );
            (spec, [worst[0], worst[1], beyond])
        })
        .collect();
    let worst = |i: usize, of: &dyn Fn(&Spec) -> bool| {
        let rows = rows.iter().filter(|(spec, _)| of(spec));
        100.0 * rows.map(|(_, row)| row[i]).fold(0.0, f64::max)
    };
    let final_form = |spec: &Spec| spec.calibration.is_linear_final();
    figure(
        "either channel or both gone for 1, 20 or 3000 samples within 16 periods from power-up, what is worse within four periods than it is without, % of the first miscalibration: final form of four and five parameters; every search; and what is worse than before the loss, of both: from the first calm gear on; earlier",
        &format!(
            "{:.1}; {:.0}; {:.1}, {:.1}; {:.1}, {:.0}",
            worst(2, &final_form),
            worst(2, &|_| true),
            worst(1, &final_form),
            worst(1, &|_| true),
            worst(0, &final_form),
            worst(0, &|_| true)
        ),
        "model/tests/on_line_stuck.rs",
    );
}

/// One that fades away before anything is proven may take the parameters along to their bounds: they find back.
#[test]
fn a_fade_from_the_start() {
    searches()
        .par_iter()
        .for_each(|Variant { spec, what, .. }| {
            let signals = sensor_for(spec, 5);
            for (fade, lost, from) in EARLY_FADES {
                let mut bench = Bench::new(spec, 5);
                let first = largest(&bench.miscalibration_at(72, &signals));
                let (begin, gone) = (from * PERIOD, (from + fade) * PERIOD);
                let back = gone + 3000;
                for k in 0..back + 200 * PERIOD {
                    let left = match k {
                        _ if k < begin || k >= back => 1.0,
                        _ if k < gone => f64::from(gone - k) / f64::from(gone - begin),
                        _ => 0.0,
                    };
                    let (c, s) = signals(TAU / f64::from(PERIOD) * f64::from(k));
                    let [of_c, of_s] = lost.map(|share| 1.0 - share * (1.0 - left));
                    bench.step((of_c * c, of_s * s));
                }
                let after = largest(&bench.miscalibration_at(72, &signals));
                let what = format!(
                    "{what}, {}: {fade} {lost:?} {from}",
                    spec.calibration.parameters
                );
                assert!(bench.chip.state.locked, "{what}");
                assert!(after < 0.05 * first, "{what}: {after:.4} of {first:.4}");
            }
        });
}
