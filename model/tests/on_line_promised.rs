//! Sensors at the ends of what a design promises are learnt by the searches that swing on their way: bends by sums of squares.

use std::f64::consts::TAU;

use crate::chip_support::{Bench, optical, rms};
use nonius_kept::{every, figure};
use nonius_model::spec::{CalibrationMethod, Sensor};
use rayon::prelude::*;

/// A sensor with each promised error of the ellipse at an end: which, by the bits of `signs`.
fn at_the_end(sensor: &Sensor, signs: u32, beta_deg: f64) -> impl Fn(f64) -> (f64, f64) + use<> {
    let sign = move |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let (gain, offset) = (sensor.amplitude_tolerance, sensor.offset_max);
    let beta = beta_deg.to_radians();
    move |alpha: f64| {
        (
            (1.0 + sign(0) * gain) * alpha.cos() + sign(2) * offset,
            (1.0 + sign(1) * gain) * (alpha + sign(4) * beta).sin() + sign(3) * offset,
        )
    }
}

/// All nine at once from the first period on swung from bound to bound with gains at the ends of the promise, and never settled.
#[test]
fn bends_by_sums_of_squares_are_learnt_at_the_ends_of_the_promise() {
    const PERIODS: usize = 200;
    let mut reached = vec![];
    for method in [CalibrationMethod::SumOfSquares, CalibrationMethod::Batch] {
        for parameters in [8, 9] {
            let mut spec = optical();
            spec.calibration.method = method;
            spec.calibration.parameters = parameters;
            let beta = if parameters == 9 {
                spec.sensor.phase_error_max_deg
            } else {
                0.0
            };
            let each: Vec<(u32, f64, f64)> = every(3, 0..32)
                .flat_map(|signs| {
                    [200.0, 124.7].into_iter().flat_map(move |per_period| {
                        [0.0, 0.27, 0.6].map(|from| (signs, per_period, from))
                    })
                })
                .collect();
            let left = each.into_par_iter().map(|(signs, per_period, from)| {
                let signals = at_the_end(&spec.sensor, signs, beta);
                let mut bench = Bench::new(&spec, u64::from(signs));
                for k in 0..(PERIODS as f64 * per_period) as u32 {
                    bench.step(signals(TAU * (from + f64::from(k) / per_period)));
                }
                assert!(bench.chip.state.locked, "{method:?} {parameters}: {signs}");
                rms(&bench.miscalibration(&signals))
            });
            let worst = 1e3 * left.reduce(|| 0.0, f64::max);
            println!("{method:?}, {parameters} parameters: {worst:.3} mrad");
            assert!(worst < 1.0, "{method:?}, {parameters}: {worst} mrad");
            reached.push(format!("{worst:.1}"));
        }
    }
    figure(
        "every ellipse at the ends of the optical design's promise, 200 periods from power-up, eight and nine parameters by the sum of squares and by batches: largest miscalibration, mrad rms",
        &reached.join("; "),
        "model/tests/on_line_promised.rs",
    );
}
