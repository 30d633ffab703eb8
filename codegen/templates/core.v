// ${ name }$_core: the arithmetic of ${ name }$, ${ products }$ products on ${ multipliers }$ multiplier(s), ${ clocks }$ clocks a sample.
//
// Design ${ hash }$. Every number is a signed integer; its point is the design's business (design.json).
// A value x is computed as x_now in one cycle; where it is needed later, the register x keeps it.
// Registers of the chip change together at the end of the last step.

`default_nettype none

module ${ name }$_core (
    input  wire clk,
    input  wire rst_n,
    input  wire sample_valid,                  // one clock per sample; next one at least ${ clocks }$ clocks later
    input  wire [${ adc_msb }$:0] adc_cos_pin,
    input  wire [${ adc_msb }$:0] adc_sin_pin,
    input  wire preset_pin,
    input  wire calibrate_pin,
//% for p in ports %//
    output wire ${ p.0 }$${ p.1 }$,
//% endfor %//
    output reg  valid                          // the sample is done, all outputs are of one sample
);

    // Coefficients
//% for c in constants %//
    ${ c }$
//% endfor %//

    // Registers of the chip, ADC codes, operands and products, values kept between steps
//% for r in registers %//
    ${ r.0 }$;
//% endfor %//
//% for r in inputs %//
    ${ r.0 }$;
//% endfor %//
//% for r in captured_names %//
    ${ r.0 }$;
//% endfor %//
//% for r in probes %//
    ${ r.0 }$;
//% endfor %//
//% for m in units %//
    reg signed [${ m.a - 1 }$:0] operand_a_${ m.index }$;
    reg signed [${ m.b - 1 }$:0] operand_b_${ m.index }$;
    reg signed [${ m.a + m.b - 1 }$:0] product_${ m.index }$;
//% endfor %//
    reg [${ step_bits - 1 }$:0] step;
    wire start = (step == ${ step_bits }$'d0) & sample_valid;

    // Sine table: a row is there one step after its address
//% for r in roms %//
    reg [${ r.width - 1 }$:0] ${ r.name }$ [0:${ r.rows - 1 }$];
    reg [${ r.width - 1 }$:0] ${ r.name }$_row;
    initial $readmemh("coefficients/${ r.name }$.mem", ${ r.name }$);
    reg [${ r.address - 1 }$:0] ${ r.name }$_address;
//% endfor %//

//% for s in sections %//
    // ${ s.0 }$
    //   ${ s.1 }$
    //   ${ s.2 }$
//% for w in s.3 %//
//% for line in w.lines %//
    ${ line }$
//% endfor %//
//% endfor %//

//% endfor %//
//% for r in roms %//
    always @* begin
        case (step)
//% for a in r.reads %//
            ${ step_bits }$'d${ a.0 }$: ${ r.name }$_address = ${ a.1 }$;
//% endfor %//
            default: ${ r.name }$_address = ${ r.fallback }$;
        endcase
    end

    always @(posedge clk)
        ${ r.name }$_row <= ${ r.name }$[${ r.name }$_address];

//% endfor %//
//% for m in units %//
    // Multiplier ${ m.index }$
    always @(posedge clk) begin
        product_${ m.index }$ <= operand_a_${ m.index }$ * operand_b_${ m.index }$;
        case (step)
//% for o in m.loads %//
            ${ step_bits }$'d${ o.0 }$: begin // ${ o.3 }$
                operand_a_${ m.index }$ <= ${ o.1 }$;
                operand_b_${ m.index }$ <= ${ o.2 }$;
            end
//% endfor %//
            default: begin
                operand_a_${ m.index }$ <= ${ m.idle_a }$;
                operand_b_${ m.index }$ <= ${ m.idle_b }$;
            end
        endcase
    end

//% endfor %//
    // Step counter, ADC codes, values that later steps need
    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
            step <= ${ step_bits }$'d0;
            valid <= 1'b0;
        end else begin
            valid <= step == ${ step_bits }$'d${ clocks - 1 }$;
            if (step == ${ step_bits }$'d${ clocks - 1 }$)
                step <= ${ step_bits }$'d0;
            else if (start | (step != ${ step_bits }$'d0))
                step <= step + ${ step_bits }$'d1;
        end

    always @(posedge clk) begin
        if (start) begin
            adc_cos <= ${ adc_cos }$;
            adc_sin <= ${ adc_sin }$;
            preset <= preset_pin;
            calibrate <= calibrate_pin;
        end
//% for c in captured %//
        if (step == ${ step_bits }$'d${ c.0 }$) ${ c.1 }$
//% endfor %//
    end

    // The sample commits
    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
//% for r in registers %//
            ${ r.1 }$ <= 0;
//% endfor %//
        end else if (step == ${ step_bits }$'d${ clocks - 1 }$) begin
//% for r in registers %//
            ${ r.1 }$ <= ${ r.2 }$;
//% endfor %//
        end

    always @(posedge clk)
        if (step == ${ step_bits }$'d${ clocks - 1 }$) begin
//% for r in probes %//
            probe_${ r.1 }$ <= ${ r.2 }$;
//% endfor %//
        end

//% for p in ports %//
    assign ${ p.1 }$ = ${ p.2 }$;
//% endfor %//

endmodule

`default_nettype wire
