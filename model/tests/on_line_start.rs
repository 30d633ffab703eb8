//! The start by least squares: Θ in two periods of travel.

use std::f64::consts::TAU;

use crate::chip_support::loss::sensor_for;
use crate::chip_support::{Bench, course, fast, rms};
use nonius_kept::figure;
use nonius_model::spec::{CalibrationMethod, CalibrationStart, Spec};

/// What is left when the start has solved its last period, worst of all signs: percent of the first miscalibration, and
/// the longest travel from lock to then, periods.
fn solved(spec: &Spec, per_period: f64) -> (f64, f64) {
    let (mut share, mut travel) = (0.0f64, 0.0f64);
    for signs in 0..16 {
        let signals = sensor_for(spec, signs);
        let mut bench = Bench::new(spec, u64::from(signs));
        let before = rms(&bench.miscalibration(&signals));
        let mut locked = 0u32;
        for k in 0.. {
            assert!(k < 40_000, "never solved");
            bench.step(signals(TAU / per_period * f64::from(k)));
            locked += u32::from(bench.chip.state.locked);
            if bench.chip.state.start_periods.to_f64() >= 2.0 {
                break;
            }
        }
        let left = rms(&bench.miscalibration(&signals));
        share = share.max(100.0 * left / before);
        // From the first sample in lock to the last one.
        travel = travel.max(f64::from(locked - 1) / per_period);
    }
    (share, travel)
}

/// The start by least squares: below 1 % within two periods, whatever the amplitude is of the ADC's range and however wide
/// the loop, and it stays there when the gears go on.
#[test]
fn least_squares_converge_in_two_periods() {
    let mut worst = 0.0f64;
    for (method, amplitude, bandwidth, per_period) in [
        (CalibrationMethod::Final, 0.55, 20e3, 64.37),
        (CalibrationMethod::Final, 0.65, 20e3, 64.0),
        (CalibrationMethod::Final, 0.8, 20e3, 64.37),
        (CalibrationMethod::Final, 0.65, 1e3, 64.37),
        (CalibrationMethod::Final, 0.65, 60e3, 64.37),
        (CalibrationMethod::Final, 0.65, 20e3, 1000.1),
        (CalibrationMethod::Exact, 0.65, 20e3, 64.37),
    ] {
        let mut spec = fast();
        spec.calibration.start = CalibrationStart::LeastSquares;
        spec.calibration.method = method;
        spec.sensor.amplitude = amplitude;
        spec.tracking.bandwidth_hz = bandwidth;
        let (left, travel) = solved(&spec, per_period);
        println!(
            "{method:?}, amplitude {amplitude}, loop {bandwidth} Hz, {per_period} samples a period: {left:.2} % left after {travel:.2} periods"
        );
        assert!(left < 1.0 && travel <= 2.0, "{left} {travel}");
        worst = worst.max(left);
        if per_period < 65.0 {
            let course = course(&spec, 8);
            println!("  {course:.2?} % left");
            assert!(course[2..].iter().all(|&left| left < 1.0), "{course:?}");
        }
    }
    figure(
        "the same with the start by least squares, after two periods, %",
        &format!("{worst:.2}"),
        "model/tests/on_line_start.rs",
    );
}

/// Few samples a period make it no worse, nor do four parameters, nor eight and nine, whose bends are not solved, nor signals that fill a
/// fourth of the ADC's range only.
#[test]
fn least_squares_start_far_from_home() {
    for (parameters, amplitude, per_period) in [
        (5, 0.65, 30.3),
        (5, 0.65, 12.3),
        (4, 0.65, 64.37),
        (8, 0.65, 64.37),
        (9, 0.65, 64.37),
        (4, 0.45, 64.37),
        (5, 0.45, 64.37),
        (5, 0.35, 64.37),
        (5, 0.25, 64.37),
    ] {
        let mut spec = fast();
        spec.calibration.start = CalibrationStart::LeastSquares;
        spec.calibration.parameters = parameters;
        spec.sensor.amplitude = amplitude;
        spec.sensor.speed_max_periods_per_s = 100e3;
        let (left, travel) = solved(&spec, per_period);
        println!(
            "{parameters} parameters, amplitude {amplitude}, {per_period} samples a period: {left:.2} % left after {travel:.2} periods"
        );
        assert!(left < 1.0, "{left}");
        // Of few samples, more periods are needed.
        assert!(per_period < 64.0 || travel <= 2.0, "{travel}");
    }
}
