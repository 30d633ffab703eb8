//! Causes that repeat with the revolution.

use std::f64::consts::TAU;

use crate::harness::{
    Case, PERIODS, REVOLVING, alone, diagnosed, finds, names, near, within_errors,
};

/// The amplitude of both channels changes once a revolution, by a depth of so many per mille.
fn eccentric<const PER_MILLE: u32>() -> Case {
    Case {
        channels: |c, s, _, a, _| {
            let m = 1.0 + f64::from(PER_MILLE) * 1e-3 * (a / PERIODS + 0.5).cos();
            (c * m, s * m)
        },
        ..REVOLVING
    }
}

/// The amplitude of both channels dips at one place of the revolution, by so many per mille, over so many milliradians.
fn dirty<const DEPTH: u32, const WIDTH: u32>() -> Case {
    Case {
        channels: |c, s, _, a, _| {
            let off = (a / PERIODS - 1.0 + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            let [depth, width] = [DEPTH, WIDTH].map(|v| f64::from(v) * 1e-3);
            let m = 1.0 - depth * (-0.5 * (off / width).powi(2)).exp();
            (c * m, s * m)
        },
        ..REVOLVING
    }
}

#[test]
fn run_out_and_dirt() {
    let found = finds("runout", &eccentric::<2>());
    near(&found, "depth", 0.002);
    finds("contamination", &dirty::<10, 80>());
}

/// An error of the graduation, three times a revolution.
fn graduated(reference: bool) -> Case {
    Case {
        seen: |a, _| {
            let e = a + 0.003 * (3.0 * a / PERIODS).cos();
            (e, e)
        },
        reference,
        ..REVOLVING
    }
}

#[test]
fn graduation() {
    let found = finds("graduation_error", &graduated(true));
    near(&found, "amplitude", 0.003);
    let gain = found.findings[0].gain;
    let before = gain.position_error_rms_before_rad.expect("a reference");
    let after = gain.position_error_rms_after_rad.expect("a reference");
    assert!(after < 0.6 * before, "{before} → {after}");
}

/// Without a reference an error of the graduation is motion: it may be called cogging, which moves the axis, and nothing of the sensor.
#[test]
fn no_graduation_without_a_reference() {
    let found = diagnosed(&graduated(false), 7);
    let names = names(&found);
    assert!(names.iter().all(|name| *name == "cogging"), "{names:?}");
}

#[test]
fn large() {
    let found = alone("runout", &eccentric::<50>());
    within_errors(&found, "depth", 0.05);
    let found = alone("contamination", &dirty::<200, 100>());
    // The place counts from where the recording begins, a whole number of periods off.
    let place = &found.findings[0].parameters[1];
    let period = TAU / PERIODS;
    let off = (place.value - 1.0 + period / 2.0).rem_euclid(period) - period / 2.0;
    assert!(off.abs() < 5.0 * place.std_error, "{off}");
    within_errors(&found, "width", 0.1);
}
