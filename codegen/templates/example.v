// How to instantiate ${ name }$: an ADC with a strobe on one side, a motion controller on the other.
//
// ${ subject }$ needs ${ clocks }$ clocks per sample; at ${ rate }$ samples per second that is a clock of at least
// ${ clock }$ Hz (see ${ name }$.sdc).

`default_nettype none
`timescale 1ns / 1ps

module ${ name }$_example (
    input  wire clk,
    input  wire rst_n,
    input  wire adc_strobe,                    // one clock long, adc_code_* are valid
    input  wire [${ adc_msb }$:0] adc_code_cos,
    input  wire [${ adc_msb }$:0] adc_code_sin,
    input  wire home,                          // makes this period number 0
    output reg signed [${ count_bits + alpha_bits - 1 }$:0] position_now,
    output reg  fault
);

    wire signed [${ count_bits + alpha_bits - 1 }$:0] position;
    wire valid;
//%- for p in outputs %//
    wire ${ p.0 }$${ p.1 }$;
//%- endfor %//

    ${ name }$ interpolator (
        .clk(clk),
        .rst_n(rst_n),
        .sample_valid(adc_strobe),
        .adc_cos(adc_code_cos),
        .adc_sin(adc_code_sin),
        .preset(home),
        .calibrate(1'b1),
//%- for p in outputs %//
        .${ p.1 }$(${ p.1 }$),
//%- endfor %//
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
//%- for p in idle %//
        ${ p }$//%- if !loop.last %//,//%- endif %//
//%- endfor %//
    };

endmodule

`default_nettype wire
