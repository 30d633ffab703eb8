//! Causes that change with time: lines and slow changes.

use std::f64::consts::TAU;

use nonius_diagnosis::Cause;

use crate::harness::{Case, PLAIN, alone, diagnosed, finds, names, near, within_errors};

#[test]
fn lines() {
    let found = finds(
        Cause::Interference,
        &Case {
            channels: |c, s, t, _, _| {
                (
                    c + 0.001 * (TAU * 150.0 * t).cos(),
                    s + 0.0015 * (TAU * 150.0 * t + 2.0).cos(),
                )
            },
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 150.0);
    near(&found, "amplitude_sin", 0.0015);
    let found = finds(
        Cause::AmplitudeRipple,
        &Case {
            channels: |c, s, t, _, _| {
                let m = 1.0 + 0.001 * (TAU * 333.0 * t).cos();
                (c * m, s * m)
            },
            ..PLAIN
        },
    );
    near(&found, "depth", 0.001);
}

#[test]
fn slow_changes() {
    finds(
        Cause::OffsetDrift,
        &Case {
            channels: |c, s, t, _, _| (c + 0.01 * t, s - 0.008 * t),
            ..PLAIN
        },
    );
    finds(
        Cause::GainDrift,
        &Case {
            channels: |c, s, t, _, _| (c * (1.0 + 0.01 * t), s * (1.0 - 0.006 * t)),
            ..PLAIN
        },
    );
}

/// A heater that goes on and off, to and fro by 3 °C, five times while the recording lasts.
fn heated(t: f64) -> f64 {
    40.0 + 6.0 * ((t / 0.08).rem_euclid(1.0) - 0.5).abs()
}

/// What follows the temperature is no polynomial of time, and says what drives it.
#[test]
fn drifts_with_temperature() {
    let offsets = Case {
        channels: |c, s, t, _, _| {
            let warmer = heated(t) - 41.5;
            (c + 0.0003 * warmer, s - 0.0002 * warmer)
        },
        temperature: Some(heated),
        ..PLAIN
    };
    let gains = Case {
        channels: |c, s, t, _, _| {
            let warmer = heated(t) - 41.5;
            (c * (1.0 + 0.0005 * warmer), s * (1.0 - 0.0003 * warmer))
        },
        temperature: Some(heated),
        ..PLAIN
    };
    // From one standard deviation below the mean to one above: twice 3 °C/√12.
    let change = 3f64.sqrt();
    for (name, case, per_degree) in [
        (Cause::OffsetDrift, offsets, 0.0003),
        (Cause::GainDrift, gains, 0.0005),
    ] {
        let found = finds(name, &case);
        within_errors(&found, "change_cos", per_degree * change);
        let said = &found.findings[0].evidence;
        assert!(said.contains("drift with temperature"), "{said}");
    }
}

/// A machine that warms up: a capacitor that is discharged looks the same, and says so. It is no high pass of which
/// nothing else is seen.
#[test]
fn warming_up_is_a_drift() {
    let slow = Case {
        channels: |c, s, t, _, _| (c + 0.01 * (-t / 0.6).exp(), s - 0.008 * (-t / 0.6).exp()),
        ..PLAIN
    };
    let fast = Case {
        channels: |c, s, t, _, _| (c + 0.01 * (-t / 0.15).exp(), s - 0.008 * (-t / 0.15).exp()),
        ..PLAIN
    };
    for case in [slow, fast] {
        let found = finds(Cause::OffsetDrift, &case);
        let first = &found.findings[0];
        assert_eq!(first.cause, Cause::OffsetDrift);
        assert_eq!(first.confounded_with, [Cause::AcCoupling]);
    }
}

/// A lamp that is switched on while it is recorded: when, and how fast it warms up.
#[test]
fn what_warms_up_from_some_moment_on_has_a_start() {
    let lamp = Case {
        channels: |c, s, t, _, _| {
            let gone = 1.0 - (-(t - 0.1).max(0.0) / 0.05).exp();
            (c * (1.0 + 0.004 * gone), s * (1.0 + 0.003 * gone))
        },
        ..PLAIN
    };
    let found = finds(Cause::GainDrift, &lamp);
    near(&found, "tau_s", 0.05);
    near(&found, "start_s", 0.1);
    near(&found, "change_cos", 0.004);
    near(&found, "change_sin", 0.003);
    let said = found.findings[0].named_evidence();
    assert!(said.contains("from 100.0 ms on"), "{said}");
}

/// A lamp on a dimmer whose frequency wanders: the highest of its crests is no line.
#[test]
fn a_line_that_wanders_has_no_name() {
    let lamp = Case {
        channels: |c, s, t, _, _| {
            let turns = 400.0 * (t + 0.15 * (10.0 * t).sin() / 10.0);
            let lit = f64::from((TAU * turns).sin() > 0.3);
            (c + 0.0006 * lit, s - 0.0005 * lit)
        },
        ..PLAIN
    };
    let found = diagnosed(&lamp, 7);
    assert_eq!(names(&found), []);
    assert!(found.unexplained.significant);
}

/// Two that are steady both have their names, however near each other and alike they are.
#[test]
fn two_lines_beside_each_other() {
    let mains = Case {
        channels: |c, s, t, _, _| {
            let both = 0.005 * ((TAU * 311.3 * t).cos() + (TAU * 348.7 * t).cos());
            (c + both, s - 0.8 * both)
        },
        ..PLAIN
    };
    let found = diagnosed(&mains, 7);
    assert_eq!(
        names(&found),
        [Cause::Interference; 2],
        "{}",
        found.unexplained.signature
    );
    assert!(
        !found.unexplained.significant,
        "{}",
        found.unexplained.signature
    );
}

/// What goes to and fro less than four times is no line, whatever it is, and does not hide one.
#[test]
fn hum_beside_a_slow_wave() {
    let case = Case {
        channels: |c, s, t, _, _| {
            let slow = 0.001 * (TAU * 7.0 * t + 1.0).cos();
            let hum = 0.002 * (TAU * 350.0 * t).cos();
            (c + slow + hum, s - 0.5 * slow)
        },
        ..PLAIN
    };
    let found = diagnosed(&case, 7);
    let lines = found
        .findings
        .iter()
        .filter(|f| f.cause == Cause::Interference);
    let hertz: Vec<f64> = lines.filter_map(|f| f.parameter("frequency_hz")).collect();
    let hum = |hertz: &f64| (hertz - 350.0).abs() < 1.0;
    assert!(hertz.len() == 1 && hertz.iter().all(hum), "{hertz:?}");
}

#[test]
fn large() {
    let found = alone(
        Cause::Interference,
        &Case {
            channels: |c, s, t, _, _| {
                (
                    c + 0.05 * (TAU * 151.3 * t).cos(),
                    s + 0.04 * (TAU * 151.3 * t + 2.0).cos(),
                )
            },
            ..PLAIN
        },
    );
    within_errors(&found, "frequency_hz", 151.3);
    within_errors(&found, "amplitude_sin", 0.04);
    let found = alone(
        Cause::AmplitudeRipple,
        &Case {
            channels: |c, s, t, _, _| {
                let m = 1.0 + 0.06 * (TAU * 333.3 * t).cos();
                (c * m, s * m)
            },
            ..PLAIN
        },
    );
    within_errors(&found, "depth", 0.06);
    alone(
        Cause::OffsetDrift,
        &Case {
            channels: |c, s, t, _, _| (c + 0.15 * t, s - 0.1 * t),
            ..PLAIN
        },
    );
    alone(
        Cause::GainDrift,
        &Case {
            channels: |c, s, t, _, _| (c * (1.0 + 0.2 * t), s * (1.0 - 0.15 * t)),
            ..PLAIN
        },
    );
}
