// How to instantiate optical: an ADC with a strobe on one side, a motion controller on the other.
//
// optical needs 20 clocks per sample; at 1000000 samples per second that is a clock of at least
// 20000000 Hz (see optical.sdc).

`default_nettype none
`timescale 1ns / 1ps

module optical_example (
    input  wire clk,
    input  wire rst_n,
    input  wire adc_strobe,                    // one clock long, adc_code_* are valid
    input  wire [11:0] adc_code_cos,
    input  wire [11:0] adc_code_sin,
    input  wire home,                          // makes this period number 0
    output reg signed [58:0] position_now,
    output reg  fault
);

    wire signed [58:0] position;
    wire valid;
    wire signed [15:0] theta_1;
    wire signed [23:0] theta_2;
    wire signed [15:0] theta_3;
    wire signed [23:0] theta_4;
    wire signed [13:0] theta_5;
    wire signed [25:0] speed;
    wire locked;
    wire lock_lost;
    wire signal_lost;
    wire direction;

    optical interpolator (
        .clk(clk),
        .rst_n(rst_n),
        .sample_valid(adc_strobe),
        .adc_cos(adc_code_cos),
        .adc_sin(adc_code_sin),
        .preset(home),
        .calibrate(1'b1),
        .theta_1(theta_1),
        .theta_2(theta_2),
        .theta_3(theta_3),
        .theta_4(theta_4),
        .theta_5(theta_5),
        .speed(speed),
        .locked(locked),
        .lock_lost(lock_lost),
        .signal_lost(signal_lost),
        .direction(direction),
        .position(position),
        .valid(valid)
    );

    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
            position_now <= 0;
            fault <= 1'b1;
        end else if (valid) begin
            position_now <= position;
            fault <= ~locked | signal_lost;
        end

    // What this example has no use for
    wire unused = &{
        1'b0,
        theta_1,
        theta_2,
        theta_3,
        theta_4,
        theta_5,
        speed,
        lock_lost,
        direction
    };

endmodule

`default_nettype wire
