// optical: sin/cos interpolation chip that calibrates itself: linear optical encoder, 20 um, 12-bit ADC at 1 MS/s
//
// A digital loop follows the angle alpha of a sin/cos sensor: the corrected pair is turned back by the estimate
// alpha_hat, what is left is the phase error e, and the loop filter turns e into the next step of the estimate. The
// radial residual rho shows what the correction still misses and moves its parameters theta_1 to theta_5. gamma, how
// far, is 2^-4 at first and 2^-9 after 5 gears.
// After S. Balemi, "Automatic calibration of sinusoidal encoder signals", IFAC 2005; equation numbers are the paper's.
//
// Design ec8b484df4fe: 17 products on 1 multiplier, 20 clocks per sample.
//
// Formats: sW.F is a two's complement number of W bits, F of them behind the point; uW.F has no sign and is kept here
// with a zero in front, so that every number is signed. Angles are in turns of a scale period. A factor that is a power
// of two only moves the point: its value stands at other places of a sum than its own format says. A signal that
// saturates reads: the bits above the result all equal its sign ? the result : the end of its range on the side of the
// sign. x < m looks only at the bits of x that m has, and x < -m reads ~(~x < m): some synthesis tools get short
// comparisons with negative numbers wrong.
//
// A value x is computed in one step on the wire x, or on x_now where the register x keeps it for later steps and for
// the testbench. All registers of the chip change together at the end of the last step: a sample is one transaction,
// and samples never overlap. Outputs are those of the last sample from `valid` until the next `sample_valid`; before
// the first `valid` those that are not registers of the chip are undefined.
//
// step | in the multiplier        | computed in this step
// -----+--------------------------+------------------------------------------------------------------------------------
//    0 | -                        | sine_phase upper_half odd_quadrant quarter_phase quarter_phase_mirrored sin_address
//      |                          | sin_inside cos_address cos_inside cos_negative theta_1 theta_3 theta_5 last_gear
//      |                          | first_loop_gear alpha_hat_last_bits gamma_settled periods_modulo_4 sector
//      |                          | sector_relative period_ahead period_behind a_period_away reach_ahead reach_behind
//      |                          | unseen_ahead used_ahead_counts may_add_ahead sector_ahead unseen_behind
//      |                          | used_behind_counts may_add_behind sector_behind search_begun proven_stand
//      |                          | held_and_lost lost_in_first_gear proven_or_unknown nominal held_before
//      |                          | disturbed_again search_fails held_some_periods held_unknown held_long rises_again
//      |                          | restart_cause last_gamma_gear returned_lately gear_periods_done disturbed_before
//      |                          | quiet gear_done gain_c_inside gain_c_rests gain_s_inside gain_s_rests gains_steady
//      |                          | proves nothing_proven_yet
//    1 | loop_ab * error_previous | sin_value sin_slope y_c y_s counting whole_period travel_clear sector_added
//      |                          | new_sector still_used_ahead used_up_ahead still_used_behind used_up_behind y_5
//      |                          | astray_goes_on period_breaks_off lost_before
//    2 | theta_3 * y_s            | cos_value cos_slope drift rate_drifted
//    3 | sin_slope * sin_inside   |
//    4 | cos_slope * cos_inside   | sin_magnitude sin_hat
//    5 | theta_5 * y_c            | cos_magnitude cos_hat
//    6 | theta_1 * y_c            | s_exact s
//    7 | s * cos_hat              | c_exact c s_weak
//    8 | c * sin_hat              | c_weak signal_present may_flip
//    9 | c * cos_hat              | e_exact e_seen e
//   10 | s * sin_hat              | e_in_window e_change e_small behind e_near far_behind behind_or_far teaches
//      |                          | catches_up across_present period_has_hole period_dropped astray_lately
//      |                          | astray_period_ends astray_again
//   11 | e * e                    | rho_exact rho rho_in_window radius_present in_window flip level_step half_turn
//      |                          | loop_follows opposite_present astray_present present_anywhere rho_high rho_large
//      |                          | rho_not_small rho_rises proven_better may_recall
//   12 | loop_a * e_change        | level_moved level_full level_empty narrower loop_gear_up attempt_fails level_again
//      |                          | full_in_last_gear sample_counts counted period_tick rho_too_large residual_large
//      |                          | disturbed_lately disturbed_or_held disturbed_or_recalled hold_cause hold
//      |                          | signal_in_doubt held_in_doubt recall residual_rough radius_large counted_and_free
//      |                          | rho_limited disturbed_period gamma_restart period_kept gear_passed gamma_shift
//      |                          | gamma_gear_up gamma_gear_counted quiet_period_ends quiet_period_kept
//      |                          | gear_periods_up disturbed_period_ends quiet_breaks_off gear_breaks_off gear_ends
//      |                          | gear_periods_again held_periods_up no_quiet_period_ends parameters_followed
//      |                          | free_period held_periods_step goes_on_or_known held_periods_go_on held_or_going_on
//      |                          | held_periods_stay within_period gear_ends_calm stays_calm still_held holding
//      |                          | gamma_gear_searched first_gear_period restart_risen recall_again known_to_be_calm
//      |                          | last_gear_passed quiet_periods_pass quiet_periods_end proved gain_moved remember
//      |                          | search_improves remember_better signal_changed still_known fades fade_ends
//   13 | cos_hat * rho_limited    | kick sample_teaches fresh recall_any remember_recent return_goes_on together_again
//      |                          | period_taught travel_ends search_ends theta_applies lock_falls
//   14 | sin_hat * rho_limited    | speed alpha_hat_turned alpha_hat_sum carry backwards not_forwards rho_c gradient_2
//   15 | y_c * rho_c              | count_before rho_s step_2 gradient_4
//   16 | y_s * rho_s              | gradient_1 step_1 step_4
//   17 | y_5 * rho_s              | gradient_3 step_3
//   18 | -                        | gradient_5 step_5
//   19 | -                        |
//
// Coefficients, by name in the comments below:
//     loop_a                 0.014132976531982422    Loop coefficient a, turns per radian.
//     loop_ab                0.0006010085344314575   Loop coefficients a + b, turns per radian.
//     theta_1_nominal        1.25                    Nominal θ1.
//     theta_3_nominal        1.25                    Nominal θ3.
//     quarter_turn           0.24999618530273438     A quarter turn, less one bit of the sine phase.
//     half_bit               0.0000019073486328125   Half a bit of the sine phase: what was cut off, on average.
//     half_segment           0.0009765625            Half a sine table segment.
//     lock_error             0.4375                  Largest |e| in lock, radians.
//     lock_radius            0.5                     Radius of the smallest signal in lock: across the estimate it has
//                                                    this |e|.
//     weak_signal            0.25                    Corrected signals below this are lost.
//     restart_residual       0.25                    |ρ| above this begins the search again.
//     hold_residual          0.0625                  |ρ| above this is not small: it holds the parameters once a gear
//                                                    has ended without.
//     steady_gain            0.001953125             A gain that moves by more between two times that it is remembered
//                                                    is of a signal that fades.
//     gain_near_bound        0.46875                 A gain's deviation from which it is near its bound.
//     direction_rate         0.0000152587890625      Rate below which the direction does not change, turns per sample.
//     lock_down              -8                      What a bad sample adds to the lock level.
//     lock_full              63                      The full lock level.
//     lock_restart           31                      Lock level after a change of loop gear.
//     loop_gear_last         3                       Last loop gear.
//     small_error            0.0625                  What a calibrated sensor leaves in lock is smaller: of |e| in
//                                                    radians, of |ρ| in amplitudes.
//     far_error              0.125                   Twice what a calibrated sensor leaves: the |e|, radians, of a
//                                                    sensor that is not calibrated yet is smaller.
//     gamma_gear_settled     4                       From this γ gear on γ has settled.
//     gamma_gear_last        5                       Last γ gear.
//     gear_periods_last      3                       Periods of travel per γ gear, less one.
//     held_periods_last      31                      Periods of travel that the parameters are held before the search
//                                                    begins again, less one.
//     hold_periods_last      255                     Periods of travel that the parameters are held where better ones
//                                                    are known, less one.
//     returning_periods      32                      Quiet periods of travel after a recall that move nothing.
//     unit_radius            0.9999923706054688      The radius 1, less half a bit of the residual.
//     zero                   0                       0.
//     one                    1                       1.
//     half                   0.5                     ½.
//     quarter                0.25                    ¼.
//     minus_weak_signal      -0.25                   Minus weak_signal: Corrected signals below this are lost.
//     minus_lock_error       -0.4375                 Minus lock_error: Largest |e| in lock, radians.
//     minus_lock_residual    -0.5                    Minus lock_residual: Largest −ρ in lock.
//     minus_one              -1                      −1.
//     minus_direction_rate   -0.0000152587890625     Minus direction_rate: Rate below which the direction does not
//                                                    change, turns per sample.
//     minus_quarter          -0.25                   −¼.
//     minus_small_error      -0.0625                 Minus small_error: What a calibrated sensor leaves in lock is
//                                                    smaller: of |e| in radians, of |ρ| in amplitudes.
//     minus_far_error        -0.125                  Minus far_error: Twice what a calibrated sensor leaves: the |e|,
//                                                    radians, of a sensor that is not calibrated yet is smaller.
//     minus_lock_radius      -0.5                    Minus lock_radius: Radius of the smallest signal in lock: across
//                                                    the estimate it has this |e|.
//     minus_lock_opposite    -1.5                    Minus lock_opposite: −ρ of that signal where it points away
//                                                    from the estimate.
//     minus_restart_residual -0.25                   Minus restart_residual: |ρ| above this begins the search again.
//     minus_hold_residual    -0.0625                 Minus hold_residual: |ρ| above this is not small: it holds the
//                                                    parameters once a gear has ended without.
//     minus_steady_gain      -0.001953125            Minus steady_gain: A gain that moves by more between two times
//                                                    that it is remembered is of a signal that fades.

`default_nettype none
`timescale 1ns / 1ps

