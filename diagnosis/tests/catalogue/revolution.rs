//! Causes that repeat with the revolution.

use std::f64::consts::TAU;

use nonius_diagnosis::Cause;

use crate::harness::{
    Case, NOISE, PERIODS, REVOLVING, alone, diagnosed, evenly, evenly_followed, finds, names, near,
    of_cause, within_errors,
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
    let found = finds(Cause::Runout, &eccentric::<2>());
    near(&found, "depth", 0.002);
    finds(Cause::Contamination, &dirty::<10, 80>());
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
    let found = finds(Cause::GraduationError, &graduated(true));
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
    assert!(
        names.iter().all(|name| *name == Cause::Cogging),
        "{names:?}"
    );
}

#[test]
fn large() {
    let found = alone(Cause::Runout, &eccentric::<50>());
    within_errors(&found, "depth", 0.05);
    let found = alone(Cause::Contamination, &dirty::<200, 100>());
    // The place counts from where the recording begins, a whole number of periods off.
    let place = &found.findings[0].parameters[1];
    let period = TAU / PERIODS;
    let off = (place.value - 1.0 + period / 2.0).rem_euclid(period) - period / 2.0;
    assert!(off.abs() < 5.0 * place.std_error, "{off}");
    within_errors(&found, "width", 0.1);
}

/// A graduation that is off once a revolution, run-out, and a second harmonic: the channels see the angle with the graduation's error, and
/// run-out is a gain of the harmonic, too. Nothing of what one does to another has a name of its own, and the positions are those of the
/// axis.
#[test]
fn what_repeats_with_the_revolution_stands_together() {
    let magnet = Case {
        seen: |a, _| {
            let seen = a + 0.06 * (a / PERIODS).cos();
            (seen, seen)
        },
        channels: |c, s, _, a, _| {
            let seen = a + 0.06 * (a / PERIODS).cos();
            let m = 1.0 + 0.04 * (a / PERIODS + 0.5).cos();
            (
                m * (c + 0.012 * (2.0 * seen + 0.4).cos()),
                m * (s + 0.008 * (2.0 * seen + 1.3).cos()),
            )
        },
        reference: true,
        ..REVOLVING
    };
    let check = |found: &nonius_diagnosis::Diagnosis| {
        let mut named = names(found);
        named.sort_unstable();
        let left = &found.unexplained.signature;
        assert_eq!(
            named,
            [
                Cause::SpatialHarmonic,
                Cause::Runout,
                Cause::GraduationError
            ],
            "{left}"
        );
        assert!(!found.unexplained.significant, "{left}");
        of_cause(found, Cause::GraduationError, "amplitude", 0.06);
        of_cause(found, Cause::Runout, "depth", 0.04);
        of_cause(found, Cause::SpatialHarmonic, "amplitude_cos", 0.012);
    };
    check(&diagnosed(&magnet, 7));
    let (found, off) = evenly_followed(&magnet, 130.0, 7);
    check(&found);
    assert!(off < 1.1 * NOISE, "{off}");
}

/// Dirt over one channel is none over both.
#[test]
fn dirt_over_one_channel() {
    let dirty = Case {
        channels: |c, s, _, a, _| {
            let off = (a / PERIODS - 1.0 + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
            (c * (1.0 - 0.05 * (-0.5 * (off / 0.3).powi(2)).exp()), s)
        },
        ..REVOLVING
    };
    for found in [diagnosed(&dirty, 7), evenly(&dirty, 300.0, 7)] {
        assert!(names(&found).is_empty(), "{:?}", names(&found));
        let left = &found.unexplained.signature;
        assert!(left.contains("repeats with the revolution"), "{left}");
    }
}

/// At one speed an offset that goes with the revolution, and a harmonic that nobody looks for, have a fixed frequency as interference has.
#[test]
fn a_line_where_orders_are_has_no_name() {
    let turning = Case {
        channels: |c, s, _, a, _| {
            let (sin, cos) = (a / PERIODS).sin_cos();
            (c + 0.01 * cos, s + 0.01 * sin)
        },
        ..REVOLVING
    };
    let ninth = Case {
        channels: |c, s, _, a, _| (c + 0.002 * (9.0 * a).cos(), s + 0.002 * (9.0 * a).sin()),
        ..REVOLVING
    };
    for (case, with) in [(turning, "with the revolution"), (ninth, "with the angle")] {
        let found = evenly(&case, 123.4, 7);
        assert!(names(&found).is_empty(), "{:?}", names(&found));
        let left = &found.unexplained.signature;
        assert!(left.contains(with), "{left}");
    }
}
