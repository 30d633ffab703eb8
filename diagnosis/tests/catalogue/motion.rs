//! Real motion, which is named as what it is.

use std::f64::consts::TAU;

use nonius_diagnosis::Cause;

use crate::harness::{
    Case, PERIODS, PLAIN, REVOLVING, alone, diagnosed, finds, finds_beside, names, near,
    within_errors,
};

#[test]
fn vibration_and_cogging() {
    let found = finds(
        Cause::Vibration,
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
        Cause::Cogging,
        &Case {
            motion: |_, a| 0.004 * (61.0 * a / PERIODS).sin(),
            ..REVOLVING
        },
    );
}

/// An axis that shakes: its structure's mode, driven at many frequencies from far below it to above, radians.
pub(crate) fn rumble(t: f64) -> f64 {
    /// Closer to each other than what a recording tells apart.
    const LINES: u32 = 1000;
    const MODE: f64 = 900.0;
    const QUALITY: f64 = 4.0;
    (1..=LINES)
        .map(|i| {
            let i = f64::from(i);
            let hertz = 2.0 * i + 0.9 * (7.3 * i).sin();
            let x = hertz / MODE;
            let size = ((1.0 - x * x).powi(2) + (x / QUALITY).powi(2))
                .sqrt()
                .recip();
            1.5e-4 * size * (TAU * hertz * t + 1.7 * i * i).sin()
        })
        .sum()
}

