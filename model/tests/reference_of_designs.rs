//! The reference that a `design.toml` makes.

use crate::reference_support::{MISCALIBRATED, Noise, miscalibration, order, wrapped};
use crate::support::shipped::variants::searches_of;
use nonius_model::reference::{Reference, Sensor, from_spec};

/// The reference of a shipped design runs on its signals: it locks, calibrates, and follows to the noise.
#[test]
fn a_design_makes_a_reference() {
    let spec = crate::support::optical();
    let normalise = from_spec::Normalise::of(&spec);
    let mut reference =
        Reference::new(from_spec::config(&spec).expect("a design that the paper knows"))
            .expect("a configuration that works");
    let mut noise = Noise::new(9, spec.sensor.noise_rms);
    let mut largest = 0.0f64;
    for k in 0..60_000 {
        let alpha = 0.04 * f64::from(k);
        let (y, n) = (MISCALIBRATED.signals(alpha), noise.pair());
        let volts = [0, 1].map(|i| spec.sensor.amplitude * (y[i] + n[i]));
        let seen = reference.step(normalise.y(volts[0]), normalise.y(volts[1]));
        if k >= 50_000 {
            assert!(seen.locked);
            largest = largest.max(wrapped(seen.alpha_hat - alpha).abs());
        }
    }
    println!(
        "largest angle error of the optical design's reference: {:.2} mrad",
        1e3 * largest
    );
    assert!(largest < 5.0 * spec.sensor.noise_rms, "{largest}");
    let mut impossible = spec;
    impossible.tracking.method = 2;
    assert!(from_spec::config(&impossible).is_err());
    impossible.tracking.method = 3;
    impossible.calibration.parameters = 7;
    assert!(from_spec::config(&impossible).is_err());
}

/// Whatever search and set a design can be built with, its reference finds a sensor that the set can express: offsets,
/// gains, phase, and for eight and nine parameters cubic bends, which are found where the design completes and stand where it does not.
#[test]
fn every_search_of_a_design_makes_a_reference() {
    for variant in searches_of(&crate::support::optical()) {
        let spec = &variant.spec;
        let config = from_spec::config(spec).expect("a design that the paper knows");
        let set = config.parameters;
        let sensor = Sensor {
            beta: set.phase().map_or(0.0, |_| MISCALIBRATED.beta),
            ..MISCALIBRATED
        };
        let bend = if spec.calibration.has_bend() {
            0.02
        } else {
            0.0
        };
        let signals = |alpha: f64| {
            let bent = |y: f64, a: f64, b: f64, third: f64| {
                let u = (y - b) / a;
                a * (u + third * u.powi(3)) + b
            };
            let [c, s] = sensor.signals(alpha);
            [
                bent(c, sensor.a_c, sensor.b_c, bend),
                bent(s, sensor.a_s, sensor.b_s, -bend),
            ]
        };
        let mut reference = Reference::new(config).expect("a configuration that works");
        let mut noise = Noise::new(9, spec.sensor.noise_rms);
        // A step of the batch for each 64 samples, and with bends of a quarter of Newton's at first: it takes longer.
        let samples = match (spec.calibration.is_batch(), bend > 0.0) {
            (true, true) => 450_000,
            _ => 150_000,
        };
        for k in 0..samples {
            let (y, n) = (signals(0.04 * f64::from(k)), noise.pair());
            reference.step(y[0] + n[0], y[1] + n[1]);
        }
        let left = miscalibration(set, reference.theta(), signals).0;
        let of_two = order(set, reference.theta(), signals, 2);
        let name = format!(
            "{}, {} parameters",
            variant.what, spec.calibration.parameters
        );
        println!(
            "{name}: {:.3} mrad rms are left, order 2 {:.3}",
            1e3 * left,
            1e3 * of_two
        );
        if spec.calibration.has_bend() && spec.calibration.completed().is_none() {
            assert!(of_two > 5e-3, "{name}: {of_two}");
        } else {
            assert!(left < 0.3e-3, "{name}: {left}");
        }
    }
}
