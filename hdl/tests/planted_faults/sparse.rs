//! Faults in what is learned from the phase error where samples are few.

use super::edit::{Fault, swap};

/// Each of one place; nine parameters at four samples a period.
pub(crate) fn sparse_faults() -> Vec<Fault> {
    vec![
        swap(
            "every period teaches along the radius",
            &["wire periods_of_turning ="],
            "periods_modulo_4[1]",
            "1'b0",
        ),
        swap(
            "periods take turns one by one",
            &["wire periods_of_turning ="],
            "periods_modulo_4[1]",
            "periods_modulo_4[0]",
        ),
        swap(
            "the ellipse is taught so from a lower speed on",
            &["wire ellipse_by_e_now ="],
            "$signed(rate[26:22]) < 5'sd7",
            "$signed(rate[26:22]) < 5'sd6",
        ),
        swap(
            "the ellipse is taught so forwards only",
            &["wire ellipse_by_e_now ="],
            "$signed(~rate[26:22]) < 5'sd7",
            "1'b1",
        ),
        swap(
            "the third order is taught so where bends rest",
            &["wire third_shown_by_e_now ="],
            " & bends_shown_now",
            "",
        ),
        swap(
            "the phase error counts whole",
            &["wire signed [14:0] residual_along_chosen ="],
            "e_alternating",
            "{e_alternating[13:0], 1'b0}",
        ),
        swap(
            "along the circle the other way round",
            &["wire signed [17:0] direction_c ="],
            "direction_c_negated",
            "sin_hat",
        ),
        swap(
            "the sine's gradient is along the radius",
            &["wire signed [17:0] direction_s ="],
            "ellipse_by_e ? cos_hat : sin_hat",
            "sin_hat",
        ),
        swap(
            "the offset of the cosine is taught so",
            &["wire signed [17:0] offset_residual_c_now ="],
            "ellipse_by_e ? 18'sd0 : ",
            "",
        ),
        swap(
            "the offset of the sine is taught so",
            &["wire signed [17:0] offset_residual_s_now ="],
            "ellipse_by_e ? 18'sd0 : ",
            "",
        ),
        swap(
            "the ellipse is taught by what is there for the third order",
            &["wire signed [14:0] residual_along_now ="],
            "third_shown_by_e ? 15'sd0 : ",
            "",
        ),
        swap(
            "the phase is taught by the sine of the double angle",
            &["wire signed [17:0] phase_direction_now ="],
            "ellipse_by_e ? half_cos_2 : ",
            "",
        ),
        swap(
            "the third order is taught by cos 4 alpha",
            &["wire signed [17:0] third_factor ="],
            "third_shown_by_e ? half_cos_2 : ",
            "",
        ),
        swap(
            "the third order is taught by 1 - sin 4 alpha",
            &["wire signed [1:0] cos_4_chosen_now ="],
            "third_shown_by_e_now ? 2'sd0 : ",
            "",
        ),
        swap(
            "the third order is taught by nothing",
            &["wire signed [14:0] third_residual ="],
            "third_shown_by_e ? e_alternating : ",
            "",
        ),
    ]
}
