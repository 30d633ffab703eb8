//! Eight and nine parameters on the chip: what the radius shows and what only the completion does.

use std::f64::consts::TAU;

use crate::chip_support::{Bench, optical, order, rms};
use nonius_kept::figure;
use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, Spec};
use rayon::prelude::*;

/// Samples per period of the signal; the loop's bandwidth is `bandwidth` times its frequency.
const PER_PERIOD: f64 = 126.0;

fn spec(parameters: u32, completion: bool, bandwidth: f64) -> Spec {
    let mut spec = optical();
    spec.adc.bits = 16;
    spec.tracking.bandwidth_hz = bandwidth * spec.adc.sample_rate_hz / PER_PERIOD;
    spec.calibration.parameters = parameters;
    spec.calibration.completion = completion;
    spec
}

/// Order 2 of the miscalibration before and after 1200 periods, and its rms after, mrad.
fn calibrate(spec: &Spec, signals: &dyn Fn(f64) -> (f64, f64)) -> [f64; 3] {
    let mut bench = Bench::new(spec, 5);
    let before = order(&bench.miscalibration(signals), 2);
    for k in 0..(1200.0 * PER_PERIOD) as u64 {
        bench.step(signals(TAU * k as f64 / PER_PERIOD));
    }
    assert!(bench.chip.state.locked);
    let after = bench.miscalibration(signals);
    [before, order(&after, 2), rms(&after)].map(|x| 1e3 * x)
}

/// Cubic terms that the set can invert.
fn cubic(alpha: f64) -> (f64, f64) {
    let (s, c) = alpha.sin_cos();
    (c + 0.03 * c.powi(3), s - 0.03 * s.powi(3))
}

fn third_harmonics(alpha: f64) -> (f64, f64) {
    (
        alpha.cos() + 0.03 * (3.0 * alpha).cos(),
        alpha.sin() + 0.03 * (3.0 * alpha).sin(),
    )
}

/// Offsets of 10 %, gain ratio 1.2, β = 5° and cubic terms.
fn wholly(alpha: f64) -> (f64, f64) {
    let (c, s) = (alpha.cos(), (alpha - 5f64.to_radians()).sin());
    (
        1.0954 * (c + 0.03 * c.powi(3)) + 0.1,
        0.9129 * (s - 0.03 * s.powi(3)) - 0.1,
    )
}

/// Flat tops are no bend: no cubic has them, and every set that tries makes the angle worse.
#[test]
fn clipped_signals_mislead_every_set() {
    let clipped = |alpha: f64| (alpha.cos().clamp(-0.9, 0.9), alpha.sin().clamp(-0.9, 0.9));
    let none = 1e3 * rms(&Bench::new(&spec(5, false, 1.0), 5).miscalibration(&clipped));
    let [five, nine] = [(5, false), (9, true)]
        .map(|(parameters, completion)| calibrate(&spec(parameters, completion, 1.0), &clipped)[2]);
    println!("clipped at 0.9: {none:.1} mrad rms, five {five:.1}, nine {nine:.1}");
    assert!(none < five && five < nine, "{none} {five} {nine}");
    figure(
        "both signals clipped at 0.9 of their amplitude: miscalibration without calibration, with five and with nine parameters, mrad rms",
        &format!("{none:.1}; {five:.1}; {nine:.1}"),
        "model/tests/chip_bends.rs",
    );
}

/// The largest γ of the completion that is not refused converges, behind loops of half to twice the signal's frequency: what 64 sectors gather is a step of a period.
#[test]
fn the_largest_gamma_of_the_completion_converges() {
    for bandwidth in [0.5, 0.7, 1.0, 1.4, 2.0] {
        let mut spec = spec(9, true, bandwidth);
        spec.calibration.completion_gamma = 6;
        let [before, after, _] = calibrate(&spec, &cubic);
        println!("loop {bandwidth} f: order 2 {before:.1} -> {after:.2} mrad");
        assert!(after < 0.5, "{after}");
    }
}

