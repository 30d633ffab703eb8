//! What on-line calibration of the bit-true chip reaches, figure by figure.

use std::f64::consts::TAU;

use crate::chip_support::loss::sensor_for;
use crate::chip_support::shipped::variants::{Variant, searches_of};
use crate::chip_support::{Bench, course, course_at, fast, largest, optical};
use nonius_kept::{every, figure, figure_of_short, long};
use nonius_model::spec::{CalibrationMethod, Spec};
use rayon::prelude::*;

const TEST: &str = "model/tests/on_line_figures.rs";

/// What is measured of a sensor that is new.
const NEW: &str = "on line, from lock, 64 samples a period and more, 12 bits, 0.1 % noise, offsets 10 %, gain ratio 1.2, β 5° (five parameters), worst of all signs and amplitudes: what is left of the first miscalibration after five periods of travel";

/// Below 1 % within five periods, whatever the amplitude is of the ADC's range, however wide the loop and slow the signal: the square of the
/// amplitude is taken out of the gradient to a power of two, so the amplitudes go round an octave and more.
#[test]
fn the_chip_converges_in_five_periods() {
    let mut reached = vec![];
    for parameters in [4, 5] {
        let amplitudes = (0..30).into_par_iter().map(|n| 0.25 + 0.02 * f64::from(n));
        let left = amplitudes.map(|amplitude| {
            // Loops of a third to four times the signal's frequency at 64 samples a period, and slower signals.
            let loops = [
                (5e3, 64.37),
                (10e3, 64.0),
                (10e3, 126.3),
                (10e3, 500.7),
                (20e3, 64.0),
                (20e3, 64.37),
                (60e3, 64.0),
                (60e3, 64.37),
            ];
            let left = loops.map(|(bandwidth, per_period)| {
                let mut spec = fast();
                spec.sensor.amplitude = amplitude;
                spec.tracking.bandwidth_hz = bandwidth;
                spec.calibration.parameters = parameters;
                course_at(&spec, 5, per_period)[4]
            });
            println!("{parameters} parameters, amplitude {amplitude:.2}: {left:.2?} % left");
            largest(&left)
        });
        let worst = left.reduce(|| 0.0, f64::max);
        assert!(worst < 1.0, "{parameters} parameters: {worst}");
        reached.push(format!("{parameters} parameters {worst:.2}"));
    }
    figure(&format!("{NEW}, %"), &reached.join("; "), TEST);
}

/// What is left of the first miscalibration at most after so many periods of travel from lock, %, over amplitudes of an octave and more,
/// all signs and loops that meet the sectors at the same places or not.
fn left_after(method: CalibrationMethod, parameters: u32, periods: usize) -> f64 {
    let step = if long() { 1 } else { 2 };
    let each = (0..15).into_par_iter().step_by(step).flat_map(|n| {
        let amplitude = 0.25 + 0.04 * f64::from(n);
        [(amplitude, 64.0), (amplitude, 64.37)]
    });
    let left = each.map(|(amplitude, per_period)| {
        let mut spec = fast();
        spec.sensor.amplitude = amplitude;
        spec.calibration.method = method;
        spec.calibration.parameters = parameters;
        course_at(&spec, periods, per_period)[periods - 1]
    });
    left.reduce(|| 0.0, f64::max)
}

