//! The sine table and its interpolation, proven: every phase that the sine unit can be given is tried.
//!
//! The table is kept in docs/sine.md; NONIUS_BLESS=1 writes it anew.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use crate::shipped;
use nonius_model::design::Design;
use nonius_package::sine_error;

const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius-package sine::";

/// What the roundings and the straight line can do together, as fractions of the amplitude.
fn bound(design: &Design) -> f64 {
    let half_bit = |fraction: u32| 0.5f64.powi(fraction as i32 + 1);
    let table = &design.structure.sine;
    let [value, slope] = [0, 1].map(|column| table.columns[column].format.fraction);
    let half_segment = 0.5f64.powi(design.words.sine_rows_log2 as i32 + 3);
    // The parabola between table and arc, its mean taken out at the ends: half of what it is there.
    let arc = (TAU * half_segment).powi(2) / 4.0;
    half_bit(design.words.signal_fraction) + half_bit(value) + half_bit(slope) * half_segment + arc
}

#[test]
fn no_phase_is_beyond_the_bound() {
    let mut page = format!(
        "# The sine table\n\n\
         Written by `{HOW}`; do not edit. Every phase of the sine unit is\n\
         tried; a phase stands for the middle of what it cuts off. Bound: half bits of table, slope and result, and the\n\
         parabola that the straight line leaves out.\n\n\
         | design | rows | phases tried | sine and cosine, largest error | bound | angle, largest error, turns |\n\
         |---|---|---|---|---|---|\n",
    );
    for name in shipped::NAMES {
        let design = shipped::design(name);
        let (found, bound) = (sine_error(&design), bound(&design));
        writeln!(
            page,
            "| {name} | {} | {} | {:.2e} | {bound:.2e} | {:.2e} |",
            design.structure.sine.rows(),
            found.phases,
            found.largest,
            found.largest_angle_turns
        )
        .expect("text");
        assert!(found.exhaustive, "{name}: {found:?}");
        assert_eq!(found.phases, 1 << design.words.sine_phase_bits, "{name}");
        assert!(found.largest <= bound, "{name}: {found:?}, {bound:e}");
        // Both errors at their largest, across the radius.
        let turns = bound * 2f64.sqrt() / TAU;
        assert!(
            found.largest_angle_turns <= turns,
            "{name}: {found:?}, {turns:e}"
        );
        // The bound says something.
        assert!(found.largest > bound / 3.0, "{name}: {found:?}, {bound:e}");
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/sine.md");
    nonius_kept::same(Path::new(file), &page, HOW);
}