module optical (
    input  wire clk, // every register changes at the rising edge
    input  wire rst_n, // asynchronous reset, active low
    input  wire sample_valid, // one clock per sample, 20 clocks apart or more; the inputs below are valid
    input  wire [11:0] adc_cos, // code of the cosine channel, two's complement
    input  wire [11:0] adc_sin, // code of the sine channel, two's complement
    input  wire preset, // this sample's period becomes number 0; clears lock_lost
    input  wire calibrate, // this sample may teach the parameters; where it falls, what was learned so far is applied
    output wire signed [58:0] position, // periods, s59.27: whole periods and alpha_hat for the next sample
    output reg signed [15:0] theta_1, // θ1 as multiplied. s16.14
    output reg signed [23:0] theta_2, // θ2 as multiplied. s24.25
    output reg signed [15:0] theta_3, // θ3 as multiplied. s16.14
    output reg signed [23:0] theta_4, // θ4 as multiplied. s24.25
    output reg signed [13:0] theta_5, // θ5 as multiplied. s14.15
    output reg signed [25:0] speed, // Position increment of this sample, turns: the speed. s26.27
    output reg locked, // The loop follows.
    output reg lock_lost, // The lock was lost since the last zero preset or reset.
    output reg signal_lost, // Both corrected signals are too small.
    output reg direction, // The scale runs backwards.
    output reg valid // one clock per sample: the outputs are those of the sample
);

    // Registers of the chip. All are zero after reset.
    reg signed [27:0] alpha_hat; // α̂, the phase estimate: turns in [0, 1).
    reg signed [31:0] count; // Whole periods; the unit is the counter's whole range.
    reg signed [25:0] rate; // Phase increment per sample, turns.
    reg signed [17:0] error_previous; // e one sample ago, radians.
    reg signed [24:0] theta_1_deviation; // θ1 less its nominal value.
    reg signed [23:0] theta_2_deviation; // θ2, nominally 0.
    reg signed [24:0] theta_3_deviation; // θ3 less its nominal value.
    reg signed [23:0] theta_4_deviation; // θ4, nominally 0.
    reg signed [23:0] theta_5_deviation; // θ5, nominally 0.
    reg signed [6:0] lock_level; // Confidence of the lock detector.
    reg signed [2:0] loop_gear; // Loop gear: 0 widest, the last is the designed bandwidth.
    reg signed [3:0] gamma_gear; // γ gear: 0 largest.
    reg signed [6:0] gear_periods; // Quiet periods kept in this γ gear, or since a recall.
    reg signed [8:0] held_periods; // Periods with a large residual; with better parameters known, less those without.
    reg signed [7:0] travel_origin; // Position, modulo 4 periods, where the map of sectors was last cleared.
    reg signed [7:0] travel_low; // Lowest sector seen since, relative to the origin.
    reg signed [7:0] travel_high; // Highest sector seen since, relative to the origin.
    reg signed [24:0] running_1; // θ1 less its nominal value, as the running period of travel has it so far.
    reg signed [23:0] running_2; // θ2 less its nominal value, as the running period of travel has it so far.
    reg signed [24:0] running_3; // θ3 less its nominal value, as the running period of travel has it so far.
    reg signed [23:0] running_4; // θ4 less its nominal value, as the running period of travel has it so far.
    reg signed [23:0] running_5; // θ5 less its nominal value, as the running period of travel has it so far.
    reg signed [17:0] recent_1; // θ1 less its nominal value at the last end of some quiet periods of travel.
    reg signed [16:0] recent_2; // θ2 less its nominal value at the last end of some quiet periods of travel.
    reg signed [17:0] recent_3; // θ3 less its nominal value at the last end of some quiet periods of travel.
    reg signed [16:0] recent_4; // θ4 less its nominal value at the last end of some quiet periods of travel.
    reg signed [16:0] recent_5; // θ5 less its nominal value at the last end of some quiet periods of travel.
    reg signed [17:0] proven_1; // θ1 less its nominal value at the end before the one of recent_1.
    reg signed [16:0] proven_2; // θ2 less its nominal value at the end before the one of recent_2.
    reg signed [17:0] proven_3; // θ3 less its nominal value at the end before the one of recent_3.
    reg signed [16:0] proven_4; // θ4 less its nominal value at the end before the one of recent_4.
    reg signed [16:0] proven_5; // θ5 less its nominal value at the end before the one of recent_5.
    reg ahead_used; // The sectors ahead of the origin were used right before the map was cleared.
    reg behind_used; // The sectors behind the origin were used right before the map was cleared.
    reg disturbed; // The residual was large in this period of travel.
    reg rough; // The residual was not small in this period of travel.
    reg calm; // A gear of γ has ended with a small residual since the search began.
    reg risen; // The radius was too large in this period of travel.
    reg held; // The residual was large in the period before: the parameters are held.
    reg astray; // The running period of travel has had an |e| larger than its γ gear expects of a sensor.
    reg astray_before; // The period of travel before had one.
    reg astray_long; // The two periods before had one, or more: it is not catching up.
    reg returning; // What was recalled is held until some periods have passed quietly (recall).
    reg fading; // The search began again where the residual had stayed: the signal may have faded (recall).
    reg known; // Parameters have been remembered in the last gear (recall).
    reg halfway; // Half of the way to where they are remembered next (recall).
    reg apart; // A gain has moved away from what is proven.

    // The sample's inputs, held
    reg signed [11:0] adc_cos_held; // ADC code of the cosine channel, as a fraction of the ADC's range.
    reg signed [11:0] adc_sin_held; // ADC code of the sine channel, as a fraction of the ADC's range.
    reg preset_held; // Zero preset: this sample's period becomes number 0 and the lock-lost flag is cleared.
    reg calibrate_held; // Calibration may update the parameters.

    // Values that later steps or the testbench read
    reg upper_half;
    reg signed [9:0] sin_inside;
    reg signed [18:0] sin_value;
    reg signed [8:0] sin_slope;
    reg signed [16:0] cos_address;
    reg signed [9:0] cos_inside;
    reg signed [18:0] cos_value;
    reg signed [8:0] cos_slope;
    reg signed [17:0] sin_hat;
    reg cos_negative;
    reg signed [17:0] cos_hat;
    reg signed [26:0] s_exact_sum;
    reg signed [17:0] c;
    reg signed [17:0] s;
    reg c_below_weak_signal;
    reg not_c_below_minus_weak_signal;
    reg s_below_weak_signal;
    reg not_s_below_minus_weak_signal;
    reg s_weak;
    reg signal_lost_next;
    reg signed [34:0] rho_exact_difference;
    reg signed [17:0] rho;
    reg signed [34:0] s_times_cos_hat;
    reg signed [17:0] e;
    reg e_in_window;
    reg signal_present;
    reg in_window;
    reg may_flip;
    reg signed [3:0] level_step;
    reg level_empty;
    reg loop_gear_below_loop_gear_last;
    reg last_gear;
    reg signed [1:0] loop_gear_up;
    reg not_first_loop_gear;
    reg signed [5:0] level_again_scaled;
    reg signed [6:0] level_again;
    reg locked_next;
    reg signed [2:0] loop_gear_next;
    reg signed [17:0] e_change;
    reg signed [26:0] rate_drifted;
    reg signed [27:0] speed_sum;
    reg signed [1:0] half_turn;
    reg signed [27:0] alpha_hat_next;
    reg signed [1:0] count_next_scaled;
    reg signed [31:0] count_next;
    reg direction_next;
    reg counting;
    reg gamma_gear_below_gamma_gear_settled;
    reg gamma_settled;
    reg signed [7:0] sector;
    reg signed [7:0] sector_relative;
    reg period_ahead;
    reg period_behind;
    reg a_period_away;
    reg whole_period;
    reg sector_ahead;
    reg sector_behind;
    reg not_counting;
    reg travel_clear;
    reg new_sector;
    reg signed [7:0] travel_low_next;
    reg ahead_used_next;
    reg behind_used_next;
    reg not_astray_long;
    reg gamma_gear_below_one;
    reg not_gamma_gear_below_one;
    reg search_begun;
    reg teaches;
    reg not_catches_up;
    reg loop_follows;
    reg across_present;
    reg rho_high;
    reg rho_large;
    reg rho_not_small;
    reg calm_and_rho_not_small;
    reg not_fading;
    reg proven_stand;
    reg held_and_lost;
    reg not_apart;
    reg may_recall;
    reg not_present_anywhere;
    reg recall;
    reg counted_and_free;
    reg astray_and_not_astray_long;
    reg period_dropped;
    reg not_period_dropped;
    reg fresh;
    reg signed [14:0] rho_limited;
    reg signed [17:0] rho_c;
    reg signed [17:0] rho_s;
    reg signed [23:0] running_5_next_chosen;
    reg signed [13:0] y_5;
    reg nominal;
    reg signed [24:0] step_5;
    reg signed [21:0] step_1;
    reg signed [24:0] step_2_geared;
    reg signed [21:0] step_3;
    reg signed [24:0] step_4_geared;
    reg held_before;
    reg held_long;
    reg restart_cause;
    reg gamma_gear_below_gamma_gear_last;
    reg last_gamma_gear;
    reg disturbed_before;
    reg quiet;
    reg gear_done;
    reg not_returning;
    reg signed [8:0] held_periods_next;
    reg not_rough;
    reg signed [3:0] gamma_gear_searched;
    reg signed [6:0] gear_periods_next;
    reg disturbed_next;
    reg rough_next;
    reg risen_next;
    reg held_next;
    reg recall_again;
    reg recall_any;
    reg signed [24:0] running_1_next;
    reg signed [23:0] running_2_next;
    reg signed [24:0] running_3_next;
    reg signed [23:0] running_4_next;
    reg known_to_be_calm;
    reg signed [3:0] gamma_gear_next;
    reg proves;
    reg proved;
    reg not_gains_steady;
    reg nothing_proven_yet;
    reg remember;
    reg remember_better;
    reg remember_recent;
    reg not_gear_ends;
    reg fades;
    reg fade_ends;
    reg returning_next;
    reg fading_next;
    reg either_halfway_or_quiet_periods_pass;
    reg halfway_next;
    reg known_next;
    reg gain_moved_or_apart;
    reg apart_next;
    reg astray_goes_on;
    reg astray_next;
    reg astray_before_and_astray_goes_on;
    reg astray_before_next;
    reg astray_long_and_astray_goes_on;
    reg astray_long_next;
    reg period_breaks_off;
    reg theta_applies;
    reg lost_before;
    reg lock_lost_next;

    // Operands and products
    reg signed [17:0] operand_a_0;
    reg signed [17:0] operand_b_0;
    reg signed [35:0] product_0;

    // Step counter: a sample starts in step 0 and takes 20 steps
    reg [4:0] step;
    wire start = (step == 5'd0) & sample_valid;
    wire last = step == 5'd19;

    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
            step <= 5'd0;
            valid <= 1'b0;
        end else begin
            valid <= last;
            if (last)
                step <= 5'd0;
            else if (start | (step != 5'd0))
                step <= step + 5'd1;
        end

    always @(posedge clk)
        if (start) begin
            adc_cos_held <= adc_cos;
            adc_sin_held <= adc_sin;
            preset_held <= preset;
            calibrate_held <= calibrate;
        end

    // Table sine_table: 128 rows of 26 bits, a row is there one step after its address
    reg [25:0] sine_table [0:127];
    initial $readmemh("coefficients/sine_table.mem", sine_table);
    reg [6:0] sine_table_address;
    reg [25:0] sine_table_row;

    always @*
        case (step)
            5'd0: sine_table_address = sin_address[15:9];
            default: sine_table_address = cos_address[15:9];
        endcase

    always @(posedge clk)
        sine_table_row <= sine_table[sine_table_address];

    // Sine and cosine of the estimate
    //   sin(x) = value[x] + slope[x] (x - centre), quarter wave, folded by quadrant
    //   (paper section 3, for the phase detector)
    wire signed [18:0] sine_phase = alpha_hat[27:9]; // u18.18, step 0
    wire upper_half_now = ~($signed(sine_phase[18:17]) < 2'sd1); // step 0
    wire signed [17:0] odd_quadrant_bits = {1'b0, sine_phase[16:0]}; // u17.18, step 0
    wire odd_quadrant = ~($signed(odd_quadrant_bits[17:16]) < 2'sd1); // step 0
    wire signed [16:0] quarter_phase = {1'b0, sine_phase[15:0]}; // u16.18, step 0
    wire signed [16:0] quarter_phase_mirrored = {1'b0, ~quarter_phase[15:0]}; // s17.18, step 0, with quarter_turn
    wire signed [16:0] sin_address = odd_quadrant ? quarter_phase_mirrored : quarter_phase; // s17.18, step 0
    wire signed [9:0] sin_inside_bits = {1'b0, sin_address[8:0]}; // u9.18, step 0
    wire signed [10:0] sin_inside_sum = {sin_inside_bits, 1'h1}; // s11.19, step 0, with half_bit
    wire signed [9:0] sin_inside_now = sin_inside_sum[9:0] - 10'sh200; // s10.19, step 0, with half_segment
    wire signed [18:0] sin_value_now = {1'b0, sine_table_row[25:8]}; // u18.17, step 1
    wire signed [8:0] sin_slope_now = {1'b0, sine_table_row[7:0]}; // u8.5, step 1
    wire signed [17:0] sin_slope_times_sin_inside = product_0[17:0]; // s18.24, step 4
    wire signed [25:0] sin_magnitude_sum = // s26.24, step 4
        {{8{sin_slope_times_sin_inside[17]}}, sin_slope_times_sin_inside} + {sin_value, 7'b0};
    wire signed [17:0] sin_magnitude = sin_magnitude_sum[25:8]; // s18.16, step 4
    wire signed [16:0] cos_address_now = odd_quadrant ? quarter_phase : quarter_phase_mirrored; // s17.18, step 0
    wire signed [9:0] cos_inside_bits = {1'b0, cos_address_now[8:0]}; // u9.18, step 0
    wire signed [10:0] cos_inside_sum = {cos_inside_bits, 1'h1}; // s11.19, step 0, with half_bit
    wire signed [9:0] cos_inside_now = cos_inside_sum[9:0] - 10'sh200; // s10.19, step 0, with half_segment
    wire signed [18:0] cos_value_now = {1'b0, sine_table_row[25:8]}; // u18.17, step 2
    wire signed [8:0] cos_slope_now = {1'b0, sine_table_row[7:0]}; // u8.5, step 2
    wire signed [17:0] cos_slope_times_cos_inside = product_0[17:0]; // s18.24, step 5
    wire signed [25:0] cos_magnitude_sum = // s26.24, step 5
        {{8{cos_slope_times_cos_inside[17]}}, cos_slope_times_cos_inside} + {cos_value, 7'b0};
    wire signed [17:0] cos_magnitude = cos_magnitude_sum[25:8]; // s18.16, step 5
    wire signed [17:0] sin_hat_negated = -sin_magnitude; // s18.16, step 4
    wire signed [17:0] sin_hat_now = upper_half ? sin_hat_negated : sin_magnitude; // s18.16, step 4
    wire cos_negative_now = upper_half_now ^ odd_quadrant; // step 0
    wire signed [17:0] cos_hat_negated = -cos_magnitude; // s18.16, step 5
    wire signed [17:0] cos_hat_now = cos_negative ? cos_hat_negated : cos_magnitude; // s18.16, step 5

    // ADC codes
    //   y = code, as a fraction of the range that the nominal amplitude needs
    //   (equation (4): y_c = a_c cos(alpha) + b_c, y_s = a_s sin(alpha - beta) + b_s)
    wire signed [11:0] y_c = adc_cos_held; // s12.11, step 1
    wire signed [11:0] y_s = adc_sin_held; // s12.11, step 1

    // Parameters as multiplied
    //   theta = nominal + deviation, rounded to what the multiplier takes
    //   (paper section 5.3)
    wire signed [26:0] theta_1_rounded = 27'sh2800400 + {{2{theta_1_deviation[24]}}, theta_1_deviation};
    wire signed [15:0] theta_1_now = theta_1_rounded[26:11]; // s16.14, step 0, with theta_1_nominal
    wire signed [26:0] theta_3_rounded = 27'sh2800400 + {{2{theta_3_deviation[24]}}, theta_3_deviation};
    wire signed [15:0] theta_3_now = theta_3_rounded[26:11]; // s16.14, step 0, with theta_3_nominal
    wire signed [14:0] theta_5_rounded =
        {theta_5_deviation[23], theta_5_deviation[23:10]} + {14'b0, theta_5_deviation[9]};
    wire signed [13:0] theta_5_now = // s14.15, step 0
        (theta_5_rounded[14] == theta_5_rounded[13])
            ? theta_5_rounded[13:0]
            : {theta_5_rounded[14], {13{~theta_5_rounded[14]}}};

    // Correction
    //   c = theta_1 y_c + theta_2, s = theta_3 y_s + theta_4 + theta_5 y_c
    //   (paper section 5.3)
    wire signed [26:0] theta_1_times_y_c = product_0[26:0]; // s27.25, step 7
    wire signed [26:0] c_exact = theta_1_times_y_c + {{3{theta_2_deviation[23]}}, theta_2_deviation}; // s27.25, step 7
    wire signed [26:0] theta_3_times_y_s = product_0[26:0]; // s27.25, step 3
    wire signed [26:0] s_exact_sum_now = // s27.25, step 3
        theta_3_times_y_s + {{3{theta_4_deviation[23]}}, theta_4_deviation};
    wire signed [25:0] theta_5_times_y_c = product_0[25:0]; // s26.26, step 6
    wire signed [28:0] s_exact = // s29.26, step 6
        {s_exact_sum[26], s_exact_sum, 1'b0} + {{3{theta_5_times_y_c[25]}}, theta_5_times_y_c};
    wire signed [17:0] c_now = c_exact[26:9] + {17'b0, c_exact[8]}; // s18.16, step 7
    wire signed [18:0] s_rounded = s_exact[28:10] + {18'b0, s_exact[9]};
    wire signed [17:0] s_now = // s18.16, step 6
        (s_rounded[18] == s_rounded[17]) ? s_rounded[17:0] : {s_rounded[18], {17{~s_rounded[18]}}};

    // Loss of signal
    //   |c| and |s| both below the threshold
    wire c_below_weak_signal_now = $signed(c_now[17:14]) < 4'sd1; // step 7, with weak_signal
    wire not_c_below_minus_weak_signal_now = $signed(~c_now[17:14]) < 4'sd1; // step 7, with minus_weak_signal
    wire c_weak = c_below_weak_signal & not_c_below_minus_weak_signal; // step 8
    wire s_below_weak_signal_now = $signed(s_now[17:14]) < 4'sd1; // step 6, with weak_signal
    wire not_s_below_minus_weak_signal_now = $signed(~s_now[17:14]) < 4'sd1; // step 6, with minus_weak_signal
    wire s_weak_now = s_below_weak_signal & not_s_below_minus_weak_signal; // step 7
    wire signal_lost_next_now = c_weak & s_weak; // step 8

    // Radial residual
    //   rho = c cos(alpha_hat) + s sin(alpha_hat) - 1, the half bit of rounding in the 1
    //   (paper section 5.5.1, n^T r)
    wire signed [34:0] c_times_cos_hat = product_0[34:0]; // s35.32, step 10
    wire signed [34:0] rho_exact_difference_now = c_times_cos_hat - 35'shffff8000; // s35.32, step 10, with unit_radius
    wire signed [34:0] s_times_sin_hat = product_0[34:0]; // s35.32, step 11
    wire signed [35:0] rho_exact = // s36.32, step 11
        {rho_exact_difference[34], rho_exact_difference} + {s_times_sin_hat[34], s_times_sin_hat};
    wire signed [17:0] rho_now = // s18.16, step 11
        (rho_exact[35:33] == {3{rho_exact[35]}}) ? rho_exact[33:16] : {rho_exact[35], {17{~rho_exact[35]}}};

    // Phase detector
    //   e = s cos(alpha_hat) - c sin(alpha_hat)
    //   (paper section 3)
    wire signed [34:0] s_times_cos_hat_now = product_0[34:0]; // s35.32, step 8
    wire signed [34:0] c_times_sin_hat = product_0[34:0]; // s35.32, step 9
    wire signed [35:0] e_exact = // s36.32, step 9
        {s_times_cos_hat[34], s_times_cos_hat} - {c_times_sin_hat[34], c_times_sin_hat};
    wire signed [19:0] e_seen_rounded = e_exact[35:16] + {19'b0, e_exact[15]};
    wire signed [17:0] e_seen = // s18.16, step 9
        (e_seen_rounded[19:17] == {3{e_seen_rounded[19]}})
            ? e_seen_rounded[17:0]
            : {e_seen_rounded[19], {17{~e_seen_rounded[19]}}};
    wire signed [17:0] e_now = signal_lost_next ? 18'sd0 : e_seen; // s18.16, step 9

    // Lock window
    //   |e| and -rho below their limits, signal present
    //   (calibration needs lock: the update would otherwise drive the gains to zero)
    wire e_in_window_now = // step 10, with lock_error, minus_lock_error
        ($signed(e[17:12]) < 6'sd7) & ($signed(~e[17:12]) < 6'sd7);
    wire rho_in_window = $signed(~rho_now[17:15]) < 3'sd1; // step 11, with minus_lock_residual
    wire signal_present_now = ~signal_lost_next_now; // step 8
    wire radius_present = rho_in_window & signal_present; // step 11
    wire in_window_now = e_in_window & radius_present; // step 11
    wire may_flip_now = ~(locked | signal_lost_next_now); // step 8
    wire flip = ~($signed(~rho_now[17:16]) < 2'sd1) & may_flip; // step 11
    wire across_present_now = // step 10, with lock_radius, minus_lock_radius
        ~(($signed(e[17:15]) < 3'sd1) & ($signed(~e[17:15]) < 3'sd1));
    wire opposite_present = ~($signed(~rho_now[17:15]) < 3'sd3); // step 11, with minus_lock_opposite
    wire astray_present = across_present | opposite_present; // step 11
    wire present_anywhere = radius_present | astray_present; // step 11

    // Lock level and loop gear
    //   level' = level + 1 if good, else level - 8; full: narrower loop, in the last gear locked; empty: widest loop,
    //   lock is lost, and where an attempt failed level' = last bits of alpha_hat
    wire signed [3:0] level_step_now = in_window_now ? 4'sd1 : 4'sh8; // s4.0, step 11, with lock_down
    wire signed [7:0] level_moved_sum = {lock_level[6], lock_level} + {{4{level_step[3]}}, level_step}; // s8.0, step 12
    wire signed [6:0] level_moved = // u6.0, step 12
        level_moved_sum[7] ? 7'sd0 : (level_moved_sum[6] ? 7'sh3f : {1'b0, level_moved_sum[5:0]});
    wire level_moved_below_lock_full = level_moved < 7'sh3f; // step 12, with lock_full
    wire level_full = ~level_moved_below_lock_full; // step 12
    wire level_empty_now = level_moved < 7'sd1; // step 12
    wire loop_gear_below_loop_gear_last_now = loop_gear < 3'sd3; // step 0, with loop_gear_last
    wire last_gear_now = ~loop_gear_below_loop_gear_last_now; // step 0
    wire narrower = level_full & loop_gear_below_loop_gear_last; // step 12
    wire signed [1:0] loop_gear_up_now = narrower ? 2'sd1 : 2'sd0; // s2.0, step 12
    wire signed [3:0] loop_gear_next_sum = // s4.0, step 13
        {loop_gear[2], loop_gear} + {{2{loop_gear_up[1]}}, loop_gear_up};
    wire signed [2:0] loop_gear_next_bits = {1'b0, loop_gear_next_sum[1:0]}; // u2.0, step 13
    wire signed [6:0] level_again_chosen = narrower ? 7'sh1f : level_moved; // s7.0, step 12, with lock_restart
    wire first_loop_gear = loop_gear < 3'sd1; // step 0
    wire not_first_loop_gear_now = ~first_loop_gear; // step 0
    wire attempt_fails = level_empty_now & not_first_loop_gear; // step 12
    wire signed [5:0] alpha_hat_last_bits = {1'b0, alpha_hat[4:0]}; // u5.27, step 0
    wire signed [5:0] level_again_scaled_now = alpha_hat_last_bits; // s6.0, step 0
    wire signed [6:0] level_again_now = // s7.0, step 12
        attempt_fails ? {level_again_scaled[5], level_again_scaled} : level_again_chosen;
    wire full_in_last_gear = level_full & last_gear; // step 12
    wire locked_next_now = (locked | full_in_last_gear) & ~level_empty_now; // step 12
    wire signed [6:0] lock_level_next = level_again; // u6.0, step 19
    wire signed [2:0] loop_gear_next_now = level_empty ? 3'sd0 : loop_gear_next_bits; // u2.0, step 13

    // Loop filter
    //   rate' = rate + a (e - e_1) + (a + b) e_1; a times 2^n, a + b times 4^n in acquisition
    //   (paper section 4.3: Method 1's a and b, c = -2, d = 1; the rate is kept, it is the speed)
    wire signed [18:0] e_change_difference = {e[17], e} - {error_previous[17], error_previous}; // s19.16, step 10
    wire signed [17:0] e_change_now = // s18.16, step 10
        (e_change_difference[18] == e_change_difference[17])
            ? e_change_difference[17:0]
            : {e_change_difference[18], {17{~e_change_difference[18]}}};
    wire signed [33:0] loop_a_times_e_change = product_0[33:0]; // s34.38, step 13
    wire signed [26:0] kick_unshifted = loop_a_times_e_change[33:7];
    wire signed [26:0] kick_shifted = kick_unshifted >>> loop_gear[1:0];
    wire signed [25:0] kick = kick_shifted[26:1] + {25'b0, kick_shifted[0]}; // s26.27, step 13
    wire signed [33:0] loop_ab_times_error_previous = product_0[33:0]; // s34.42, step 2
    wire signed [25:0] drift_unshifted = loop_ab_times_error_previous[33:8];
    wire signed [25:0] drift_shifted = drift_unshifted >>> {loop_gear[1:0], 1'b0};
    wire signed [24:0] drift_rounded = drift_shifted[25:1] + {24'b0, drift_shifted[0]};
    wire signed [25:0] drift = {drift_rounded[24], drift_rounded}; // s26.27, step 2
    wire signed [26:0] rate_drifted_now = {rate[25], rate} + {drift[25], drift}; // s27.27, step 2
    wire signed [27:0] speed_sum_now = {rate_drifted[26], rate_drifted} + {{2{kick[25]}}, kick}; // s28.27, step 13
    wire signed [25:0] speed_now = // s26.27, step 14
        (speed_sum[27:25] == {3{speed_sum[27]}}) ? speed_sum[25:0] : {speed_sum[27], {25{~speed_sum[27]}}};

    // Position
    //   alpha_hat' = alpha_hat + rate' (mod 1), count' = count + carry
    //   (paper equation (9))
    wire signed [1:0] half_turn_now = flip ? 2'sd1 : 2'sd0; // s2.1, step 11
    wire signed [28:0] alpha_hat_turned = // s29.27, step 14
        {alpha_hat[27], alpha_hat} + {half_turn[1], half_turn, 26'b0};
    wire signed [28:0] alpha_hat_sum = alpha_hat_turned + {{3{speed_now[25]}}, speed_now}; // s29.27, step 14
    wire signed [27:0] alpha_hat_next_now = {1'b0, alpha_hat_sum[26:0]}; // u27.27, step 14
    wire signed [2:0] carry = {alpha_hat_sum[28], alpha_hat_sum[28:27]}; // s3.0, step 14
    wire signed [31:0] count_before = preset_held ? 32'sd0 : count; // s32.32, step 15
    wire signed [1:0] count_next_scaled_now = carry[1:0]; // s2.32, step 14
    wire signed [32:0] count_next_sum = // s33.32, step 15
        {count_before[31], count_before} + {{31{count_next_scaled[1]}}, count_next_scaled};
    wire signed [31:0] count_next_now = count_next_sum[31:0]; // s32.32, step 15

    // Direction
    //   sign of the rate, with a dead band
    wire backwards = ~($signed(~speed_now[25:11]) < 15'sd1); // step 14, with minus_direction_rate
    wire not_forwards = $signed(speed_now[25:11]) < 15'sd1; // step 14, with direction_rate
    wire direction_next_now = backwards | (direction & not_forwards); // step 14

    // Travel
    //   a sector of the period is fresh until it was used once since the last whole period
    //   (paper section 5.5: static measurements may bias the estimates)
    wire counting_now = locked & calibrate_held; // step 1
    wire gamma_gear_below_gamma_gear_settled_now = $signed(gamma_gear[3:2]) < 2'sd1; // step 0, with gamma_gear_settled
    wire gamma_settled_now = ~gamma_gear_below_gamma_gear_settled_now; // step 0
    wire signed [1:0] periods_modulo_4 = count[1:0]; // s2.0, step 0
    wire signed [6:0] sector_bits = alpha_hat[27:21]; // u6.6, step 0
    wire signed [7:0] sector_now = {periods_modulo_4, 6'b0} + {sector_bits[6], sector_bits}; // s8.6, step 0
    wire signed [8:0] sector_relative_difference = // s9.6, step 0
        {sector_now[7], sector_now} - {travel_origin[7], travel_origin};
    wire signed [7:0] sector_relative_now = sector_relative_difference[7:0]; // s8.6, step 0
    wire period_ahead_now = ~($signed(sector_relative_now[7:6]) < 2'sd1); // step 0
    wire period_behind_now = ~(~sector_relative_now < 8'sh3f); // step 0
    wire a_period_away_now = period_ahead_now | period_behind_now; // step 0
    wire whole_period_now = a_period_away & counting_now; // step 1
    wire signed [8:0] reach_ahead = {travel_low[7], travel_low} + 9'sh40; // s9.6, step 0
    wire signed [8:0] reach_behind = {travel_high[7], travel_high} - 9'sh40; // s9.6, step 0
    wire unseen_ahead = // step 0
        (travel_high < sector_relative_now) & ($signed({sector_relative_now[7], sector_relative_now}) < reach_ahead);
    wire used_ahead_counts = ahead_used & gamma_gear_below_gamma_gear_settled_now; // step 0
    wire may_add_ahead = ~(($signed(sector_relative_now[7:4]) < 4'sd1) & used_ahead_counts); // step 0
    wire sector_ahead_now = unseen_ahead & may_add_ahead; // step 0
    wire unseen_behind = // step 0
        (sector_relative_now < travel_low) & (reach_behind < $signed({sector_relative_now[7], sector_relative_now}));
    wire used_behind_counts = behind_used & gamma_gear_below_gamma_gear_settled_now; // step 0
    wire may_add_behind = // step 0, with minus_quarter
        ~(($signed(~sector_relative_now[7:4]) < 4'sd1) & used_behind_counts);
    wire sector_behind_now = unseen_behind & may_add_behind; // step 0
    wire not_counting_now = ~counting_now; // step 1
    wire travel_clear_now = whole_period_now | not_counting_now; // step 1
    wire sector_added = sector_ahead | sector_behind; // step 1
    wire new_sector_now = sector_added | travel_clear_now; // step 1
    wire signed [7:0] travel_origin_next = travel_clear ? sector : travel_origin; // s8.6, step 19
    wire signed [7:0] travel_low_next_chosen = sector_behind ? sector_relative : travel_low; // s8.6, step 1
    wire signed [7:0] travel_low_next_now = travel_clear_now ? 8'sd0 : travel_low_next_chosen; // s8.6, step 1
    wire signed [7:0] travel_high_next_chosen = sector_ahead ? sector_relative : travel_high; // s8.6, step 19
    wire signed [7:0] travel_high_next = travel_clear ? 8'sd0 : travel_high_next_chosen; // s8.6, step 19
    wire still_used_ahead = ahead_used & ~(whole_period_now | sector_ahead); // step 1
    wire used_up_ahead = period_behind | still_used_ahead; // step 1
    wire ahead_used_next_now = counting_now & used_up_ahead; // step 1
    wire still_used_behind = behind_used & ~(whole_period_now | sector_behind); // step 1
    wire used_up_behind = period_ahead | still_used_behind; // step 1
    wire behind_used_next_now = counting_now & used_up_behind; // step 1

    // The loop catches up
    //   once gamma has settled, a sample with a large |e| does not count, from the first quiet period on one with a
    //   larger |e| teaches nothing, unless two periods of travel had one
    wire e_small = // step 10, with small_error, minus_small_error
        ($signed(e[17:12]) < 6'sd1) & ($signed(~e[17:12]) < 6'sd1);
    wire behind = gamma_settled & ~e_small; // step 10
    wire e_near = // step 10, with far_error, minus_far_error
        ($signed(e[17:13]) < 5'sd1) & ($signed(~e[17:13]) < 5'sd1);
    wire not_astray_long_now = ~astray_long; // step 0
    wire gamma_gear_below_one_now = gamma_gear < 4'sd1; // step 0
    wire not_gamma_gear_below_one_now = ~gamma_gear_below_one_now; // step 0
    wire search_begun_now = not_gamma_gear_below_one_now | ~(gear_periods < 7'sd1); // step 0
    wire far_behind = ~e_near & search_begun; // step 10
    wire behind_or_far = far_behind | behind; // step 10
    wire teaches_now = ~(behind_or_far & not_astray_long); // step 10
    wire catches_up = behind & not_astray_long; // step 10
    wire not_catches_up_now = ~catches_up; // step 10
    wire loop_follows_now = in_window_now & not_catches_up; // step 11
    wire sample_counts = counting & loop_follows; // step 12
    wire counted = sample_counts & new_sector; // step 12
    wire period_tick = counted & whole_period; // step 12
    wire astray_lately = astray | behind_or_far; // step 10
    wire astray_goes_on_now = ~whole_period_now & counting_now; // step 1
    wire astray_period_ends = whole_period & astray_lately; // step 10
    wire astray_again = astray_period_ends & astray_before; // step 10
    wire astray_next_now = astray_lately & astray_goes_on; // step 10
    wire astray_before_and_astray_goes_on_now = astray_before & astray_goes_on_now; // step 1
    wire astray_before_next_now = astray_period_ends | astray_before_and_astray_goes_on; // step 10
    wire astray_long_and_astray_goes_on_now = astray_long & astray_goes_on_now; // step 1
    wire astray_long_next_now = astray_again | astray_long_and_astray_goes_on; // step 10

    // Hold
    //   from the first quiet period on a large residual, once a gear has ended calm one that is not small, and all
    //   until the end of a period without one, moves no parameter
    wire rho_high_now = ~($signed(rho_now[17:14]) < 4'sd1); // step 11, with restart_residual
    wire rho_large_now = rho_high_now | ~($signed(~rho_now[17:14]) < 4'sd1); // step 11, with minus_restart_residual
    wire rho_below_hold_residual = $signed(rho_now[17:12]) < 6'sd1; // step 11, with hold_residual
    wire rho_not_small_now = // step 11, with minus_hold_residual
        ~(rho_below_hold_residual & ($signed(~rho_now[17:12]) < 6'sd1));
    wire calm_and_rho_not_small_now = calm & rho_not_small_now; // step 11
    wire rho_too_large = rho_large | calm_and_rho_not_small; // step 12
    wire residual_large = rho_too_large & sample_counts; // step 12
    wire disturbed_lately = residual_large | disturbed; // step 12
    wire disturbed_or_held = disturbed_lately | held; // step 12
    wire disturbed_or_recalled = disturbed_or_held | returning; // step 12
    wire hold_cause = disturbed_or_recalled | level_moved_below_lock_full; // step 12
    wire hold = hold_cause & search_begun; // step 12
    wire not_fading_now = ~fading; // step 0
    wire proven_stand_now = known & not_fading_now; // step 0
    wire rho_rises = ~rho_below_hold_residual; // step 11
    wire held_and_lost_now = ~($signed(held_periods[8:2]) < 7'sd1) & ~locked; // step 0
    wire not_apart_now = ~apart; // step 0
    wire proven_better = (not_apart | rho_rises) | held_and_lost; // step 11
    wire may_recall_now = proven_stand & proven_better; // step 11
    wire not_present_anywhere_now = ~present_anywhere; // step 11
    wire signal_in_doubt = disturbed_or_recalled | not_present_anywhere; // step 12
    wire held_in_doubt = hold & signal_in_doubt; // step 12
    wire recall_now = held_in_doubt & may_recall; // step 12
    wire residual_rough = rho_not_small & sample_counts; // step 12
    wire radius_large = rho_high & sample_counts; // step 12
    wire counted_and_free_now = counted & ~hold; // step 12
    wire sample_teaches = counted_and_free & teaches; // step 13

    // A period that is dropped
    //   where a period ends in which the loop caught up, the search goes back to theta as it is applied
    wire astray_and_not_astray_long_now = astray & not_astray_long_now; // step 0
    wire period_has_hole = astray_and_not_astray_long | catches_up; // step 10
    wire period_dropped_now = travel_clear & period_has_hole; // step 10
    wire not_period_dropped_now = ~period_dropped_now; // step 10
    wire fresh_now = sample_teaches & not_period_dropped; // step 13
    wire signed [24:0] running_1_next_chosen = period_dropped ? theta_1_deviation : running_1; // s25.25, step 17
    wire signed [23:0] running_2_next_chosen = period_dropped ? theta_2_deviation : running_2; // s24.25, step 15
    wire signed [24:0] running_3_next_chosen = period_dropped ? theta_3_deviation : running_3; // s25.25, step 18
    wire signed [23:0] running_4_next_chosen = period_dropped ? theta_4_deviation : running_4; // s24.25, step 16
    wire signed [23:0] running_5_next_chosen_now = // s24.25, step 10
        period_dropped_now ? theta_5_deviation : running_5;

    // Radius, whatever the loop lags behind
    //   radius - 1 = rho + e^2/2
    //   (rho is a projection on the estimate, which is e off the pair: cos(e) - 1 is no error of the sensor)
    wire signed [35:0] e_times_e = product_0[35:0]; // s36.32, step 12

    // Gradient along the radius
    //   rho_c = cos(alpha_hat) rho, rho_s = sin(alpha_hat) rho
    //   (paper section 5.5.1: r + (sin, -cos) e = n (n^T r))
    wire signed [35:0] rho_limited_rounded = {rho[17], rho, 17'h10000} + e_times_e;
    wire signed [14:0] rho_limited_now = // s15.16, step 12
        (rho_limited_rounded[35:31] == {5{rho_limited_rounded[35]}})
            ? rho_limited_rounded[31:17]
            : {rho_limited_rounded[35], {14{~rho_limited_rounded[35]}}};
    wire signed [31:0] cos_hat_times_rho_limited = product_0[31:0]; // s32.32, step 14
    wire signed [17:0] rho_c_now = // s18.18, step 14
        cos_hat_times_rho_limited[31:14] + {17'b0, cos_hat_times_rho_limited[13]};
    wire signed [31:0] sin_hat_times_rho_limited = product_0[31:0]; // s32.32, step 15
    wire signed [17:0] rho_s_now = // s18.18, step 15
        sin_hat_times_rho_limited[31:14] + {17'b0, sin_hat_times_rho_limited[13]};

    // Parameter update
    //   theta -= gamma gradient, each component times a power of two that lets all parameters converge alike; once
    //   gamma has settled (theta_5: by a quarter of it then), the sum over a period of travel where it ends
    //   (paper section 5.5.1, M of equation (7))
    wire signed [13:0] y_5_now = gamma_settled ? {{2{y_c[11]}}, y_c} : {y_c, 2'b0}; // s14.13, step 1
    wire signed [30:0] gradient_5 = product_0[30:0]; // s31.31, step 18
    wire signed [28:0] y_c_times_rho_c = product_0[28:0]; // s29.29, step 16
    wire signed [28:0] y_s_times_rho_s = product_0[28:0]; // s29.29, step 17
    wire lost_in_first_gear = gamma_gear_below_one_now & (signal_lost & ~locked); // step 0
    wire proven_or_unknown = ~search_begun_now | known; // step 0
    wire nominal_now = lost_in_first_gear & proven_or_unknown; // step 0
    wire signed [24:0] step_5_geared = shifted_0; // s25.25, step 18
    wire signed [24:0] step_5_now = fresh ? step_5_geared : 25'sd0; // s25.25, step 18
    wire signed [25:0] running_5_next_difference = // s26.25, step 19
        {{2{running_5_next_chosen[23]}}, running_5_next_chosen} - {step_5[24], step_5};
    wire signed [23:0] running_5_next_bits = // s24.25, step 19
        (running_5_next_difference[25:23] == {3{running_5_next_difference[25]}})
            ? running_5_next_difference[23:0]
            : {running_5_next_difference[25], {23{~running_5_next_difference[25]}}};
    wire signed [28:0] gradient_1 = y_c_times_rho_c; // s29.32, step 16
    wire signed [24:0] step_1_geared = shifted_0; // s25.25, step 16
    wire signed [21:0] step_1_now = fresh ? step_1_geared[21:0] : 22'sd0; // s22.25, step 16
    wire signed [25:0] running_1_next_difference = // s26.25, step 17
        {running_1_next_chosen[24], running_1_next_chosen} - {{4{step_1[21]}}, step_1};
    wire signed [24:0] running_1_next_bits = // s25.25, step 17
        (running_1_next_difference[25] == running_1_next_difference[24])
            ? running_1_next_difference[24:0]
            : {running_1_next_difference[25], {24{~running_1_next_difference[25]}}};
    wire signed [17:0] gradient_2 = rho_c_now; // s18.22, step 14
    wire signed [24:0] step_2_geared_now = shifted_0; // s25.25, step 14
    wire signed [20:0] step_2 = fresh ? step_2_geared[20:0] : 21'sd0; // s21.25, step 15
    wire signed [24:0] running_2_next_difference = // s25.25, step 15
        {running_2_next_chosen[23], running_2_next_chosen} - {{4{step_2[20]}}, step_2};
    wire signed [23:0] running_2_next_bits = // s24.25, step 15
        (running_2_next_difference[24] == running_2_next_difference[23])
            ? running_2_next_difference[23:0]
            : {running_2_next_difference[24], {23{~running_2_next_difference[24]}}};
    wire signed [28:0] gradient_3 = y_s_times_rho_s; // s29.32, step 17
    wire signed [24:0] step_3_geared = shifted_0; // s25.25, step 17
    wire signed [21:0] step_3_now = fresh ? step_3_geared[21:0] : 22'sd0; // s22.25, step 17
    wire signed [25:0] running_3_next_difference = // s26.25, step 18
        {running_3_next_chosen[24], running_3_next_chosen} - {{4{step_3[21]}}, step_3};
    wire signed [24:0] running_3_next_bits = // s25.25, step 18
        (running_3_next_difference[25] == running_3_next_difference[24])
            ? running_3_next_difference[24:0]
            : {running_3_next_difference[25], {24{~running_3_next_difference[25]}}};
    wire signed [17:0] gradient_4 = rho_s_now; // s18.22, step 15
    wire signed [24:0] step_4_geared_now = shifted_0; // s25.25, step 15
    wire signed [20:0] step_4 = fresh ? step_4_geared[20:0] : 21'sd0; // s21.25, step 16
    wire signed [24:0] running_4_next_difference = // s25.25, step 16
        {running_4_next_chosen[23], running_4_next_chosen} - {{4{step_4[20]}}, step_4};
    wire signed [23:0] running_4_next_bits = // s24.25, step 16
        (running_4_next_difference[24] == running_4_next_difference[23])
            ? running_4_next_difference[23:0]
            : {running_4_next_difference[24], {23{~running_4_next_difference[24]}}};

    // Gears of gamma
    //   gamma halves after some periods of travel, starts again when the residual stays large
    wire held_before_now = ~(held_periods < 9'sd1); // step 0
    wire disturbed_again = ~search_begun_now | held_before_now; // step 0
    wire search_fails = ~calm & disturbed_again; // step 0
    wire held_some_periods = ~(held_periods < 9'sh1f); // step 0, with held_periods_last
    wire held_unknown = held_some_periods & ~proven_stand_now; // step 0
    wire held_long_now = ~(held_periods < 9'shff) | held_unknown; // step 0, with hold_periods_last
    wire rises_again = risen & fading; // step 0
    wire restart_cause_now = (search_fails | held_long_now) | rises_again; // step 0
    wire disturbed_period = period_tick & disturbed; // step 12
    wire gamma_restart = disturbed_period & restart_cause; // step 12
    wire gamma_gear_below_gamma_gear_last_now = gamma_gear < 4'sd5; // step 0, with gamma_gear_last
    wire last_gamma_gear_now = ~gamma_gear_below_gamma_gear_last_now; // step 0
    wire returned_lately = returning & ($signed(gear_periods[6:5]) < 2'sd1); // step 0, with returning_periods
    wire gear_periods_done = ~(gear_periods < 7'sd3) & ~returned_lately; // step 0, with gear_periods_last
    wire disturbed_before_now = disturbed | held; // step 0
    wire quiet_now = ~disturbed_before_now; // step 0
    wire gear_done_now = gear_periods_done & quiet_now; // step 0
    wire period_kept = period_tick & not_period_dropped; // step 12
    wire gear_passed = period_kept & gear_done; // step 12
    wire gamma_shift = gear_passed & gamma_gear_below_gamma_gear_last; // step 12
    wire signed [1:0] gamma_gear_up = gamma_shift ? 2'sd1 : 2'sd0; // s2.0, step 12
    wire signed [4:0] gamma_gear_counted_sum = // s5.0, step 12
        {gamma_gear[3], gamma_gear} + {{3{gamma_gear_up[1]}}, gamma_gear_up};
    wire signed [3:0] gamma_gear_counted = {1'b0, gamma_gear_counted_sum[2:0]}; // u3.0, step 12
    wire quiet_period_ends = period_tick & quiet; // step 12
    wire quiet_period_kept = period_kept & quiet; // step 12
    wire signed [1:0] gear_periods_up = quiet_period_kept ? 2'sd1 : 2'sd0; // s2.0, step 12
    wire signed [7:0] gear_periods_next_sum = // s8.0, step 12
        {gear_periods[6], gear_periods} + {{6{gear_periods_up[1]}}, gear_periods_up};
    wire signed [6:0] gear_periods_next_bits = {1'b0, gear_periods_next_sum[5:0]}; // u6.0, step 12
    wire disturbed_period_ends = period_tick & disturbed_before; // step 12
    wire quiet_breaks_off = disturbed_period_ends | not_counting; // step 12
    wire gear_breaks_off = quiet_breaks_off & not_gamma_gear_below_one; // step 12
    wire gear_ends = gear_passed | gamma_restart; // step 12
    wire gear_periods_again = gear_ends | gear_breaks_off; // step 12
    wire signed [1:0] held_periods_up = disturbed_period ? 2'sd1 : 2'sd0; // s2.0, step 12
    wire no_quiet_period_ends = ~quiet_period_ends; // step 12
    wire not_returning_now = ~returning; // step 0
    wire parameters_followed = quiet_period_ends & not_returning; // step 12
    wire free_period = parameters_followed & held_before; // step 12
    wire signed [1:0] held_periods_step = free_period ? 2'sh3 : held_periods_up; // s2.0, step 12
    wire goes_on_or_known = no_quiet_period_ends | known; // step 12
    wire held_periods_go_on = goes_on_or_known & counting; // step 12
    wire held_or_going_on = held_periods_go_on | held; // step 12
    wire held_periods_stay = held_or_going_on & ~gamma_restart; // step 12
    wire signed [9:0] held_periods_next_sum = // s10.0, step 12
        {held_periods[8], held_periods} + {{8{held_periods_step[1]}}, held_periods_step};
    wire signed [8:0] held_periods_next_bits = {1'b0, held_periods_next_sum[7:0]}; // u8.0, step 12
    wire signed [8:0] held_periods_next_now = held_periods_stay ? held_periods_next_bits : 9'sd0; // u8.0, step 12
    wire within_period = ~period_tick & counting; // step 12
    wire not_rough_now = ~rough; // step 0
    wire gear_ends_calm = gear_passed & not_rough; // step 12
    wire stays_calm = (gear_ends_calm | calm) & ~gamma_restart; // step 12
    wire still_held = held & ~period_tick; // step 12
    wire holding = (disturbed_period & ~gamma_restart) | still_held; // step 12
    wire signed [3:0] gamma_gear_searched_now = gamma_restart ? 4'sd0 : gamma_gear_counted; // u3.0, step 12
    wire signed [6:0] gear_periods_next_now = gear_periods_again ? 7'sd0 : gear_periods_next_bits; // u6.0, step 12
    wire first_gear_period = quiet_period_kept & gamma_gear_below_one; // step 12
    wire disturbed_next_now = residual_large | (disturbed & within_period); // step 12
    wire rough_next_now = residual_rough | (rough & within_period); // step 12
    wire risen_next_now = radius_large | (risen & within_period); // step 12
    wire held_next_now = holding & counting; // step 12

    // Recall
    //   held where it is known, or back: theta = proven; after twice gear_periods quiet periods in the last gear:
    //   recent' = theta, proven' = recent if no gain moves
    wire restart_risen = gamma_restart & risen; // step 12
    wire recall_again_now = ((restart_risen & fading) | nominal) & known; // step 12
    wire recall_any_now = (recall | recall_again) | nominal; // step 13
    wire signed [24:0] running_1_next_now = recall_any ? {proven_1, 7'b0} : running_1_next_bits; // s25.25, step 17
    wire signed [23:0] running_2_next_now = recall_any ? {proven_2, 7'b0} : running_2_next_bits; // s24.25, step 15
    wire signed [24:0] running_3_next_now = recall_any ? {proven_3, 7'b0} : running_3_next_bits; // s25.25, step 18
    wire signed [23:0] running_4_next_now = recall_any ? {proven_4, 7'b0} : running_4_next_bits; // s24.25, step 16
    wire signed [23:0] running_5_next = recall_any ? {proven_5, 7'b0} : running_5_next_bits; // s24.25, step 19
    wire known_to_be_calm_now = stays_calm | recall_again_now; // step 12
    wire signed [3:0] gamma_gear_next_now = // u3.0, step 13, with gamma_gear_last
        recall_again ? 4'sd5 : gamma_gear_searched;
    wire last_gear_passed = gear_passed & last_gamma_gear; // step 12
    wire quiet_periods_pass = last_gear_passed & not_returning; // step 12
    wire quiet_periods_end = quiet_periods_pass & halfway; // step 12
    wire signed [10:0] gain_c_inside_bits = theta_1_deviation[24:14]; // s11.11, step 0
    wire signed [10:0] gain_c_rests_bits = recent_1[17:7]; // s11.11, step 0
    wire gain_c_inside = $signed(gain_c_inside_bits[10:6]) < 5'shf; // step 0, with gain_near_bound
    wire signed [11:0] gain_c_rests_difference = // s12.11, step 0
        {gain_c_inside_bits[10], gain_c_inside_bits} - {gain_c_rests_bits[10], gain_c_rests_bits};
    wire gain_c_rests = // step 0, with steady_gain, minus_steady_gain
        ($signed(gain_c_rests_difference[11:2]) < 10'sd1) & ($signed(~gain_c_rests_difference[11:2]) < 10'sd1);
    wire signed [10:0] gain_s_inside_bits = theta_3_deviation[24:14]; // s11.11, step 0
    wire signed [10:0] gain_s_rests_bits = recent_3[17:7]; // s11.11, step 0
    wire gain_s_inside = $signed(gain_s_inside_bits[10:6]) < 5'shf; // step 0, with gain_near_bound
    wire signed [11:0] gain_s_rests_difference = // s12.11, step 0
        {gain_s_inside_bits[10], gain_s_inside_bits} - {gain_s_rests_bits[10], gain_s_rests_bits};
    wire gain_s_rests = // step 0, with steady_gain, minus_steady_gain
        ($signed(gain_s_rests_difference[11:2]) < 10'sd1) & ($signed(~gain_s_rests_difference[11:2]) < 10'sd1);
    wire gains_steady = (gain_c_rests & gain_c_inside) & (gain_s_rests & gain_s_inside); // step 0
    wire proves_now = gains_steady | ~known; // step 0
    wire proved_now = quiet_periods_end & proves; // step 12
    wire not_gains_steady_now = ~gains_steady; // step 0
    wire gain_moved = quiet_periods_end & not_gains_steady; // step 12
    wire nothing_proven_yet_now = ~(known | last_gamma_gear_now); // step 0
    wire remember_now = proved_now | nothing_proven_yet; // step 12
    wire search_improves = (gear_passed | first_gear_period) & gamma_gear_below_gamma_gear_last; // step 12
    wire remember_better_now = search_improves | quiet_periods_end; // step 12
    wire remember_recent_now = remember_better | recall_any_now; // step 13
    wire not_gear_ends_now = ~gear_ends; // step 12
    wire return_goes_on = recall & not_gear_ends; // step 13
    wire signal_changed = restart_risen & not_fading; // step 12
    wire still_known = known & ~signal_changed; // step 12
    wire fades_now = (gamma_restart & held_long) | fading; // step 12
    wire fade_ends_now = (recall_again_now | proved_now) | signal_changed; // step 12
    wire together_again = proved | recall_any_now; // step 13
    wire signed [17:0] recent_1_next_bits = running_1_next[24:7]; // s18.18, step 19
    wire signed [17:0] recent_1_next = remember_recent ? recent_1_next_bits : recent_1; // s18.18, step 19
    wire signed [16:0] recent_2_next_bits = running_2_next[23:7]; // s17.18, step 19
    wire signed [16:0] recent_2_next = remember_recent ? recent_2_next_bits : recent_2; // s17.18, step 19
    wire signed [17:0] recent_3_next_bits = running_3_next[24:7]; // s18.18, step 19
    wire signed [17:0] recent_3_next = remember_recent ? recent_3_next_bits : recent_3; // s18.18, step 19
    wire signed [16:0] recent_4_next_bits = running_4_next[23:7]; // s17.18, step 19
    wire signed [16:0] recent_4_next = remember_recent ? recent_4_next_bits : recent_4; // s17.18, step 19
    wire signed [16:0] recent_5_next_bits = running_5_next[23:7]; // s17.18, step 19
    wire signed [16:0] recent_5_next = remember_recent ? recent_5_next_bits : recent_5; // s17.18, step 19
    wire signed [17:0] proven_1_next = remember ? recent_1 : proven_1; // s18.18, step 19
    wire signed [16:0] proven_2_next = remember ? recent_2 : proven_2; // s17.18, step 19
    wire signed [17:0] proven_3_next = remember ? recent_3 : proven_3; // s18.18, step 19
    wire signed [16:0] proven_4_next = remember ? recent_4 : proven_4; // s17.18, step 19
    wire signed [16:0] proven_5_next = remember ? recent_5 : proven_5; // s17.18, step 19
    wire returning_next_now = return_goes_on | recall_again; // step 13
    wire fading_next_now = fades & ~fade_ends; // step 13
    wire either_halfway_or_quiet_periods_pass_now = halfway ^ quiet_periods_pass; // step 12
    wire halfway_next_now = either_halfway_or_quiet_periods_pass & ~recall_any_now; // step 13
    wire known_next_now = still_known | proved_now; // step 12
    wire gain_moved_or_apart_now = gain_moved | apart; // step 12
    wire apart_next_now = gain_moved_or_apart & ~together_again; // step 13

    // Parameters as they are applied
    //   theta = what the search has found, once gamma has settled where a period of travel ends
    //   (paper section 5.5: static measurements may bias the estimates)
    wire period_taught = fresh_now & whole_period; // step 13
    wire period_breaks_off_now = travel_clear_now & ~whole_period_now; // step 1
    wire travel_ends = period_taught | period_breaks_off; // step 13
    wire search_ends = gamma_gear_below_gamma_gear_settled | travel_ends; // step 13
    wire theta_applies_now = search_ends | recall_any_now; // step 13
    wire signed [24:0] theta_1_deviation_next = theta_applies ? running_1_next : theta_1_deviation; // s25.25, step 19
    wire signed [23:0] theta_2_deviation_next = theta_applies ? running_2_next : theta_2_deviation; // s24.25, step 19
    wire signed [24:0] theta_3_deviation_next = theta_applies ? running_3_next : theta_3_deviation; // s25.25, step 19
    wire signed [23:0] theta_4_deviation_next = theta_applies ? running_4_next : theta_4_deviation; // s24.25, step 19
    wire signed [23:0] theta_5_deviation_next = theta_applies ? running_5_next : theta_5_deviation; // s24.25, step 19

    // Flags
    //   what the machine control needs to know
    wire lost_before_now = lock_lost & ~preset_held; // step 1
    wire lock_falls = locked & ~locked_next; // step 13
    wire lock_lost_next_now = lost_before | lock_falls; // step 13

    // Shifter 0, shared: gamma is a power of two
    reg signed [25:0] unshifted_0;
    always @*
        case (step)
            5'd14: unshifted_0 = {{4{gradient_2[17]}}, gradient_2, 4'b0}; // step_2_geared
            5'd15: unshifted_0 = {{4{gradient_4[17]}}, gradient_4, 4'b0}; // step_4_geared
            5'd16: unshifted_0 = {{3{gradient_1[28]}}, gradient_1[28:6]}; // step_1_geared
            5'd17: unshifted_0 = {{3{gradient_3[28]}}, gradient_3[28:6]}; // step_3_geared
            default: unshifted_0 = gradient_5[30:5];
        endcase
    wire signed [25:0] shift_0 = unshifted_0 >>> gamma_gear[2:0];
    wire signed [24:0] shifted_0 = shift_0[25:1] + {24'b0, shift_0[0]};

    // Multiplier 0
    always @(posedge clk)
        product_0 <= operand_a_0 * operand_b_0;

    always @(posedge clk)
        case (step)
            5'd0: operand_a_0 <= error_previous;
            5'd1: operand_a_0 <= {{2{theta_3[15]}}, theta_3};
            5'd2: operand_a_0 <= {{8{sin_inside[9]}}, sin_inside};
            5'd3: operand_a_0 <= {{8{cos_inside[9]}}, cos_inside};
            5'd4: operand_a_0 <= {{4{theta_5[13]}}, theta_5};
            5'd5: operand_a_0 <= {{2{theta_1[15]}}, theta_1};
            5'd6: operand_a_0 <= s_now;
            5'd7: operand_a_0 <= c_now;
            5'd8: operand_a_0 <= c;
            5'd9: operand_a_0 <= s;
            5'd10: operand_a_0 <= e;
            5'd11: operand_a_0 <= 18'she78e; // loop_a
            5'd12: operand_a_0 <= {{3{rho_limited_now[14]}}, rho_limited_now};
            5'd13: operand_a_0 <= {{3{rho_limited[14]}}, rho_limited};
            5'd14: operand_a_0 <= rho_c_now;
            5'd15: operand_a_0 <= rho_s_now;
            default: operand_a_0 <= {{4{y_5[13]}}, y_5};
        endcase

    always @(posedge clk)
        case (step)
            5'd0: operand_b_0 <= 18'sh9d8d; // loop_ab
            5'd1, 5'd15: operand_b_0 <= {{6{y_s[11]}}, y_s};
            5'd2: operand_b_0 <= {{9{sin_slope[8]}}, sin_slope};
            5'd3: operand_b_0 <= {{9{cos_slope[8]}}, cos_slope};
            5'd4, 5'd5, 5'd14: operand_b_0 <= {{6{y_c[11]}}, y_c};
            5'd6, 5'd8, 5'd12: operand_b_0 <= cos_hat;
            5'd7, 5'd9, 5'd13: operand_b_0 <= sin_hat;
            5'd10: operand_b_0 <= e;
            5'd11: operand_b_0 <= e_change;
            default: operand_b_0 <= rho_s;
        endcase

    // Values that later steps or the testbench read, at the end of the step that computes them
    always @(posedge clk) begin
        if (start) begin
            upper_half <= upper_half_now;
            sin_inside <= sin_inside_now;
            cos_address <= cos_address_now;
            cos_inside <= cos_inside_now;
            cos_negative <= cos_negative_now;
            theta_1 <= theta_1_now;
            theta_3 <= theta_3_now;
            theta_5 <= theta_5_now;
            loop_gear_below_loop_gear_last <= loop_gear_below_loop_gear_last_now;
            last_gear <= last_gear_now;
            not_first_loop_gear <= not_first_loop_gear_now;
            level_again_scaled <= level_again_scaled_now;
            gamma_gear_below_gamma_gear_settled <= gamma_gear_below_gamma_gear_settled_now;
            gamma_settled <= gamma_settled_now;
            sector <= sector_now;
            sector_relative <= sector_relative_now;
            period_ahead <= period_ahead_now;
            period_behind <= period_behind_now;
            a_period_away <= a_period_away_now;
            sector_ahead <= sector_ahead_now;
            sector_behind <= sector_behind_now;
            not_astray_long <= not_astray_long_now;
            gamma_gear_below_one <= gamma_gear_below_one_now;
            not_gamma_gear_below_one <= not_gamma_gear_below_one_now;
            search_begun <= search_begun_now;
            not_fading <= not_fading_now;
            proven_stand <= proven_stand_now;
            held_and_lost <= held_and_lost_now;
            not_apart <= not_apart_now;
            astray_and_not_astray_long <= astray_and_not_astray_long_now;
            nominal <= nominal_now;
            held_before <= held_before_now;
            held_long <= held_long_now;
            restart_cause <= restart_cause_now;
            gamma_gear_below_gamma_gear_last <= gamma_gear_below_gamma_gear_last_now;
            last_gamma_gear <= last_gamma_gear_now;
            disturbed_before <= disturbed_before_now;
            quiet <= quiet_now;
            gear_done <= gear_done_now;
            not_returning <= not_returning_now;
            not_rough <= not_rough_now;
            proves <= proves_now;
            not_gains_steady <= not_gains_steady_now;
            nothing_proven_yet <= nothing_proven_yet_now;
            theta_2 <= theta_2_deviation;
            theta_4 <= theta_4_deviation;
        end
        if (step == 5'd1) begin
            sin_value <= sin_value_now;
            sin_slope <= sin_slope_now;
            counting <= counting_now;
            whole_period <= whole_period_now;
            not_counting <= not_counting_now;
            travel_clear <= travel_clear_now;
            new_sector <= new_sector_now;
            travel_low_next <= travel_low_next_now;
            ahead_used_next <= ahead_used_next_now;
            behind_used_next <= behind_used_next_now;
            y_5 <= y_5_now;
            astray_goes_on <= astray_goes_on_now;
            astray_before_and_astray_goes_on <= astray_before_and_astray_goes_on_now;
            astray_long_and_astray_goes_on <= astray_long_and_astray_goes_on_now;
            period_breaks_off <= period_breaks_off_now;
            lost_before <= lost_before_now;
        end
        if (step == 5'd2) begin
            cos_value <= cos_value_now;
            cos_slope <= cos_slope_now;
            rate_drifted <= rate_drifted_now;
        end
        if (step == 5'd3) begin
            s_exact_sum <= s_exact_sum_now;
        end
        if (step == 5'd4) begin
            sin_hat <= sin_hat_now;
        end
        if (step == 5'd5) begin
            cos_hat <= cos_hat_now;
        end
        if (step == 5'd6) begin
            s <= s_now;
            s_below_weak_signal <= s_below_weak_signal_now;
            not_s_below_minus_weak_signal <= not_s_below_minus_weak_signal_now;
        end
        if (step == 5'd7) begin
            c <= c_now;
            c_below_weak_signal <= c_below_weak_signal_now;
            not_c_below_minus_weak_signal <= not_c_below_minus_weak_signal_now;
            s_weak <= s_weak_now;
        end
        if (step == 5'd8) begin
            signal_lost_next <= signal_lost_next_now;
            s_times_cos_hat <= s_times_cos_hat_now;
            signal_present <= signal_present_now;
            may_flip <= may_flip_now;
        end
        if (step == 5'd9) begin
            e <= e_now;
        end
        if (step == 5'd10) begin
            rho_exact_difference <= rho_exact_difference_now;
            e_in_window <= e_in_window_now;
            e_change <= e_change_now;
            teaches <= teaches_now;
            not_catches_up <= not_catches_up_now;
            across_present <= across_present_now;
            period_dropped <= period_dropped_now;
            not_period_dropped <= not_period_dropped_now;
            running_5_next_chosen <= running_5_next_chosen_now;
            astray_next <= astray_next_now;
            astray_before_next <= astray_before_next_now;
            astray_long_next <= astray_long_next_now;
        end
        if (step == 5'd11) begin
            rho <= rho_now;
            in_window <= in_window_now;
            level_step <= level_step_now;
            half_turn <= half_turn_now;
            loop_follows <= loop_follows_now;
            rho_high <= rho_high_now;
            rho_large <= rho_large_now;
            rho_not_small <= rho_not_small_now;
            calm_and_rho_not_small <= calm_and_rho_not_small_now;
            may_recall <= may_recall_now;
            not_present_anywhere <= not_present_anywhere_now;
        end
        if (step == 5'd12) begin
            level_empty <= level_empty_now;
            loop_gear_up <= loop_gear_up_now;
            level_again <= level_again_now;
            locked_next <= locked_next_now;
            recall <= recall_now;
            counted_and_free <= counted_and_free_now;
            rho_limited <= rho_limited_now;
            held_periods_next <= held_periods_next_now;
            gamma_gear_searched <= gamma_gear_searched_now;
            gear_periods_next <= gear_periods_next_now;
            disturbed_next <= disturbed_next_now;
            rough_next <= rough_next_now;
            risen_next <= risen_next_now;
            held_next <= held_next_now;
            recall_again <= recall_again_now;
            known_to_be_calm <= known_to_be_calm_now;
            proved <= proved_now;
            remember <= remember_now;
            remember_better <= remember_better_now;
            not_gear_ends <= not_gear_ends_now;
            fades <= fades_now;
            fade_ends <= fade_ends_now;
            either_halfway_or_quiet_periods_pass <= either_halfway_or_quiet_periods_pass_now;
            known_next <= known_next_now;
            gain_moved_or_apart <= gain_moved_or_apart_now;
        end
        if (step == 5'd13) begin
            loop_gear_next <= loop_gear_next_now;
            speed_sum <= speed_sum_now;
            fresh <= fresh_now;
            recall_any <= recall_any_now;
            gamma_gear_next <= gamma_gear_next_now;
            remember_recent <= remember_recent_now;
            returning_next <= returning_next_now;
            fading_next <= fading_next_now;
            halfway_next <= halfway_next_now;
            apart_next <= apart_next_now;
            theta_applies <= theta_applies_now;
            lock_lost_next <= lock_lost_next_now;
        end
        if (step == 5'd14) begin
            speed <= speed_now;
            alpha_hat_next <= alpha_hat_next_now;
            count_next_scaled <= count_next_scaled_now;
            direction_next <= direction_next_now;
            rho_c <= rho_c_now;
            step_2_geared <= step_2_geared_now;
        end
        if (step == 5'd15) begin
            count_next <= count_next_now;
            rho_s <= rho_s_now;
            step_4_geared <= step_4_geared_now;
            running_2_next <= running_2_next_now;
        end
        if (step == 5'd16) begin
            step_1 <= step_1_now;
            running_4_next <= running_4_next_now;
        end
        if (step == 5'd17) begin
            step_3 <= step_3_now;
            running_1_next <= running_1_next_now;
        end
        if (step == 5'd18) begin
            step_5 <= step_5_now;
            running_3_next <= running_3_next_now;
        end
    end

    // The sample commits
    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
            alpha_hat <= 0;
            count <= 0;
            rate <= 0;
            error_previous <= 0;
            theta_1_deviation <= 0;
            theta_2_deviation <= 0;
            theta_3_deviation <= 0;
            theta_4_deviation <= 0;
            theta_5_deviation <= 0;
            lock_level <= 0;
            loop_gear <= 0;
            gamma_gear <= 0;
            gear_periods <= 0;
            held_periods <= 0;
            travel_origin <= 0;
            travel_low <= 0;
            travel_high <= 0;
            running_1 <= 0;
            running_2 <= 0;
            running_3 <= 0;
            running_4 <= 0;
            running_5 <= 0;
            recent_1 <= 0;
            recent_2 <= 0;
            recent_3 <= 0;
            recent_4 <= 0;
            recent_5 <= 0;
            proven_1 <= 0;
            proven_2 <= 0;
            proven_3 <= 0;
            proven_4 <= 0;
            proven_5 <= 0;
            locked <= 0;
            lock_lost <= 0;
            signal_lost <= 0;
            direction <= 0;
            ahead_used <= 0;
            behind_used <= 0;
            disturbed <= 0;
            rough <= 0;
            calm <= 0;
            risen <= 0;
            held <= 0;
            astray <= 0;
            astray_before <= 0;
            astray_long <= 0;
            returning <= 0;
            fading <= 0;
            known <= 0;
            halfway <= 0;
            apart <= 0;
        end else if (last) begin
            alpha_hat <= alpha_hat_next;
            count <= count_next;
            rate <= speed;
            error_previous <= e;
            theta_1_deviation <= theta_1_deviation_next;
            theta_2_deviation <= theta_2_deviation_next;
            theta_3_deviation <= theta_3_deviation_next;
            theta_4_deviation <= theta_4_deviation_next;
            theta_5_deviation <= theta_5_deviation_next;
            lock_level <= lock_level_next;
            loop_gear <= loop_gear_next;
            gamma_gear <= gamma_gear_next;
            gear_periods <= gear_periods_next;
            held_periods <= held_periods_next;
            travel_origin <= travel_origin_next;
            travel_low <= travel_low_next;
            travel_high <= travel_high_next;
            running_1 <= running_1_next;
            running_2 <= running_2_next;
            running_3 <= running_3_next;
            running_4 <= running_4_next;
            running_5 <= running_5_next;
            recent_1 <= recent_1_next;
            recent_2 <= recent_2_next;
            recent_3 <= recent_3_next;
            recent_4 <= recent_4_next;
            recent_5 <= recent_5_next;
            proven_1 <= proven_1_next;
            proven_2 <= proven_2_next;
            proven_3 <= proven_3_next;
            proven_4 <= proven_4_next;
            proven_5 <= proven_5_next;
            locked <= locked_next;
            lock_lost <= lock_lost_next;
            signal_lost <= signal_lost_next;
            direction <= direction_next;
            ahead_used <= ahead_used_next;
            behind_used <= behind_used_next;
            disturbed <= disturbed_next;
            rough <= rough_next;
            calm <= known_to_be_calm;
            risen <= risen_next;
            held <= held_next;
            astray <= astray_next;
            astray_before <= astray_before_next;
            astray_long <= astray_long_next;
            returning <= returning_next;
            fading <= fading_next;
            known <= known_next;
            halfway <= halfway_next;
            apart <= apart_next;
        end

    assign position = {count, alpha_hat[26:0]};

    // Bits that nothing in the chip reads: signs that are known, remainders of roundings, what only the testbench reads
    wire unused = &{
        1'b0,
        odd_quadrant_bits[15:0],
        sin_address[16],
        sin_inside_sum[10],
        sin_magnitude_sum[7:0],
        cos_address[8:0],
        cos_address[16],
        cos_inside_sum[10],
        cos_magnitude_sum[7:0],
        theta_1_rounded[10:0],
        theta_3_rounded[10:0],
        c_exact[7:0],
        s_exact[8:0],
        rho_exact[15:0],
        e_exact[14:0],
        in_window,
        loop_gear_next_sum[3:2],
        loop_a_times_e_change[6:0],
        loop_ab_times_error_previous[7:0],
        carry[2],
        count_next_sum[32],
        sector_relative_difference[8],
        rho_limited_rounded[16:0],
        cos_hat_times_rho_limited[12:0],
        rho_c,
        sin_hat_times_rho_limited[12:0],
        gradient_5[4:0],
        gradient_1[5:0],
        step_1_geared[24:22],
        step_2_geared[24:21],
        gradient_3[5:0],
        step_3_geared[24:22],
        step_4_geared[24:21],
        gamma_gear_counted_sum[4:3],
        gear_periods_next_sum[7:6],
        held_periods_next_sum[9:8],
        gain_c_rests_difference[1:0],
        gain_s_rests_difference[1:0]
    };

endmodule

`default_nettype wire
