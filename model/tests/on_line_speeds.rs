//! Lock and calibration at speeds commensurate with the sample rate, down to four samples a period.

use std::f64::consts::TAU;

use crate::chip_support::{Bench, fast, rms, sensor};
use nonius_kept::{every, figure, figure_of_short, long};
use nonius_model::spec::{CalibrationMethod, Spec};
use rayon::prelude::*;

const TEST: &str = "model/tests/on_line_speeds.rs";

/// Speeds of exactly 5, 8 and 64 samples a period neither stall nor bias the calibration: what is left is the noise of the
/// parameters, wherever in the period the samples lie.
#[test]
fn commensurate_speeds_calibrate() {
    let mut left = vec![];
    for per_period in [5, 8, 64] {
        let mut worst = 0.0f64;
        for (signs, place) in (0..16).zip([0.013, 0.1, 0.125, 0.0].into_iter().cycle()) {
            let signals = sensor(signs);
            let mut bench = Bench::new(&up_to(5.0, 20e3), 3);
            for k in 0..6000 * per_period {
                bench.step(signals(
                    TAU * (f64::from(k) / f64::from(per_period) + place),
                ));
            }
            assert!(bench.chip.state.locked);
            worst = worst.max(rms(&bench.miscalibration(&signals)));
        }
        println!("{per_period} samples a period: {worst:.2e} rad rms left");
        // What rounding leaves of the gains' and the phase's smaller steps shows at five places.
        let limit = if per_period < 8 { 5e-4 } else { 3e-4 };
        assert!(worst < limit, "{worst}");
        left.push(format!("{:.2}", 1e3 * worst));
    }
    figure(
        "exactly 5, 8 and 64 samples a period: what is left of the miscalibration, mrad rms",
        &left.join("; "),
        TEST,
    );
}

/// A design for so many samples a period at top speed. Where samples lie at a few places, roundings are not averaged: arithmetic
/// has less of the error than where they are.
fn up_to(per_period: f64, bandwidth: f64) -> Spec {
    let mut spec = fast();
    spec.accuracy.rms_periods = 1e-3;
    spec.accuracy.arithmetic_share = 0.02;
    spec.tracking.bandwidth_hz = bandwidth;
    spec.sensor.speed_max_periods_per_s = spec.adc.sample_rate_hz / per_period;
    spec
}

/// Nine parameters, whose accumulators are those of the optical design.
fn nine() -> Spec {
    let mut spec = up_to(5.0, 20e3);
    spec.calibration.parameters = 9;
    spec.formats.accumulator_fraction = Some(25);
    spec
}

/// So many samples from a place of the period on, each so many periods after the last.
pub(crate) fn travel(
    bench: &mut Bench,
    signals: &impl Fn(f64) -> (f64, f64),
    turns: &mut f64,
    (samples, step): (u32, f64),
) {
    for _ in 0..samples {
        bench.step(signals(TAU * *turns));
        *turns += step;
        *turns -= turns.floor();
    }
}

/// A design that may run at exactly four samples a period for very long: its accumulators are those of the optical one.
pub(crate) fn for_long() -> Spec {
    let mut spec = up_to(4.0, 20e3);
    spec.formats.accumulator_fraction = Some(25);
    spec
}

