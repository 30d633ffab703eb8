//! What stands beside codes that err: larger than their error it has its name, and what their error looks like has none.

use nonius_diagnosis::Cause;

use crate::codes::{PLAIN, Seen, diagnosed, reversing};
use crate::data::on_steps;
use crate::harness::{damaged, names};
use crate::speed::JITTERING;

/// Noise of the clock that is larger than what coarse steps leave is seen beside them.
#[test]
fn jitter_beside_coarse_steps() {
    let found = damaged(&JITTERING, |rows| on_steps(rows, 8, None));
    let steps = Cause::CoarseQuantisation;
    assert_eq!(names(&found), [steps, steps, Cause::ClockJitter]);
}

/// A converter with a heavy bit that bends as well: the bend may be the converter's, and nothing tells.
#[test]
fn a_bend_beside_a_heavy_bit_may_be_the_converters() {
    let bent = Seen {
        periods: |t| 3.0 * reversing(t),
        code: |code, which| {
            let share = code as f64 / 8192.0;
            let bend = (45.0 * share * share * share).round() as i64;
            code + bend
                + if which == 0 {
                    14 * ((code >> 12) & 1)
                } else {
                    0
                }
        },
        ..PLAIN
    };
    let found = diagnosed(&bent, 2);
    let bend = (found.findings.iter()).find(|f| f.cause == Cause::OddNonlinearity);
    let bend = bend.unwrap_or_else(|| panic!("{:?}", names(&found)));
    assert_eq!(bend.confounded_with, [Cause::AdcNonlinearity]);
    assert!(names(&found).contains(&Cause::AdcNonlinearity));
}
