//! Single faults in the corrections that not every chip has: channel skew and stored harmonics.

use super::edit::{Fault, between, fault, replaced, swap};

/// Faults in the correction of channel skew.
pub(crate) fn skew_faults() -> Vec<Fault> {
    vec![
        swap(
            "skew taken the other way round",
            &["wire", " s_difference_now ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "half of the skew's product left out of the second order",
            &["wire", " s_between_rounded ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "skew before lock",
            &["wire", " skew ="],
            "locked ?",
            "1'b1 ?",
        ),
        swap(
            "phase of the sensor with the wrong sign",
            &["wire", " skew_slope_difference_now ="],
            " - ",
            " + ",
        ),
    ]
}

/// Faults in the correction of stored harmonics.
pub(crate) fn harmonic_faults() -> Vec<Fault> {
    vec![
        swap(
            "harmonics of the cosine added",
            &["wire", " c_difference ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "harmonics of the sine added",
            &["wire", " s_difference_2_now ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "phase correction of the harmonics the other way round",
            &["wire", " s_rounded ="],
            "} - {{",
            "} + {{",
        ),
        swap(
            "second order of the phase correction with the wrong sign",
            &["wire", " harmonic_through ="],
            "} + {{",
            "} - {{",
        ),
        fault("expanded about the segment's beginning", |v| {
            let words = ["wire", " harmonic_inside_now ="];
            let half = between(v, &words, "'sh", ";");
            replaced(v, &words, &format!("'sh{half};"), "'sh0;")
        }),
    ]
}
