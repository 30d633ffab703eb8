//! Loss of signal and return in `f64`: the reference of a design holds its parameters as the chip does.

use std::f64::consts::TAU;

use crate::reference_support::{MISCALIBRATED, Noise, miscalibration};
use nonius_model::reference::{Reference, from_spec};
use nonius_model::spec::{CalibrationMethod, Spec};

/// Samples of a period of travel.
const PERIOD: u32 = 151;

/// Largest miscalibration, radians: over a hundred periods before the signal fades over `fade` samples, from then to the end, over
/// the last ten periods, and from when the signal is back on.
fn around(spec: &Spec, fade: u32) -> [f64; 4] {
    let config = from_spec::config(spec).expect("a design that the paper knows");
    let parameters = config.parameters;
    let mut reference = Reference::new(config).expect("there is one");
    let mut noise = Noise::new(5, spec.sensor.noise_rms);
    let (lost, back) = (300 * PERIOD, 300 * PERIOD + fade + 3000);
    let end = back + 150 * PERIOD;
    let mut worst = [0.0f64; 4];
    for k in 0..end {
        let left = match k {
            _ if k < lost || k >= back => 1.0,
            _ if k < lost + fade => 1.0 - f64::from(k - lost) / f64::from(fade),
            _ => 0.0,
        };
        let [c, s] = MISCALIBRATED.signals(TAU * f64::from(k) / f64::from(PERIOD));
        let [noise_c, noise_s] = noise.pair();
        let seen = reference.step(left * c + noise_c, left * s + noise_s);
        if k > lost - 100 * PERIOD && seen.updated {
            let signals = |alpha| MISCALIBRATED.signals(alpha);
            let now = miscalibration(parameters, reference.theta(), signals).1;
            let part = usize::from(k >= lost);
            worst[part] = worst[part].max(now);
            if k >= back {
                worst[3] = worst[3].max(now);
            }
            if k >= end - 10 * PERIOD {
                worst[2] = worst[2].max(now);
            }
        }
    }
    worst
}

#[test]
fn a_fading_signal_does_not_take_the_parameters_with_it() {
    for (method, parameters) in [
        (CalibrationMethod::Final, 5),
        (CalibrationMethod::Final, 9),
        (CalibrationMethod::Exact, 5),
        (CalibrationMethod::SumOfSquares, 5),
        (CalibrationMethod::Batch, 5),
    ] {
        let mut spec = crate::support::optical();
        spec.calibration.method = method;
        spec.calibration.parameters = parameters;
        for (periods, more) in [(0, 2e-4), (3, 5e-3), (10, 5e-3), (33, 5e-3)] {
            let [before, worst, end, _] = around(&spec, periods * PERIOD);
            println!(
                "{method:?}, {parameters}: faded over {periods} periods, {before:.1e} -> {worst:.1e} -> {end:.1e} rad"
            );
            assert!(
                worst < 1.5 * before + more && end < 2.0 * before,
                "{method:?}"
            );
        }
    }
}

#[test]
fn recalled_parameters_know_nothing_of_a_fade() {
    for (method, parameters) in [
        (CalibrationMethod::Final, 5),
        (CalibrationMethod::SumOfSquares, 5),
    ] {
        let mut spec = crate::support::optical();
        spec.calibration.method = method;
        spec.calibration.parameters = parameters;
        let left = |periods: u32, recall: bool| {
            let mut spec = spec.clone();
            spec.calibration.recall = Some(recall);
            let [before, _, _, after] = around(&spec, periods * PERIOD);
            println!(
                "{method:?}, {periods} periods, recall {recall}: {before:.1e} -> {after:.1e} rad"
            );
            after / before
        };
        let (followed, recalled) = (left(33, false), left(33, true));
        assert!(recalled < 1.5 && recalled < followed, "{method:?}");
        // Slower than the hold waits: followed as a change of the sensor. Without a signal the sum of squares goes astray until the
        // radius is too large: the reference, other than the chip, does not know that there is none.
        let (followed, recalled) = (left(100, false), left(100, true));
        let most = if method == CalibrationMethod::Final {
            1.5
        } else {
            followed / 10.0
        };
        assert!(recalled < most && followed > 100.0, "{method:?}");
    }
}
