// ${ name }$: sin/cos interpolation chip. ${ description }$
//
// Design ${ hash }$. position is the estimate for the instant of the next sample_valid.

`default_nettype none

module ${ name }$ (
    input  wire clk,
    input  wire rst_n,                         // asynchronous, active low
    input  wire sample_valid,                  // ADC codes are valid; at most every ${ clocks }$ clocks
    input  wire [${ adc_msb }$:0] adc_cos,
    input  wire [${ adc_msb }$:0] adc_sin,
    input  wire preset,                        // with sample_valid: this period becomes number 0
    input  wire calibrate,                     // with sample_valid: parameters may move
    output wire [${ count_bits + alpha_bits - 1 }$:0] position, // periods, ${ alpha_bits }$ fraction bits, two's complement
    output wire signed [${ speed_bits - 1 }$:0] speed, // periods per sample, ${ alpha_bits }$ fraction bits
    output wire valid,                         // one clock per sample: outputs are new
    output wire locked,
    output wire lock_lost,                     // since reset or zero
    output wire signal_lost,
//% for t in thetas %//
    output wire signed [${ t.1 - 1 }$:0] ${ t.0 }$, // ${ t.2 }$ fraction bits
//% endfor %//
    output wire direction                      // 1: backwards
);

    wire signed [${ alpha_bits }$:0] alpha_hat;
    wire signed [${ count_bits - 1 }$:0] count;

    ${ name }$_core core (
        .clk(clk),
        .rst_n(rst_n),
        .sample_valid(sample_valid),
        .adc_cos_pin(adc_cos),
        .adc_sin_pin(adc_sin),
        .preset_pin(preset),
        .calibrate_pin(calibrate),
        .reg_alpha_hat(alpha_hat),
        .reg_count(count),
        .seen_speed(speed),
        .reg_locked(locked),
        .reg_lock_lost(lock_lost),
        .reg_signal_lost(signal_lost),
        .reg_direction(direction),
//% for t in thetas %//
        .seen_${ t.0 }$(${ t.0 }$),
//% endfor %//
        .valid(valid)
    );

    assign position = {count, alpha_hat[${ alpha_bits - 1 }$:0]};

endmodule

`default_nettype wire
