//! A reference that does not follow the sensor, and one that does.

use std::f64::consts::{PI, TAU};

use crate::harness::{Case, NOISE, PERIODS, PLAIN, REVOLVING, damaged, names};

const WITH_REFERENCE: Case = Case {
    reference: true,
    ..PLAIN
};

/// What the reference says is another: the diagnosis is that without one, and says why in these words.
fn left_out(case: &Case, says: impl Fn(f64) -> f64, why: &str) {
    let found = damaged(case, |rows| rows.iter_mut().for_each(|r| r[3] = says(r[3])));
    assert_eq!(names(&found), [], "{why}");
    let left = &found.unexplained;
    assert!(!left.significant, "{why}: {}", left.signature);
    assert!(found.extended.residual_rms < 1.1 * NOISE, "{why}");
    assert_eq!(found.extended.position_error_rms_rad, None, "{why}");
    let said = found.notes.iter().any(|note| note.contains(why));
    assert!(said, "{why}: {:?}", found.notes);
}

#[test]
fn a_reference_that_does_not_follow_is_left_out() {
    let revolving = Case {
        reference: true,
        ..REVOLVING
    };
    left_out(&revolving, |r| r / PERIODS, "a revolution of 8 periods");
    left_out(&WITH_REFERENCE, |r| r / 5.0, "a revolution of 5 periods");
    left_out(&WITH_REFERENCE, f64::to_degrees, "in degrees");
    let wrapped = |r: f64| r.to_degrees().rem_euclid(360.0);
    left_out(&WITH_REFERENCE, wrapped, "in degrees");
    left_out(&WITH_REFERENCE, |r| r / TAU, "in periods");
    left_out(&WITH_REFERENCE, |_| 1.0, "does not change");
    left_out(&WITH_REFERENCE, |r| 0.991 * r, "0.90 % less");
    left_out(&WITH_REFERENCE, |r| (r * r).sin(), "nothing to do with");
}

/// Wrapped, the other way round, or off by some degrees that repeat: it follows.
#[test]
fn a_reference_that_follows_serves() {
    let used = |says: fn(f64) -> f64| {
        let found = damaged(&WITH_REFERENCE, |rows| {
            rows.iter_mut().for_each(|r| r[3] = says(r[3]));
        });
        let error = found.simulation.position_error_rms_rad;
        error.expect("a position error")
    };
    assert!(used(|r| r.rem_euclid(TAU)) < 2.0 * NOISE);
    assert!(used(|r| 2.0 - r) < 2.0 * NOISE);
    assert!(used(|r| (PI - r).rem_euclid(TAU)) < 2.0 * NOISE);
    let off = used(|r| r + 0.15 * (r / PERIODS).sin());
    assert!((0.09..0.12).contains(&off), "{off}");
}
