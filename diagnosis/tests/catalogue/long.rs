//! Long recordings: what is large is found in a part of the samples first, its numbers and what is small in all of them.

use std::f64::consts::TAU;

use nonius_diagnosis::Cause;

use crate::harness::{Case, PLAIN, long, names, of_cause};

#[test]
fn nothing() {
    let found = long(&PLAIN);
    assert!(names(&found).is_empty(), "{:?}", names(&found));
    let left = found.unexplained;
    assert!(!left.significant, "{}", left.signature);
}

/// A harmonic of a detection SNR of a thousand, a line of some ten, which a part of the samples does not show.
#[test]
fn large_and_small() {
    let found = long(&Case {
        channels: |c, s, t, a, _| {
            let hum = (TAU * 151.3 * t).cos();
            (
                c + 0.002 * (3.0 * a).cos() + 3e-5 * hum,
                s - 0.002 * (3.0 * a + 0.3).cos() + 2e-5 * hum,
            )
        },
        ..PLAIN
    });
    let left = &found.unexplained;
    assert_eq!(
        names(&found),
        [Cause::SpatialHarmonic, Cause::Interference],
        "{}",
        left.signature
    );
    assert!(!left.significant, "{}", left.signature);
    of_cause(&found, Cause::SpatialHarmonic, "amplitude_cos", 0.002);
    of_cause(&found, Cause::Interference, "frequency_hz", 151.3);
    of_cause(&found, Cause::Interference, "amplitude_cos", 3e-5);
}
