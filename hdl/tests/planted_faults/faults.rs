//! Single faults in the Verilog, each of one place.

use super::edit::{
    Fault, another_last_step, another_literal, between, fault, guard, half_down, replaced, swap,
    zero_extended,
};

/// Faults in the Verilog, each of one place.
pub(crate) fn faults() -> Vec<Fault> {
    vec![
        swap(
            "periods that the parameters are held: one less",
            &["wire held_long_now ="],
            "7'sh27",
            "7'sh26",
        ),
        swap(
            "an attempt that failed begins again like the first",
            &["level_again_now ="],
            "attempt_fails ? {level_again_scaled[5], level_again_scaled} : level_again_chosen",
            "level_again_chosen",
        ),
        swap(
            "an attempt in the widest gear fails as well",
            &["wire attempt_fails ="],
            " & not_first_loop_gear",
            "",
        ),
        swap(
            "a level that begins again where other bits say",
            &["alpha_hat_last_bits ="],
            "alpha_hat[4:0]",
            "alpha_hat[5:1]",
        ),
        swap(
            "the loop catches up from twice the phase error on",
            &["wire e_small ="],
            "$signed(e[17:12]) < 6'sd1",
            "$signed(e[17:12]) < 6'sd2",
        ),
        swap(
            "a sample counts in which the loop catches up",
            &["wire loop_follows_now ="],
            " & not_catches_up",
            "",
        ),
        swap(
            "catching up is given up after one period",
            &["wire astray_again ="],
            " & astray_before",
            "",
        ),
        swap(
            "catching up is not given up for long",
            &["wire astray_long_next_now ="],
            " | astray_long_and_astray_goes_on",
            "",
        ),
        fault("rounding of the phase error: by the wrong bit", |v| {
            let (guard, below) = guard(v, "e_seen");
            replaced(v, &["wire", " e_seen_rounded ="], &guard, &below)
        }),
        fault("rounding of c: cut off", |v| {
            let (guard, _) = guard(v, "c");
            replaced(v, &["wire", " c ="], &guard, "1'b0")
        }),
        // Its nominal value carries half of a last bit, which is its lowest one.
        fault("rounding of theta_1: cut off", |v| {
            another_literal(v, &["wire", " theta_1_rounded ="], |n| n & (n - 1))
        }),
        fault("half of theta_1's last bit rounds down", |v| {
            another_literal(v, &["wire", " theta_1_rounded ="], |n| n - 1)
        }),
        fault("half of theta_5's last bit rounds down", |v| {
            half_down(v, "theta_5")
        }),
        fault("half of c's last bit rounds down", |v| half_down(v, "c")),
        fault("half of s's last bit rounds down", |v| half_down(v, "s")),
        fault("half of e_seen's last bit rounds down", |v| {
            half_down(v, "e_seen")
        }),
        fault("half of rho_c's last bit rounds down", |v| {
            half_down(v, "rho_c")
        }),
        fault("half of rho_s's last bit rounds down", |v| {
            half_down(v, "rho_s")
        }),
        fault("saturation of s: wraps", |v| {
            let kept = between(v, &["wire", " s_now = "], "? ", " :");
            let all = between(v, &["wire", " s_now = "], "= ", ";");
            replaced(v, &["wire", " s_now = "], &all, &kept)
        }),
        fault("saturation of theta_2: wraps", |v| {
            let words = ["wire", " running_2_next_bits = "];
            let kept = between(v, &words, "? ", " :");
            let all = between(v, &words, "= ", ";");
            replaced(v, &words, &all, &kept)
        }),
        swap(
            "saturation of theta_4: at the other end",
            &["wire", " running_4_next_bits = "],
            "{~",
            "{",
        ),
        fault("sign extension of a product", |v| {
            zero_extended(v, &["wire", " sin_magnitude_sum ="])
        }),
        fault("sign extension of the speed", |v| {
            zero_extended(v, &["wire", " alpha_hat_sum ="])
        }),
        swap(
            "logical shift in place of the arithmetic one",
            &["wire", " kick_shifted ="],
            ">>>",
            ">>",
        ),
        fault("latency: one clock more", |v| another_last_step(v, 1)),
        fault("latency: a register committed one step early", |v| {
            another_last_step(v, -1)
        }),
        swap(
            "a chip that does not wait for samples",
            &["wire start ="],
            " & sample_valid",
            "",
        ),
        swap(
            "a sample that an early strobe begins anew",
            &["wire start ="],
            "(step == 5'd0) & sample_valid",
            "sample_valid",
        ),
        swap(
            "valid longer than a clock",
            &["valid <= last"],
            "last",
            "last | (valid & (step == 5'd0) & ~sample_valid)",
        ),
        swap(
            "a step counter that runs by itself",
            &["else if (start |"],
            "else if (start | (step != 5'd0))",
            "else",
        ),
        fault("last bit of the coefficient a", |v| {
            another_literal(v, &["operand_a", "// loop_a"], |n| n ^ 1)
        }),
        fault("last bit of the coefficient a + b", |v| {
            another_literal(v, &["operand_b", "// loop_ab"], |n| n ^ 1)
        }),
        swap(
            "last bit of the lock limit",
            &["wire e_in_window ="],
            "6'sd7",
            "6'sd8",
        ),
        swap(
            "last bit of the limit that begins again",
            &["wire rho_high_now ="],
            "< 4'sd1)",
            "< 4'sd2)",
        ),
        swap(
            "last bit of the limit that holds",
            &["wire rho_not_small_now ="],
            "~rho_now[17:12]) < 6'sd1)",
            "~rho_now[17:12]) < 6'sd2)",
        ),
        swap(
            "what the loop lags is taken off the radius",
            &["wire", " rho_limited_rounded ="],
            "+ e_times_e",
            "- e_times_e",
        ),
        swap(
            "what is not small holds before it was ever small",
            &["wire calm_and_rho_not_small ="],
            "calm & ",
            "",
        ),
        swap(
            "a search that begins again stays calm",
            &["wire stays_calm ="],
            " & ~gamma_restart",
            "",
        ),
        swap(
            "a gear is calm whatever its last period was",
            &["wire gear_ends_calm ="],
            " & not_rough",
            "",
        ),
        swap(
            "a residual that is not small is forgotten",
            &["wire rough_next ="],
            "rough & within_period",
            "1'b0",
        ),
        swap(
            "direction forwards from twice the speed on",
            &["wire not_forwards_now ="],
            "'sd1;",
            "'sd2;",
        ),
        swap(
            "sectors counted again by turning back behind",
            &["wire used_behind_counts ="],
            "behind_used &",
            "1'b0 &",
        ),
        swap(
            "sectors counted again by turning back ahead",
            &["wire used_ahead_counts ="],
            "ahead_used &",
            "1'b0 &",
        ),
        swap(
            "turning back that is never forgotten",
            &["wire still_used_behind ="],
            "(whole_period_now | sector_behind)",
            "whole_period_now",
        ),
        swap(
            "what a part of a period has taught is applied",
            &["wire travel_ends"],
            "period_taught |",
            "fresh_now |",
        ),
        swap(
            "what a period has taught is never applied",
            &["wire travel_ends"],
            "period_taught |",
            "1'b0 |",
        ),
        fault("proven at a bound", |v| {
            let inside = " & gain_s_inside";
            let v = replaced(v, &["wire gains_steady ="], " & gain_c_inside", "");
            replaced(&v, &["wire gains_steady ="], inside, "")
        }),
        swap(
            "what is unknown is held as long as the known",
            &["wire held_long_now ="],
            " | held_unknown",
            "",
        ),
        swap(
            "quiet periods counted from before the loss",
            &["wire quiet_breaks_off ="],
            " | not_counting",
            "",
        ),
        swap(
            "quiet periods forgotten in the first gear",
            &["wire gear_breaks_off ="],
            " & not_gamma_gear_below_one",
            "",
        ),
        swap(
            "a disturbed period counts as quiet",
            &["wire quiet_period_ends"],
            " & quiet",
            "",
        ),
        swap(
            "the search fails with the first disturbed period",
            &["wire disturbed_again ="],
            "~search_begun_now | held_before_now",
            "1'b1",
        ),
        swap(
            "what is held after a disturbed period lets the count begin anew",
            &["wire no_quiet_period_ends ="],
            "~quiet_period_ends",
            "1'b0",
        ),
        swap(
            "nothing is known in the first gear",
            &["wire proven_or_unknown ="],
            "~search_begun_now | known",
            "1'b1",
        ),
        swap(
            "a phase error that is far too large teaches",
            &["wire far_behind ="],
            "~e_near & search_begun",
            "1'b0",
        ),
        swap(
            "a phase error that is far too large never teaches",
            &["wire teaches_now ="],
            " & not_astray_long",
            "",
        ),
        swap(
            "a period is kept in which the loop caught up",
            &["wire fresh_now ="],
            " & not_period_dropped",
            "",
        ),
        swap(
            "proven while gains move",
            &["wire proves"],
            "gains_steady | ~known",
            "1'b1",
        ),
        swap(
            "what is broken off waits on",
            &["wire travel_ends"],
            " | period_breaks_off",
            "",
        ),
        swap(
            "recall where a gain has moved on",
            &["wire proven_better"],
            "not_apart | ",
            "1'b1 | ",
        ),
        swap(
            "never proven again",
            &["wire proves"],
            "gains_steady | ",
            "",
        ),
        fault(
            "parameters of the next sample at the ports too early",
            |v| {
                let idle = "if (start) begin\n            upper_half <=";
                assert_eq!(v.matches(idle).count(), 1);
                v.replace(idle, &idle.replace("start", "step == 5'd0"))
            },
        ),
        fault("a stale operand", |v| {
            let forwarded = |line: &&str| line.contains("operand_") && line.ends_with("_now;");
            let line = v.lines().find(forwarded).expect("a forwarded operand");
            v.replacen(line, &line.replace("_now;", ";"), 1)
        }),
        swap(
            "nothing is remembered in the first gear",
            &["(gear_passed | first_gear_period)"],
            " | first_gear_period",
            "",
        ),
        swap(
            "no hold in the first gear",
            &["wire search_begun_now ="],
            " | ~(gear_periods < 4'sd1)",
            "",
        ),
    ]
}