/// Loops of half to twice the signal's frequency, 0.1 % noise. Cubic terms: order 2 falls from 15 mrad to at most 0.15
/// with the completion and stays above 7 without. Third harmonics: from 30 mrad by at least 25 with it; the radius alone
/// makes it grow, with five parameters and with bends.
#[test]
fn what_no_radius_shows_needs_the_completion() {
    // The least that the radius alone leaves, the most that the completion does: cubic terms, third harmonics.
    let (mut alone, mut completed) = ([f64::INFINITY; 2], [0.0f64; 2]);
    for parameters in [5, 8, 9] {
        for bandwidth in [0.5, 1.0, 2.0] {
            let spec = spec(parameters, false, bandwidth);
            let [before, after, _] = calibrate(&spec, &cubic);
            assert!((before - 15.0).abs() < 0.1 && after > 7.0, "{after}");
            let [before, grown, _] = calibrate(&spec, &third_harmonics);
            assert!((before - 30.0).abs() < 0.1 && grown > 50.0, "{grown}");
            alone = [alone[0].min(after), alone[1].min(grown)];
            println!(
                "{parameters} parameters, loop {bandwidth} f, radius alone: cubic 15 -> {after:.1}, third 30 -> {grown:.1} mrad"
            );
        }
    }
    for parameters in [8, 9] {
        for bandwidth in [0.5, 1.0, 2.0] {
            let spec = spec(parameters, true, bandwidth);
            let [_, cubic, rest] = calibrate(&spec, &cubic);
            let [_, third, third_rest] = calibrate(&spec, &third_harmonics);
            println!(
                "{parameters} parameters, loop {bandwidth} f, completed: cubic 15 -> {cubic:.3} ({rest:.2} rms), third 30 -> {third:.3} mrad ({third_rest:.2} rms)"
            );
            assert!(cubic <= 0.15, "{cubic}");
            assert!(third * 25.0 <= 30.0, "{third}");
            completed = [completed[0].max(cubic), completed[1].max(third)];
        }
    }
    for (what, i) in [
        ("cubic terms of 3 %, 15.0", 0),
        ("third harmonics of 3 %, 30.0", 1),
    ] {
        figure(
            &format!(
                "order 2 of the miscalibration by {what} mrad, loops of half to twice the signal's frequency: completed, at most; by the radius alone, at least, mrad"
            ),
            &format!("{:.3}; {:.1}", completed[i], alone[i]),
            "model/tests/chip_bends.rs",
        );
    }
}

/// The signals of `sensor` with offsets of 10 %, these signs.
fn shifted(sensor: fn(f64) -> (f64, f64), signs: (f64, f64)) -> impl Fn(f64) -> (f64, f64) {
    move |alpha| {
        let (c, s) = sensor(alpha);
        (c + 0.1 * signs.0, s + 0.1 * signs.1)
    }
}

/// The figures at amplitudes of the normalised pair from 0.51 to 0.99 (just above a half of the ADC's range it is not doubled
/// any more), with offsets of 10 %, behind loops of a quarter to twice the signal's frequency: cubic terms, from 15 mrad to at
/// most 0.15 and above 7 without the completion; third harmonics down by at least 25, where the radius alone makes them grow.
#[test]
fn the_figures_hold_at_every_amplitude_and_offset() {
    for (amplitude, signs, bandwidth) in [
        (0.255, (1.0, 1.0), 2.0),
        (0.255, (-1.0, 1.0), 0.5),
        (0.30, (0.0, 0.0), 2.0),
        (0.35, (1.0, -1.0), 1.0),
        (0.42, (-1.0, -1.0), 2.0),
        (0.495, (1.0, 1.0), 2.0),
        (0.495, (0.0, -1.0), 0.5),
        (0.70, (-1.0, 1.0), 2.0),
        (0.42, (1.0, -1.0), 0.25),
    ] {
        for parameters in [8, 9] {
            let with = |completion| {
                let mut spec = spec(parameters, completion, bandwidth);
                spec.adc.full_scale = spec.sensor.amplitude / amplitude;
                spec
            };
            let (cubic, third) = (shifted(cubic, signs), shifted(third_harmonics, signs));
            let [_, alone, _] = calibrate(&with(false), &cubic);
            let [before, grown, _] = calibrate(&with(false), &third);
            let [_, completed, _] = calibrate(&with(true), &cubic);
            let [_, mended, _] = calibrate(&with(true), &third);
            println!(
                "{parameters} parameters, amplitude {amplitude} of the range, offsets {signs:?}, loop {bandwidth} f: cubic {completed:.3} (alone {alone:.1}), third {before:.1} -> {mended:.3} mrad (alone {grown:.1})"
            );
            assert!(completed <= 0.15 && alone > 7.0, "{completed} {alone}");
            assert!(
                mended * 25.0 <= before && grown > before,
                "{mended} {grown}"
            );
        }
    }
}