/// From rest, not yet calibrated, into any speed that the design promises: the loop locks. Every third bandwidth; in the long form
/// all.
#[test]
fn locks_from_rest_at_any_promised_speed() {
    let bandwidths = [
        500.0, 1e3, 1.5e3, 2e3, 3e3, 5e3, 10e3, 12e3, 20e3, 27e3, 40e3, 60e3, 100e3,
    ];
    for bandwidth in every(3, bandwidths) {
        let spec = up_to(4.0, bandwidth);
        // Gears and levels go with the loop's settling.
        let allowed = (40.0 * spec.adc.sample_rate_hz / (TAU * bandwidth)).max(2000.0) as u32;
        let mut latest = 0;
        for per_period in [
            4.0, 4.1, 5.0, 5.5, 6.0, 6.1, 7.0, 8.0, 8.1, 10.0, 20.0, 40.0,
        ] {
            for (signs, place) in (0..16).flat_map(|s| (0..4).map(move |p| (s, f64::from(p) / 4.0)))
            {
                let signals = sensor(signs);
                let mut bench = Bench::new(&spec, u64::from(signs));
                let locked = (0..allowed).find(|&k| {
                    bench.step(signals(TAU * (f64::from(k) / per_period + place)));
                    bench.chip.state.locked
                });
                latest = latest.max(locked.unwrap_or_else(|| {
                    panic!("{per_period} samples a period, loop {bandwidth} Hz, signs {signs}, from {place}: no lock")
                }));
            }
        }
        println!("loop {bandwidth} Hz: locked after at most {latest} samples");
    }
}

