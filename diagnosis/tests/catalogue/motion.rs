//! Real motion, which is named as what it is.

use std::f64::consts::TAU;

use crate::harness::{Case, PERIODS, PLAIN, REVOLVING, alone, finds, near, within_errors};

#[test]
fn vibration_and_cogging() {
    let found = finds(
        "vibration",
        &Case {
            motion: |t, _| 0.002 * (TAU * 1234.0 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "amplitude", 0.002);
    assert_eq!(
        serde_json::to_value(found.findings[0].chip).expect("a word"),
        "is not a sensor error"
    );
    finds(
        "cogging",
        &Case {
            motion: |_, a| 0.004 * (61.0 * a / PERIODS).sin(),
            ..REVOLVING
        },
    );
}

#[test]
fn large() {
    let found = alone(
        "vibration",
        &Case {
            motion: |t, _| 0.1 * (TAU * 1234.5 * t).sin(),
            ..PLAIN
        },
    );
    within_errors(&found, "amplitude", 0.1);
}
