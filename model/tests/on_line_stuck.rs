//! A channel that is stuck at any level for any time leaves nothing in the parameters; a sensor that has
//! changed for good is learned again.

mod chip_support;

use std::f64::consts::TAU;

use chip_support::loss::{Loss, PERIOD, each_settled, watch};
use chip_support::shipped::variants::{Variant, searches};
use chip_support::{Bench, largest, optical};
use rand::{Rng, SeedableRng, rngs::StdRng};
use rayon::prelude::*;

/// Levels and times of each search.
const CASES: usize = 60;
/// What stays below `hold_residual`, for some samples, may move them by so much, radians.
const SMALL: f64 = 1e-3;

#[test]
fn a_stuck_channel_leaves_nothing() {
    searches().par_iter().for_each(|variant| {
        let Variant { spec, what, .. } = variant;
        let each = each_settled(spec);
        let mut random = StdRng::seed_from_u64(11);
        for case in 0..CASES {
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

/// A third larger, or a quarter smaller: held for 32 periods, then searched for anew.
#[test]
fn another_amplitude_is_learned() {
    for (before, after) in [(0.85, 1.15), (1.15, 0.85)] {
        let mut bench = Bench::new(&optical(), 3);
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
        let (_, held) = run(&mut bench, after, 25);
        let (learned, again) = run(&mut bench, after, 175);
        println!(
            "{before} -> {after}: {settled:.1e} rad, radius {radius:.3}, {held:.3}; {learned:.1e} rad, {again:.3}"
        );
        let ratio = held / radius / (after / before);
        assert!((ratio - 1.0).abs() < 0.01, "held: {ratio}");
        assert!(learned < 2.0 * settled && (again / radius - 1.0).abs() < 0.01);
    }
}