/// Four samples a period show four places of the period, at which the radius cannot tell all five parameters, and the phase error
/// does: a quarter of a million periods after calibration it is as it was, whatever is lost in rounding the steps. Every sign of
/// the errors.
#[test]
fn four_samples_a_period_leave_the_parameters() {
    let places = [[0.0, 0.09375], [0.03125, 0.125]];
    let all = (0..16).flat_map(|signs| {
        let odd = u32::count_ones(signs) as usize % 2;
        let here = if long() {
            places.concat()
        } else {
            places[odd].to_vec()
        };
        here.into_iter().map(move |place| (signs, place))
    });
    let all: Vec<(u32, f64)> = all.collect();
    let worst = all.into_par_iter().map(|(signs, place)| {
        let signals = sensor(signs);
        let mut bench = Bench::new(&for_long(), 3);
        let mut turns = place;
        for k in 0..40_000 {
            turns += (f64::from(k) / 20_000.0).min(1.0) / 8.0;
            bench.step(signals(TAU * turns));
        }
        let before = rms(&bench.miscalibration(&signals));
        for k in 0..1_000_000 {
            turns += 0.125 + (f64::from(k) / 20_000.0).min(1.0) / 8.0;
            turns -= turns.floor();
            bench.step(signals(TAU * turns));
        }
        let after = rms(&bench.miscalibration(&signals));
        println!(
            "4 samples a period, signs {signs}, place {place}: {before:.1e} -> {after:.1e} rad rms"
        );
        assert!(bench.chip.state.locked && after < 2e-4, "{after}");
        [before, after].map(|x| 1e3 * x)
    });
    let [before, after] = worst.reduce(|| [0.0; 2], |a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    figure_of_short(
        "exactly 4 samples a period for 250 000 periods, calibrated before, accumulators of 25 bits as in the optical design, worst of all signs at two of four places each: miscalibration before and after, mrad rms",
        &format!("{before:.2}; {after:.2}"),
        TEST,
    );
}

/// So they are found behind loops of every method, type and width, which follow what changes from sample to sample as little as that: from
/// new, at exactly four and exactly eight samples a period, five parameters and nine. A loop of type 1 lags: what is the same at all samples is
/// no error of the sensor.
#[test]
fn any_loop_learns_at_four_and_eight_samples_a_period() {
    let loops = [
        (1, 2, 1e3),
        (1, 2, 20e3),
        (3, 2, 2e3),
        (3, 2, 60e3),
        (3, 2, 100e3),
        (1, 1, 60e3),
        (3, 1, 100e3),
    ];
    let cases = loops
        .into_iter()
        .flat_map(|of| [(of, 5, 4, 0.05), (of, 9, 8, 1.0 / 16.0)]);
    let worst = cases
        .collect::<Vec<_>>()
        .into_par_iter()
        .map(|((method, filter_type, bandwidth), parameters, per_period, place)| {
            let mut spec = for_long();
            spec.tracking.method = method;
            spec.tracking.filter_type = filter_type;
            spec.tracking.bandwidth_hz = bandwidth;
            // Nearer to 1 than four samples a period are from what it lags there.
            spec.tracking.pole = (filter_type == 1).then_some(0.9995);
            spec.calibration.parameters = parameters;
            let worst = [0, 5, 10, 15].map(|signs| {
                let signals = sensor(signs);
                let mut bench = Bench::new(&spec, u64::from(signs));
                let mut turns = place;
                travel(&mut bench, &signals, &mut turns, (200_000, 1.0 / f64::from(per_period)));
                assert!(bench.chip.state.locked);
                rms(&bench.miscalibration(&signals))
            });
            let worst = worst.into_iter().fold(0.0, f64::max);
            println!(
                "method {method} type {filter_type}, {bandwidth} Hz, {parameters} parameters at {per_period}: {worst:.1e} rad rms"
            );
            worst
        })
        .reduce(|| 0.0, f64::max);
    assert!(worst < 4e-4, "{worst}");
}

/// From new, at exactly four samples a period, so does the exact gradient.
#[test]
fn the_exact_gradient_calibrates_at_four_samples_a_period() {
    for (signs, place) in [(0, 0.0), (5, 0.05), (10, 0.1), (15, 0.125)] {
        let signals = sensor(signs);
        let mut spec = for_long();
        spec.calibration.method = CalibrationMethod::Exact;
        let mut bench = Bench::new(&spec, u64::from(signs));
        for k in 0..400_000 {
            bench.step(signals(TAU * (f64::from(k % 4) / 4.0 + place)));
        }
        let left = rms(&bench.miscalibration(&signals));
        println!(
            "exact, 4 samples a period, signs {signs}, place {place}: {left:.1e} rad rms left"
        );
        assert!(left < 2e-4, "{left}");
    }
}

/// From new, at exactly four samples a period: the radius at each comes to 1, and what no radius there shows (one combination of
/// gains and phase) is found from the phase error. A speed that is not exactly four finds nothing else.
#[test]
fn four_samples_a_period_calibrate() {
    for (signs, place) in (0..16).zip([0.0, 0.05, 0.1, 0.125].into_iter().cycle()) {
        let signals = sensor(signs);
        let mut bench = Bench::new(&for_long(), u64::from(signs));
        let before = rms(&bench.miscalibration(&signals));
        let radius = |bench: &Bench| {
            let places = (0..4).map(|i| TAU * (f64::from(i) / 4.0 + place));
            places.fold(0.0f64, |m, a| {
                let (c, s) = bench.corrected(signals(a));
                m.max((c.hypot(s) - 1.0).abs())
            })
        };
        let (first, mut turns) = (radius(&bench), place);
        let mut run = |bench: &mut Bench, samples: u32, step: f64| {
            travel(bench, &signals, &mut turns, (samples, step));
        };
        run(&mut bench, 100_000, 0.25);
        let (half, left) = (radius(&bench), rms(&bench.miscalibration(&signals)));
        run(&mut bench, 400_000, 0.25);
        let (seen, later) = (radius(&bench), rms(&bench.miscalibration(&signals)));
        run(&mut bench, 100_000, 0.2501);
        let after = rms(&bench.miscalibration(&signals));
        println!(
            "4 samples a period, signs {signs}, place {place}: radius at the places {first:.1e} -> {half:.1e} -> {seen:.1e}, miscalibration {before:.1e} -> {left:.1e} -> {later:.1e} rad rms; at another speed {after:.1e}"
        );
        assert!(seen < 1e-3 && half < 1e-3, "{half} {seen}");
        assert!(left < 2e-4 && later < 2e-4, "{left} {later}");
        assert!(after < 2e-4, "{after}");
    }
}

/// Nine parameters at exactly eight samples a period, where cos 4α is 0 at all of them: no radius shows the common bend of third order, and the
/// phase error does.
#[test]
fn eight_places_without_cos_4_alpha_show_the_bend() {
    let mut rows = vec![];
    for method in [
        CalibrationMethod::Final,
        CalibrationMethod::SumOfSquares,
        CalibrationMethod::Batch,
    ] {
        let mut spec = nine();
        spec.calibration.method = method;
        let mut worst = [0.0f64; 2];
        for signs in 0..16 {
            let signals = sensor(signs);
            let mut bench = Bench::new(&spec, 3);
            let mut turns = 1.0 / 16.0;
            for (worst, per_period) in worst.iter_mut().zip([8.0, 8.0 * 1.003]) {
                travel(&mut bench, &signals, &mut turns, (48_000, 1.0 / per_period));
                *worst = worst.max(rms(&bench.miscalibration(&signals)));
            }
        }
        let [seen, beside] = worst.map(|rad| 1e3 * rad);
        println!("{method:?}: {seen:.2} -> {beside:.2} mrad rms");
        assert!(seen < 0.3 && beside < 0.3, "{seen} {beside}");
        rows.push(format!("{seen:.2}, {beside:.2}"));
    }
    figure(
        "final form, sum of squares and batch, nine parameters, exactly 8 samples a period, the first a sixteenth of a period from the cosine's top, 6000 periods from new, and 6000 a little beside: what is left of the miscalibration, mrad rms",
        &rows.join("; "),
        TEST,
    );
}

/// Nine parameters: eight places of the period tell them all; five, six and seven tell the five of the ellipse,
/// and the bends rest. From new, a speed a little beside, and exactly so many samples a period again leave it alone. At 64 every fifth of
/// the signs; in the long form all.
#[test]
fn nine_parameters_at_few_places() {
    let mut rows = vec![];
    for per_period in [5, 6, 7, 8, 64] {
        let mut worst = [0.0f64; 4];
        let all = (0..16).zip([0.013, 0.1, 0.125, 0.0].into_iter().cycle());
        // Sixty-four samples take long: every fifth of the signs, each at another place.
        for (signs, place) in every(if per_period < 64 { 1 } else { 5 }, all) {
            let signals = sensor(signs);
            let mut bench = Bench::new(&nine(), 3);
            let mut turns = place;
            let mut run = |bench: &mut Bench, periods: u32, per_period: f64| {
                let samples = (f64::from(periods) * per_period) as u32;
                travel(bench, &signals, &mut turns, (samples, 1.0 / per_period));
                rms(&bench.miscalibration(&signals))
            };
            let exactly = f64::from(per_period);
            let first = rms(&bench.miscalibration(&signals));
            let seen = run(&mut bench, 6000, exactly);
            let beside = run(&mut bench, 6000, exactly * 1.003);
            let again = run(&mut bench, 10_000, exactly);
            for (worst, now) in worst.iter_mut().zip([first, seen, beside, again]) {
                *worst = worst.max(now);
            }
        }
        let [first, seen, beside, again] = worst.map(|rad| 1e3 * rad);
        println!(
            "{per_period} samples a period: {first:.2} -> {seen:.2} -> {beside:.2} -> {again:.2} mrad rms"
        );
        assert!(
            seen < 0.3 && beside < 0.3 && again < 0.5,
            "{seen} {beside} {again}"
        );
        rows.push([seen, again].map(|mrad| format!("{mrad:.2}")));
    }
    let column = |i: usize| {
        rows.iter()
            .map(|row| row[i].as_str())
            .collect::<Vec<_>>()
            .join(", ")
    };
    figure_of_short(
        "nine parameters, exactly 5, 6, 7, 8 and 64 samples a period, at 64 every fifth of the signs, for 6000 periods from new, and for 10 000 once calibrated: what is left of the miscalibration, mrad rms",
        &format!("{}; {}", column(0), column(1)),
        TEST,
    );
}
