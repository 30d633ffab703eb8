//! What stands beside codes that err: larger than their error it has its name, and what their error looks like has none.

use nonius_diagnosis::Cause;

use crate::codes::{PLAIN, Seen, diagnosed, reversing};
use crate::harness::{NOISE, PLAIN as SENSOR, damaged, names};
use crate::{data, harness};

/// A bit that never changes steps just before a channel turns round, which looks like a flat top.
#[test]
fn a_stuck_bit_is_no_saturation() {
    for amplitude in [0.79, 0.7925, 0.795, 0.7975, 0.8] {
        let stuck = Seen {
            bits: 16,
            amplitudes: [0.75, amplitude],
            noise: 0.0035,
            periods: |t| 3.0 * reversing(t),
            code: |code, which| if which == 1 { code & !(1 << 8) } else { code },
            ..PLAIN
        };
        let found = diagnosed(&stuck, 1);
        assert_eq!(names(&found), [Cause::StuckBit], "{amplitude}");
    }
}

/// Noise of the clock that is larger than what coarse steps leave is seen beside them.
#[test]
fn jitter_beside_coarse_steps() {
    let jitter = harness::Case {
        noise: |_, slope, v, n| NOISE * n[0] + slope * v * 6e-7 * n[1],
        ..SENSOR
    };
    let found = damaged(&jitter, |rows| data::on_steps(rows, 8, None));
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
    let bend = found
        .findings
        .iter()
        .find(|f| f.cause == Cause::OddNonlinearity);
    let bend =
        bend.unwrap_or_else(|| panic!("{:?} {}", names(&found), found.unexplained.signature));
    assert_eq!(bend.confounded_with, [Cause::AdcNonlinearity]);
    assert!(names(&found).contains(&Cause::AdcNonlinearity));
}
