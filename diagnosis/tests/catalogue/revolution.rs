//! Causes that repeat with the revolution.

use std::f64::consts::TAU;

use crate::harness::{Case, PERIODS, REVOLVING, alone, finds, near, within_errors};

/// An amplitude with a dip at one place of the revolution, radians, of that depth and width.
fn dipped(alpha: f64, depth: f64, width: f64) -> f64 {
    let off = (alpha / PERIODS - 1.0 + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
    1.0 - depth * (-0.5 * (off / width).powi(2)).exp()
}

#[test]
fn run_out_and_dirt() {
    let found = finds(
        "runout",
        &Case {
            channels: |c, s, _, a, _| {
                let m = 1.0 + 0.002 * (a / PERIODS + 0.5).cos();
                (c * m, s * m)
            },
            ..REVOLVING
        },
    );
    near(&found, "depth", 0.002);
    finds(
        "contamination",
        &Case {
            channels: |c, s, _, a, _| {
                let m = dipped(a, 0.01, 0.08);
                (c * m, s * m)
            },
            ..REVOLVING
        },
    );
}

#[test]
fn graduation() {
    let found = finds(
        "graduation_error",
        &Case {
            seen: |a, _| {
                let e = a + 0.003 * (3.0 * a / PERIODS).cos();
                (e, e)
            },
            reference: true,
            ..REVOLVING
        },
    );
    near(&found, "amplitude", 0.003);
    let gain = found.findings[0].gain;
    let before = gain.position_error_rms_before_rad.expect("a reference");
    let after = gain.position_error_rms_after_rad.expect("a reference");
    assert!(after < 0.6 * before, "{before} → {after}");
}

#[test]
fn large() {
    let found = alone(
        "runout",
        &Case {
            channels: |c, s, _, a, _| {
                let m = 1.0 + 0.05 * (a / PERIODS + 0.5).cos();
                (c * m, s * m)
            },
            ..REVOLVING
        },
    );
    within_errors(&found, "depth", 0.05);
    let found = alone(
        "contamination",
        &Case {
            channels: |c, s, _, a, _| {
                let m = dipped(a, 0.2, 0.1);
                (c * m, s * m)
            },
            ..REVOLVING
        },
    );
    // The place counts from where the recording begins, a whole number of periods off.
    let place = &found.findings[0].parameters[1];
    let period = TAU / PERIODS;
    let off = (place.value - 1.0 + period / 2.0).rem_euclid(period) - period / 2.0;
    assert!(off.abs() < 5.0 * place.std_error, "{off}");
    within_errors(&found, "width", 0.1);
}