/// The exact gradient gets there as fast, the other searches of the paper and the larger sets later: these are as many periods as each
/// takes at any amplitude, a few more where the last per cents are slow.
#[test]
fn every_search_and_set_converges() {
    let mut reached = vec![];
    for (method, [(few, after), (many, later)]) in [
        (CalibrationMethod::Exact, [(4, 5), (5, 5)]),
        (CalibrationMethod::SumOfSquares, [(4, 9), (5, 9)]),
        (CalibrationMethod::Batch, [(4, 16), (5, 30)]),
        (CalibrationMethod::Final, [(8, 9), (9, 9)]),
        (CalibrationMethod::SumOfSquares, [(8, 10), (9, 14)]),
        (CalibrationMethod::Batch, [(8, 16), (9, 16)]),
    ] {
        let left = [(few, after), (many, later)].map(|(parameters, periods)| {
            let left = left_after(method, parameters, periods);
            println!("{method:?}, {parameters} parameters, {periods} periods: {left:.2} % left");
            assert!(left < 1.0, "{method:?}, {parameters}: {left}");
            format!("{left:.2}")
        });
        reached.push(left.join(", "));
    }
    figure_of_short(
        "the same with four and five parameters by the exact gradient after five periods, the sum of squares after nine, batches after 16 and 30, with eight and nine after nine, the sum of squares after 10 and 14, batches after 16, %",
        &reached.join("; "),
        TEST,
    );
}

/// A period teaches by the sectors that samples meet: with fewer than 64 samples a period it teaches less.
#[test]
fn fewer_samples_a_period_take_longer() {
    let rows: Vec<String> = [50.3, 20.3, 10.3]
        .into_par_iter()
        .map(|per_period| {
            let left = course_at(&fast(), 100, per_period);
            println!("{per_period} samples a period: {left:.2?} % left");
            let [five, twenty, hundred] = [5, 20, 100].map(|periods| left[periods - 1]);
            assert!(hundred < twenty && twenty < five, "{per_period}: {left:?}");
            format!("{five:.1}, {twenty:.2}, {hundred:.2}")
        })
        .collect();
    figure(
        "on line, from lock, 50, 20 and 10 samples a period, five parameters, otherwise the same: what is left of the first miscalibration after 5, 20 and 100 periods of travel, %",
        &rows.join("; "),
        TEST,
    );
}

/// A sensor of 0.8 of the ADC's range is there sooner.
#[test]
fn a_large_signal_converges_sooner() {
    for (method, parameters, within) in [
        (CalibrationMethod::Exact, 5, 5),
        (CalibrationMethod::SumOfSquares, 5, 5),
        (CalibrationMethod::Batch, 5, 8),
        (CalibrationMethod::Final, 9, 9),
    ] {
        let mut spec = fast();
        spec.calibration.method = method;
        spec.calibration.parameters = parameters;
        let left = course(&spec, within);
        println!("{method:?}, {parameters} parameters: {left:.2?} % left");
        assert!(left[within - 1] < 1.0, "{method:?} {left:?}");
    }
}

/// The exact gradient behind a loop that follows in part or hardly (the signal has 15.5 kHz).
#[test]
fn the_exact_gradient_converges_behind_a_slow_loop() {
    for (bandwidth, within) in [(1e3, 9), (4e3, 5), (8e3, 5), (20e3, 5)] {
        let mut spec = fast();
        spec.calibration.method = CalibrationMethod::Exact;
        spec.tracking.bandwidth_hz = bandwidth;
        let left = course(&spec, within);
        println!("loop {bandwidth} Hz: {left:.2?} % left");
        assert!(left[within - 1] < 1.0, "{left:?}");
    }
}

/// Behind a loop that follows nearly all of what it would learn from, the exact gradient takes longer.
#[test]
fn the_exact_gradient_is_slow_where_the_loop_is_wide() {
    let each = [200.0, 400.0, 800.0].into_par_iter().map(|per_period| {
        let mut spec = fast();
        spec.calibration.method = CalibrationMethod::Exact;
        let left = course_at(&spec, 20, per_period);
        println!("{per_period} samples a period: {left:.2?} % left");
        [4, 9, 19].map(|period| left[period])
    });
    let worst = each.reduce(
        || [0.0; 3],
        |a, b| std::array::from_fn(|i| f64::max(a[i], b[i])),
    );
    assert!(worst[2] < 1.0, "{worst:?}");
    figure(
        "the same with five parameters by the exact gradient behind loops of four to sixteen times the signal's frequency after five, ten and twenty periods, %",
        &worst.map(|left| format!("{left:.2}")).join(", "),
        TEST,
    );
}