#[test]
fn beside_a_rumble() {
    let found = finds(
        Cause::Cogging,
        &Case {
            motion: |t, a| rumble(t) + 0.01 * (5.0 * a / PERIODS).sin(),
            ..REVOLVING
        },
    );
    near(&found, "amplitude", 0.01);
    let found = finds(
        Cause::Vibration,
        &Case {
            motion: |t, _| rumble(t) + 0.004 * (TAU * 431.0 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 431.0);
    let found = finds(
        Cause::Interference,
        &Case {
            motion: |t, _| rumble(t),
            channels: |c, s, t, _, _| (c + 6e-4 * (TAU * 700.0 * t).sin(), s),
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 700.0);
}

/// An axis that starts and stops four times, each within 20 ms, radians.
fn stop_and_go(t: f64) -> f64 {
    const CYCLE: f64 = 0.1;
    const RUNS: f64 = 0.05;
    const STARTS: f64 = 0.02;
    const SPEED: f64 = TAU * 300.0;
    // Distance over top speed in a start, whose speed rises by 3 x² - 2 x³.
    let rising = |t: f64| {
        let x = (t / STARTS).clamp(0.0, 1.0);
        STARTS * (x.powi(3) - 0.5 * x.powi(4)) + (t - STARTS).max(0.0)
    };
    let (cycles, t) = ((t / CYCLE).floor(), t % CYCLE);
    SPEED * (cycles * RUNS + rising(t) - rising(t - RUNS))
}

/// Corners need knots so close that they would follow a vibration: it shows between them.
#[test]
fn beside_the_corners_of_a_drive() {
    let found = finds(
        Cause::Vibration,
        &Case {
            motion: |t, drive| stop_and_go(t) - drive + 0.01 * (TAU * 309.0 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 309.0);
    near(&found, "amplitude", 0.01);
    let corners_alone = Case {
        motion: |t, drive| stop_and_go(t) - drive,
        ..PLAIN
    };
    let found = diagnosed(&corners_alone, 5);
    assert!(found.findings.is_empty(), "{:?}", found.findings);
}

/// Where hardly anything but a slow vibration needs close knots, it is looked for with wider ones, corners or not.
#[test]
fn a_slow_vibration_alone() {
    let found = finds(
        Cause::Vibration,
        &Case {
            motion: |t, drive| 30.0 * TAU * t - drive + 0.05 * (TAU * 47.0 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 47.0);
}

/// Knots that follow an axis that shakes follow what is slower than the shaking, too: it stands out of the spectrum, or of the
/// orders of the revolution, where wider knots are looked at.
#[test]
fn slow_motion_beside_a_rumble() {
    let found = finds(
        Cause::Vibration,
        &Case {
            motion: |t, _| rumble(t) + 0.008 * (TAU * 171.0 * t).sin(),
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 171.0);
    let found = finds(
        Cause::Cogging,
        &Case {
            motion: |t, a| rumble(t) + 0.012 * (3.0 * a / PERIODS).sin(),
            ..REVOLVING
        },
    );
    near(&found, "order", 3.0);
    let shaking = Case {
        motion: |t, _| rumble(t),
        ..REVOLVING
    };
    let found = diagnosed(&shaking, 5);
    assert!(found.findings.is_empty(), "{:?}", found.findings);
}

/// What a drive that swings leaves at its own frequency is no vibration between corners.
#[test]
fn a_drive_that_swings() {
    let followed = Case {
        motion: |t, drive| 15.0 * TAU * (TAU * 25.0 * t + 0.3).sin() + 12.0 * TAU * t - drive,
        ..PLAIN
    };
    let found = diagnosed(&followed, 5);
    assert!(found.findings.is_empty(), "{:?}", found.findings);
}

/// One that swings faster than the knots follow is named for what it is: a real motion of the axis, to its last digit.
#[test]
fn a_drive_that_swings_fast() {
    let found = finds(
        Cause::Vibration,
        &Case {
            motion: |t, drive| 9.0 * TAU * (TAU * 40.0 * t + 0.3).sin() + 12.0 * TAU * t - drive,
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 40.0);
    near(&found, "amplitude", 9.0 * TAU);
}

/// A reference without noise shows how the axis moves to the last digit, and what is in that is no noise.
#[test]
fn beside_a_reference() {
    let found = finds(
        Cause::Cogging,
        &Case {
            motion: |_, a| 0.002 * (13.0 * a / PERIODS).sin(),
            reference: true,
            ..REVOLVING
        },
    );
    near(&found, "amplitude", 0.002);
}

/// Beside an axis that shakes a reference shows a vibration by itself, where the shaking is the higher of the two.
#[test]
fn beside_a_reference_and_a_rumble() {
    let found = finds(
        Cause::Vibration,
        &Case {
            motion: |t, _| rumble(t) + 0.0015 * (TAU * 2431.0 * t).sin(),
            reference: true,
            ..PLAIN
        },
    );
    near(&found, "frequency_hz", 2431.0);
    near(&found, "amplitude", 0.0015);
}

/// What is large beside it is taken off the signals, and not off the reference.
#[test]
fn beside_a_reference_and_a_large_error() {
    let found = diagnosed(
        &Case {
            motion: |_, a| 0.002 * (13.0 * a / PERIODS).sin(),
            channels: |c, s, _, _, _| (c + 0.2 * c * c, s),
            reference: true,
            ..REVOLVING
        },
        3,
    );
    assert_eq!(names(&found), [Cause::EvenNonlinearity, Cause::Cogging]);
}

#[test]
fn large() {
    let found = alone(
        Cause::Vibration,
        &Case {
            motion: |t, _| 0.1 * (TAU * 1234.5 * t).sin(),
            ..PLAIN
        },
    );
    within_errors(&found, "amplitude", 0.1);
}

/// Cogging that goes with the scale period as well: an error of the sensor would show in the radius, too. Of one order of the period
/// it may be a harmonic of the same size in both channels, which is said.
#[test]
fn cogging_at_orders_of_the_scale_period() {
    let motions: [fn(f64, f64) -> f64; 3] = [
        |_, alpha| 0.004 * alpha.sin(),
        |_, alpha| 0.004 * (2.0 * alpha).sin(),
        |_, alpha| 0.004 * (3.0 * alpha).sin(),
    ];
    for reference in [false, true] {
        for motion in motions {
            let found = finds(
                Cause::Cogging,
                &Case {
                    motion,
                    reference,
                    ..REVOLVING
                },
            );
            assert_eq!(found.findings[0].cause, Cause::Cogging);
        }
    }
}

/// Bends that make up for each other in the radius are motion of two orders of the period to anybody who sees no more than that
/// of them; and so they are on an axis that shakes.
#[test]
fn bends_that_the_radius_does_not_show() {
    let found = finds_beside(
        Cause::OddNonlinearity,
        Cause::Cogging,
        &Case {
            motion: |t, _| rumble(t),
            channels: |c, s, _, _, _| (c + 0.003 * c.powi(3), s - 0.003 * s.powi(3)),
            ..REVOLVING
        },
    );
    let first = &found.findings[0];
    assert!(!first.evidence.contains("is real"), "{}", first.evidence);
}

/// Knots make a vibration slower than half their frequency look like one at their frequency less its own, and the other way
/// round. Whatever the knots of this recording are, some of these stand on either side of the half.
#[test]
fn at_its_own_frequency_and_not_at_its_mirror() {
    type Motion = fn(t: f64, alpha: f64) -> f64;
    let motions: [(f64, Motion); 5] = [
        (190.0, |t, _| 0.0008 * (TAU * 190.0 * t).sin()),
        (225.0, |t, _| 0.0008 * (TAU * 225.0 * t).sin()),
        (265.0, |t, _| 0.0008 * (TAU * 265.0 * t).sin()),
        (310.0, |t, _| 0.0008 * (TAU * 310.0 * t).sin()),
        (365.0, |t, _| 0.0008 * (TAU * 365.0 * t).sin()),
    ];
    for (hertz, motion) in motions {
        let found = finds(Cause::Vibration, &Case { motion, ..PLAIN });
        near(&found, "frequency_hz", hertz);
    }
}
