//! Every row of the catalogue, hidden in simulated data and found: near what can be seen, and far above the noise.
//!
//! The simulation is direct: continuous motion, the effect as physics has it, noise, ADC. It shares no code with the
//! diagnosis. Noise with a memory stands beside it, in `flicker.rs`.

mod beside_codes;
mod codes;
mod data;
mod harness;
mod instrument;
mod instruments;
mod lengths;
mod long;
mod motion;
mod no_signal;
mod reference;
mod revolution;
mod speed;
mod statics;
mod time;
mod words;

use harness::{Case, PLAIN, arc, damaged, diagnosed, finds_nothing, names};

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

/// A short arc says little, and the error bars of the five parameters say how little.
#[test]
fn error_bars_of_the_simulation_hold_on_an_arc() {
    let mut squares = 0.0;
    for seed in 0..12 {
        let (found, truth) = arc(0.6, seed);
        let all = found.simulation.causes.iter().flat_map(|c| &c.parameters);
        for (name, truth) in ["b_s", "a_c"].into_iter().zip(truth) {
            let p = all.clone().find(|p| p.name == name);
            let p = p.expect("a parameter of that name");
            squares += ((p.value - truth) / p.std_error).powi(2) / 24.0;
        }
    }
    assert!((0.4..2.5).contains(&squares), "{squares}");
}

/// Bursts of some samples are no glitches and no noise.
#[test]
fn bursts_are_unexplained() {
    for wide in nonius_kept::every(3, [2, 3, 8]) {
        let found = damaged(&PLAIN, |rows| {
            for k in (100..19_000).step_by(630) {
                for row in &mut rows[k..k + wide] {
                    row[1] += 0.03;
                }
            }
        });
        let left = &found.unexplained;
        assert!(left.significant, "{wide}: {:?}", names(&found));
    }
}
