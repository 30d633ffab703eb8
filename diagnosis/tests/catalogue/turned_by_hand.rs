//! Scales that a hand turns over a few periods: what a harmonic does along the circle hardly shows beside the motion, and the fit must not ask
//! for any amount of it.

use std::f64::consts::TAU;

use nonius_diagnosis::Cause;

use crate::harness::names;
use crate::instrument::{Instrument, LENGTH, PLAIN};

/// From rest to rest, up and down in speed without a pattern and never back, over four periods and a half.
fn by_hand(t: f64) -> f64 {
    const WAVES: [(f64, f64); 5] = [
        (0.21, 0.4),
        (0.17, 2.9),
        (0.12, 5.1),
        (0.09, 1.3),
        (0.05, 3.7),
    ];
    let x = t / LENGTH;
    let rest = |x: f64| x * x * (3.0 - 2.0 * x);
    let x = rest(x);
    let wave = |((size, phase), k): (&(f64, f64), u8)| {
        let cycles = 1.3 * TAU * f64::from(k);
        size * ((cycles * x + phase).sin() - phase.sin()) / cycles
    };
    4.4 * TAU * (x + WAVES.iter().zip(1..).map(wave).sum::<f64>())
}

/// A third harmonic of 0.8 % is no bend of twenty times that size which the channels' gains make up for. Its order may be taken for the fifth:
/// the radius has no more of it.
#[test]
fn a_third_harmonic_is_no_absurd_bend() {
    let errors: [fn(f64) -> [f64; 2]; 2] = [
        |a| [0.008 * (3.0 * a + 2.2).cos(), 0.006 * (3.0 * a - 1.0).cos()],
        |a| [0.008 * (3.0 * a + 0.2).cos(), 0.005 * (3.0 * a + 4.0).cos()],
    ];
    for (seed, error) in (8..).zip(errors) {
        let turned = Instrument {
            axis: by_hand,
            error,
            bits: 12,
            noise: 2e-3,
            ..PLAIN
        };
        let recording = turned.recorded(seed);
        let found = turned.diagnosed_of(&recording);
        let first = &found.findings[0];
        assert!(
            matches!(first.cause, Cause::SpatialHarmonic | Cause::OddNonlinearity),
            "{:?}",
            names(&found)
        );
        for parameter in first.parameters.iter().filter(|p| p.unit == "amplitude") {
            assert!(parameter.value.abs() < 0.03, "{parameter:?}");
        }
    }
}