/// The same with everything else wrong as well: amplitudes of the pair from a half to one, offsets of 10 %, gain ratio 1.2,
/// β = 5°; nine parameters.
#[test]
fn nine_parameters_correct_a_wholly_miscalibrated_sensor() {
    for amplitude in [0.36, 0.5, 0.69, 1.0] {
        let with = |completion| {
            let mut spec = spec(9, completion, 1.0);
            spec.adc.full_scale = 1.4 * spec.sensor.amplitude / amplitude;
            calibrate(&spec, &wholly)
        };
        let (radial, [before, after, rest]) = (with(false), with(true));
        println!(
            "amplitude {amplitude}: order 2 {before:.1} -> {after:.3} mrad, {rest:.2} rms; radius alone {:.1}",
            radial[1]
        );
        assert!(radial[1] > 5.0, "{radial:?}");
        assert!(after <= 0.15, "{after}");
        assert!(rest <= 0.5, "{rest}");
    }
}

/// At standstill, and under a vibration by ±0.1 periods θ9 rests.
#[test]
fn without_net_travel_the_completion_rests() {
    for amplitude in [0.0, 0.1] {
        let mut bench = Bench::new(&spec(9, true, 1.0), 7);
        let mut alpha = 0.0;
        for _ in 0..20_000 {
            alpha += TAU / PER_PERIOD;
            bench.step(cubic(alpha));
        }
        // Braking: the periods before it still count.
        for k in 0..2000 {
            alpha += TAU / PER_PERIOD * (1.0 - f64::from(k) / 2000.0);
            bench.step(cubic(alpha));
        }
        for k in 0..4000 {
            bench.step(cubic(alpha + TAU * amplitude * (0.02 * f64::from(k)).sin()));
        }
        let before = bench.chip.state.theta_9_deviation;
        for k in 4000..200_000 {
            bench.step(cubic(alpha + TAU * amplitude * (0.02 * f64::from(k)).sin()));
        }
        assert!(!bench.chip.state.moving && bench.chip.state.locked);
        assert_eq!(bench.chip.state.theta_9_deviation, before);
    }
}

/// The sum of squares with bends, forgetting or in batches: the corrected pair in the estimate's place, θ9 by the completion as
/// in the final form. The same figures; without the completion it stands still beside the truth like the radial residual.
#[test]
fn the_sum_of_squares_is_completed_too() {
    for method in [CalibrationMethod::SumOfSquares, CalibrationMethod::Batch] {
        for parameters in [8, 9] {
            for bandwidth in [0.5, 1.0, 2.0] {
                let with = |completion| {
                    let mut spec = spec(parameters, completion, bandwidth);
                    spec.calibration.method = method;
                    spec
                };
                let [_, alone, _] = calibrate(&with(false), &cubic);
                let [_, cubic, rest] = calibrate(&with(true), &cubic);
                let [_, third, third_rest] = calibrate(&with(true), &third_harmonics);
                println!(
                    "{method:?}, {parameters} parameters, loop {bandwidth} f: cubic 15 -> {cubic:.3} ({rest:.2} rms; alone {alone:.1}), third 30 -> {third:.3} mrad ({third_rest:.2} rms)"
                );
                assert!(alone > 7.0, "{alone}");
                assert!(cubic <= 0.15, "{cubic}");
                assert!(third * 25.0 <= 30.0, "{third}");
            }
        }
    }
}

