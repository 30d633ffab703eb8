//! The chip as a whole: it locks, follows, calibrates, and its three readings agree.

use crate::graph_support::graph_equals_chip;
use crate::support::{Encoder, optical, wrapped};
use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, CalibrationStart};

/// From rest into any speed up to the promised one, from any phase, with a miscalibrated sensor.
#[test]
fn pulls_in_from_any_phase_into_any_speed() {
    let spec = optical();
    let design = Design::new(&spec).expect("a shipped design");
    let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    for encoder in [Encoder::ideal(&spec), Encoder::miscalibrated(&spec)] {
        for speed in [-1.0, -0.6, -0.1, -0.003, 0.0, 1e-5, 0.01, 0.3, 0.8, 1.0].map(|x| x * top) {
            for phase in (0..16).map(|i| f64::from(i) / 16.0) {
                let mut chip = Chip::bit_true(&design);
                let mut locked_at = None;
                for k in 0..3000 {
                    let [cos, sin] = encoder.codes(phase + speed * f64::from(k));
                    chip.step_codes(cos, sin, false, true);
                    if chip.state.locked && locked_at.is_none() {
                        locked_at = Some(k);
                    }
                }
                assert!(chip.state.locked, "speed {speed} phase {phase}: not locked");
                assert!(
                    !chip.state.lock_lost,
                    "speed {speed} phase {phase}: lost (locked at {locked_at:?})"
                );
                let error = wrapped(chip.position() - phase - speed * 3000.0);
                assert!(
                    error.abs() < 0.06,
                    "speed {speed} phase {phase}: off by {error} periods"
                );
            }
        }
    }
}

/// After some periods of travel the on-line parameters make the error vanish to about the ADC's own.
#[test]
fn calibrates_on_line() {
    let spec = optical();
    let design = Design::new(&spec).expect("a shipped design");
    let encoder = Encoder::miscalibrated(&spec);
    let mut chip = Chip::bit_true(&design);
    let speed = 0.00731;
    let mut worst_before: f64 = 0.0;
    let mut worst: f64 = 0.0;
    for k in 0..30_000 {
        let at = speed * f64::from(k);
        let error = wrapped(chip.position() - at);
        if (300..420).contains(&k) {
            worst_before = worst_before.max(error.abs());
        }
        if k > 20_000 {
            worst = worst.max(error.abs());
        }
        let [cos, sin] = encoder.codes(at);
        chip.step_codes(cos, sin, false, true);
    }
    assert!(
        worst_before > 5e-3,
        "the sensor is miscalibrated at first: {worst_before}"
    );
    assert!(
        worst < 1e-4,
        "largest error after calibration {worst} periods, before {worst_before}"
    );
}

/// The recorded graph, evaluated one integer after the other, is the chip in every register and every bit.
#[test]
fn graph_and_chip_agree_in_every_bit() {
    let design = Design::new(&optical()).expect("a shipped design");
    let encoder = Encoder::miscalibrated(&design.spec);
    graph_equals_chip(&design, |k| encoder.codes(0.0173 * f64::from(k)), 4000);
}

/// Products of a sample. The paper counts sixteen for five parameters, and six more than the bare loop for four: that loop
/// with a fixed correction has ten here, and four parameters four more. What the loop lags costs one more (`calibration.lag`).
#[test]
fn products_of_a_sample() {
    use CalibrationMethod::{Batch, Exact, Final, SumOfSquares};
    use CalibrationStart::{Gears, LeastSquares};
    for (method, start, lag, parameters, products) in [
        (Final, Gears, None, 0, 10),
        (Final, Gears, Some(false), 4, 14),
        (Final, Gears, Some(false), 5, 16),
        (Final, Gears, None, 4, 15),
        (Final, Gears, None, 5, 17),
        (Final, Gears, None, 8, 32),
        (Final, Gears, None, 9, 34),
        (Final, LeastSquares, None, 5, 26),
        (SumOfSquares, Gears, None, 5, 18),
        (Batch, Gears, None, 5, 18),
        (Exact, Gears, None, 4, 29),
        (Exact, Gears, None, 5, 35),
    ] {
        let mut spec = optical();
        spec.calibration.method = method;
        spec.calibration.start = start;
        spec.calibration.lag = lag;
        spec.calibration.parameters = parameters;
        let design = Design::new(&spec).expect("a design that works");
        assert_eq!(
            design.graph.products(),
            products,
            "{method:?} {start:?} {lag:?} {parameters}"
        );
    }
}
