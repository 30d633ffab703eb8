//! Every row of the catalogue, hidden in simulated data and found: near what can be seen, and far above the noise.
//!
//! The simulation is direct: continuous motion, the effect as physics has it, noise, ADC. It shares no code with the
//! diagnosis. Noise with a memory stands beside it, in `flicker.rs`.

mod data;
mod harness;
mod lengths;
mod long;
mod motion;
mod revolution;
mod speed;
mod statics;
mod time;

use harness::{Case, PLAIN, diagnosed, finds_nothing};

#[test]
fn nothing_is_found_where_nothing_is_hidden() {
    for seed in 0..6 {
        for (reference, revolution) in [(false, false), (true, true)] {
            let case = Case {
                reference,
                revolution,
                ..PLAIN
            };
            finds_nothing(&case, seed);
        }
    }
}

/// A shape that the library does not hold is not given a name.
#[test]
fn strangers_stay_unnamed() {
    let case = Case {
        channels: |c, s, _, a, v| {
            let odd = 0.01 * (a * 1.5).sin().abs().powi(3) * (v / 3000.0).abs().sqrt();
            (c + odd, s)
        },
        ..PLAIN
    };
    let found = diagnosed(&case, 5);
    assert!(found.unexplained.significant);
    assert!(!found.unexplained.signature.is_empty());
}