/// Everything wrong as for the final form, at both ends of the amplitude and of the memory.
#[test]
fn the_sum_of_squares_corrects_a_wholly_miscalibrated_sensor() {
    use CalibrationMethod::{Batch, SumOfSquares};
    for amplitude in [0.5, 0.71, 1.0] {
        for (method, forgetting) in [
            (SumOfSquares, 0),
            (SumOfSquares, 3),
            (SumOfSquares, 4),
            (Batch, 3),
        ] {
            let mut spec = spec(9, true, 1.0);
            spec.adc.full_scale = 1.4 * spec.sensor.amplitude / amplitude;
            spec.calibration.method = method;
            spec.calibration.forgetting = forgetting;
            let [before, after, rest] = calibrate(&spec, &wholly);
            println!(
                "{method:?}, forgetting {forgetting}, amplitude {amplitude}: order 2 {before:.1} -> {after:.3} mrad, {rest:.2} rms"
            );
            assert!(after <= 0.15, "{after}");
            assert!(rest <= 0.5, "{rest}");
        }
    }
}

/// From few samples a period to many. What the loop does not follow it amplifies all the more the fewer there are: third harmonics that
/// the radius has doubled stand in the phase error like a motion that is too fast, and must not close the gate for good.
#[test]
fn the_completion_wakes_at_every_speed() {
    let mut cases = vec![];
    for per_period in [
        8.3, 12.3, 16.3, 20.3, 30.3, 40.13, 50.13, 64.3, 126.0, 500.3,
    ] {
        // No loop is wider than a ninth of the sample rate.
        let widths = [0.5, 1.0, 1.4, 2.0].into_iter();
        for bandwidth in widths.filter(|width| width / per_period < 0.11) {
            for parameters in [8, 9] {
                for sign in [1.0, -1.0] {
                    cases.push((per_period, bandwidth, parameters, sign));
                }
            }
        }
    }
    let left = |&(per_period, bandwidth, parameters, sign): &(f64, f64, u32, f64)| {
        let mut spec = spec(parameters, true, 126.0 / per_period * bandwidth);
        if Design::new(&spec).is_err() {
            // So wide a loop jitters by more; the words stay as long.
            spec.accuracy.rms_periods = 1e-3;
            spec.accuracy.arithmetic_share = 0.002;
        }
        let order_2 = |sensor: fn(f64) -> (f64, f64)| {
            let signals = shifted(sensor, (sign, -1.0));
            let mut bench = Bench::new(&spec, 5);
            let before = order(&bench.miscalibration(&signals), 2);
            for k in 0..(1200.0 * per_period) as u64 {
                bench.step(signals(sign * TAU * k as f64 / per_period));
            }
            order(&bench.miscalibration(&signals), 2) / before
        };
        [order_2(cubic), order_2(third_harmonics)]
    };
    let rows: Vec<[f64; 2]> = cases.par_iter().map(left).collect();
    let worst = |i: usize| rows.iter().map(|row| row[i]).fold(0.0, f64::max);
    for (case, row) in cases.iter().zip(&rows) {
        println!("{case:?}: {row:.4?} of order 2 is left");
    }
    assert!(worst(1) < 1.0 / 25.0, "{}", worst(1));
    assert!(worst(0) <= 0.01, "{}", worst(0));
    figure(
        "order 2 of the miscalibration, completed, at 8 to 500 samples a period, loops of half to twice the signal's frequency as far as the sample rate allows, both directions: what is left of 15 mrad by cubic terms and of 30 by third harmonics, mrad",
        &format!("{:.2}; {:.2}", 15.0 * worst(0), 30.0 * worst(1)),
        "model/tests/chip_bends.rs",
    );
}
