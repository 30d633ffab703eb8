//! Single faults in what a period of travel may teach.

use super::edit::{Fault, swap};

/// Faults in the dropping of periods in which the loop caught up.
pub(crate) fn dropping_faults() -> Vec<Fault> {
    vec![
        swap(
            "every period is dropped",
            &["wire period_dropped"],
            " & period_has_hole",
            "",
        ),
        swap(
            "a period is dropped before it ends",
            &["wire period_dropped"],
            "travel_clear & ",
            "",
        ),
        swap(
            "a period that is dropped counts for a gear",
            &["wire period_kept ="],
            " & not_period_dropped",
            "",
        ),
        swap(
            "a period is dropped for a stop in its last sample only",
            &["wire period_has_hole"],
            "astray_and_not_astray_long | ",
            "",
        ),
    ]
}

/// Faults in the resting of bends.
pub(crate) fn resting_faults() -> Vec<Fault> {
    vec![
        swap(
            "bends learn at every speed",
            &["wire bends_due_now ="],
            " & bends_shown",
            "",
        ),
        swap(
            "the completion learns at every speed",
            &["wire bends_free_now ="],
            " & bends_shown",
            "",
        ),
        swap(
            "offsets are told from bends that rest",
            &["[17:0] half_cos_2_shown_now ="],
            "bends_shown ? half_cos_2 : 18'sd0",
            "half_cos_2",
        ),
        swap(
            "bends rest backwards only",
            &["wire bends_shown_now ="],
            "($signed(rate[25:20]) < 6'sh11) & ",
            "",
        ),
    ]
}

/// Faults in the resting of bends that are searched by sums of squares.
pub(crate) fn first_gear_faults() -> Vec<Fault> {
    vec![
        swap(
            "bends learn from the first gear on",
            &["wire bends_taught_now ="],
            " & not_bends_rest_now",
            "",
        ),
        swap(
            "a gear ends calm in which bends rest",
            &["wire gear_ends_calm ="],
            " & not_bends_rest",
            "",
        ),
    ]
}
