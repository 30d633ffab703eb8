//! Causes in the data: samples that are off, lost or doubled, and noise with the signal.

use crate::harness::{Case, NOISE, PLAIN, finds, near, shows};

#[test]
fn samples() {
    shows("glitches", |rows| {
        for k in [500, 4321, 9000, 15_000] {
            rows[k][1] += 0.2;
        }
    });
    shows("dropped_samples", |rows| {
        for k in [15_000, 9000, 4321, 500] {
            rows.remove(k);
        }
    });
    shows("repeated_samples", |rows| {
        for k in [500, 4321, 9000, 12_000, 15_000, 17_000] {
            let before = rows[k - 1];
            rows[k][1] = before[1];
            rows[k][2] = before[2];
        }
    });
}

#[test]
fn noise_with_the_signal() {
    let found = finds(
        "amplitude_noise",
        &Case {
            noise: |u, _, _, n| NOISE * n[0] + 0.002 * u * n[1],
            ..PLAIN
        },
    );
    near(&found, "rms", 0.002);
}