/// Samples a period in the steady state: little more than whole numbers, so that all places are met.
const STEADY: [f64; 5] = [20.3, 64.1, 126.37, 2003.0, 10_000.3];

/// Of a quiet 16-bit input.
fn quiet() -> Spec {
    let mut spec = optical();
    spec.adc.bits = 16;
    spec.sensor.noise_rms = 0.0;
    spec.accuracy.rms_periods = 5e-6;
    spec
}

/// Largest error of α̂ in the last quarter of a run, periods: from power-up, or from where the search has found its end at another speed.
fn steady(spec: &Spec, per_period: f64, signs: u32, from_power_up: bool) -> f64 {
    let signals = sensor_for(spec, signs);
    let mut bench = Bench::new(spec, 1);
    let mut turns = 0.0f64;
    if !from_power_up {
        for _ in 0..400_000 {
            bench.step(signals(TAU * turns));
            turns += 1.0 / STEADY[2];
        }
    }
    let mut worst = 0.0f64;
    // From power-up some hundred periods at least.
    let periods = if from_power_up { 120.0 } else { 40.0 };
    let samples = (periods * per_period).max(400_000.0) as u32;
    for k in 0..samples {
        if k >= samples / 4 * 3 {
            let error = bench.chip.position() - turns;
            worst = worst.max((error - error.round()).abs());
        }
        bench.step(signals(TAU * turns));
        turns += 1.0 / per_period;
    }
    worst
}

/// A search, samples a period, and signs of the sensor's errors.
type Steady = (Variant, f64, u32);

/// Largest error of α̂ in the steady state of all of these, %, each below a thousandth.
fn largest_of(cases: Vec<Steady>, from_power_up: bool) -> String {
    let worst = cases.into_par_iter().map(|(of, per_period, signs)| {
        let worst = 100.0 * steady(&of.spec, per_period, signs, from_power_up);
        println!(
            "{}, {} parameters, {per_period} samples a period, signs {signs}: largest error {worst:.5} % of a period",
            of.what, of.spec.calibration.parameters
        );
        assert!(worst < 1e-3, "{worst}");
        worst
    });
    format!("{:.5}", worst.reduce(|| 0.0, f64::max))
}

/// Quiet 16-bit input with ellipse errors, slow and fast, every set: the largest error of α̂ in the steady state is below 0.001 % of
/// a period. Two sensors each; in the long form four.
#[test]
fn the_steady_state_is_below_a_hundred_thousandth() {
    let mut cases = vec![];
    for parameters in [4, 5, 8, 9] {
        let mut spec = quiet();
        spec.calibration.parameters = parameters;
        let what = "final form".to_owned();
        let of = Variant { what, spec };
        for per_period in STEADY {
            let sensors = every(2, [0, 5, 10, 15]);
            cases.extend(sensors.map(|signs| (of.clone(), per_period, signs)));
        }
    }
    figure_of_short(
        "steady state, quiet 16-bit input, 20 to 10 000 samples a period, every set: largest error of α̂, % of a period",
        &largest_of(cases, true),
        TEST,
    );
}

/// The same of every other search and set, once it has found its end at 126 samples a period: most take longer than that at 10 000.
#[test]
fn the_steady_state_of_every_search() {
    let others = searches_of(&quiet()).into_iter().filter(|of| {
        let calibration = &of.spec.calibration;
        calibration.method != CalibrationMethod::Final || calibration.starts()
    });
    let speeds: &[f64] = if long() {
        &STEADY
    } else {
        &[STEADY[1], STEADY[4]]
    };
    let cases = others.flat_map(|of| speeds.iter().map(move |&speed| (of.clone(), speed, 5)));
    figure_of_short(
        "steady state, quiet 16-bit input, every other search and set, found at 126 samples a period, then 64 and 10 000: largest error of α̂, % of a period",
        &largest_of(cases.collect(), false),
        TEST,
    );
}
