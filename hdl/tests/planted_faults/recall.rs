//! Single faults in the recall, each of one place.

use super::edit::{Fault, swap};

/// Faults in the recall.
pub(crate) fn recall_faults() -> Vec<Fault> {
    vec![
        swap(
            "recall while the search follows a fade",
            &["wire proven_stand_now ="],
            " & not_fading_now",
            "",
        ),
        swap(
            "recall of what is recent",
            &["recall_any ? {proven_2"],
            "recall_any ? {proven_2",
            "recall_any ? {recent_2",
        ),
        swap(
            "recall where only the loop goes astray",
            &["wire held_in_doubt ="],
            " & signal_in_doubt",
            "",
        ),
        swap(
            "no recall where the radius is small",
            &["wire signal_in_doubt ="],
            " | not_present_anywhere",
            "",
        ),
        swap(
            "recall where the loop is a radian astray",
            &["wire present_anywhere ="],
            " | astray_present",
            "",
        ),
        swap(
            "recall where the estimate points away from the signal",
            &["wire astray_present ="],
            " | opposite_present",
            "",
        ),
        swap(
            "recall where the estimate is across the signal",
            &["wire astray_present ="],
            "across_present | ",
            "",
        ),
        swap(
            "no recall of the phase",
            &["recall_any ? {proven_5"],
            "recall_any ?",
            "1'b0 ?",
        ),
        swap(
            "nothing is remembered before anything is proven",
            &["wire remember_now ="],
            " | nothing_proven_yet",
            "",
        ),
        swap(
            "the search goes on at the last gamma's pace where the signal is back",
            &["wire restart_cause_now ="],
            " | rises_again",
            "",
        ),
        swap(
            "nominal parameters after a loss",
            &["wire recall_any_now ="],
            " | nominal",
            "",
        ),
        swap(
            "what stays too large is a fade",
            &["wire fade_ends ="],
            " | signal_changed",
            "",
        ),
        swap(
            "remembered twice as often",
            &["wire quiet_periods_end"],
            " & halfway",
            "",
        ),
        swap(
            "what is recalled waits for the end of the period",
            &["wire theta_applies_now ="],
            " | recall_any",
            " & ~recall_any",
        ),
        swap(
            "no recall where the signal is back",
            &["wire recall_again ="],
            "& known",
            "& 1'b0",
        ),
        swap(
            "held for a period only",
            &["wire return_goes_on ="],
            "recall &",
            "1'b0 &",
        ),
        swap(
            "what is recalled moves before the signal is whole",
            &["wire gear_periods_done ="],
            " & ~returned_lately",
            "",
        ),
        swap(
            "periods free are not counted off",
            &["held_periods_step ="],
            "free_period ? 2'sh3 :",
            "free_period ? 2'sh0 :",
        ),
        swap(
            "periods at rest are counted off",
            &["wire parameters_followed ="],
            " & not_returning",
            "",
        ),
        swap(
            "what is known is held no longer than the unknown",
            &["wire held_unknown ="],
            " & ~proven_stand_now",
            "",
        ),
        swap(
            "periods held count on through a loss",
            &["wire held_periods_go_on ="],
            " & counting",
            "",
        ),
    ]
}

/// Faults in the recall where gains have moved on.
pub(crate) fn moved_faults() -> Vec<Fault> {
    vec![swap(
        "no recall where a fade ends in a loss",
        &["wire proven_better_now ="],
        " | held_and_lost",
        "",
    )]
}
