// ${ title[0] }$
//%- for line in title.iter().skip(1) %//
// ${ line }$
//%- endfor %//
//
//%- for line in purpose %//
// ${ line }$
//%- endfor %//
// After S. Balemi, "Automatic calibration of sinusoidal encoder signals", IFAC 2005; equation numbers are the paper's.
//
// Design ${ hash }$: ${ summary }$.
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
//%- for row in timetable %//
// ${ row }$
//%- endfor %//
//
// Coefficients, by name in the comments below:
//%- for c in constants %//
//   ${ c }$
//%- endfor %//

`default_nettype none
`timescale 1ns / 1ps

module ${ name }$ (
//%- for p in ports %//
    ${ p.0 }$${ p.1 }$ // ${ p.2 }$
//%- endfor %//
);

    // Registers of the chip. All are zero after reset.
//%- for r in state %//
    reg ${ r.range }$${ r.name }$; // ${ r.meaning }$
//%- endfor %//

    // The sample's inputs, held
//%- for r in held %//
    reg ${ r.range }$${ r.name }$_held; // ${ r.meaning }$
//%- endfor %//

    // Values that later steps or the testbench read
//%- for r in kept %//
    reg ${ r.range }$${ r.name }$;
//%- endfor %//

    // Operands and products
//%- for m in multipliers %//
//%- for p in m.ports %//
    reg signed [${ p.bits - 1 }$:0] operand_${ p.letter }$_${ m.index }$;
//%- endfor %//
    reg signed [${ m.a + m.b - 1 }$:0] product_${ m.index }$;
//%- endfor %//

    // Step counter: a sample starts in step 0 and takes ${ clocks }$ steps
    reg [${ step_bits - 1 }$:0] step;
    wire start = (step == ${ step_bits }$'d0) & sample_valid;
    wire last = step == ${ step_bits }$'d${ clocks - 1 }$;

    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
            step <= ${ step_bits }$'d0;
            valid <= 1'b0;
        end else begin
            valid <= last;
            if (last)
                step <= ${ step_bits }$'d0;
            else if (start | (step != ${ step_bits }$'d0))
                step <= step + ${ step_bits }$'d1;
        end

    always @(posedge clk)
        if (start) begin
//%- for l in loads %//
            ${ l.0 }$_held <= ${ l.1 }$;
//%- endfor %//
        end
//%- for r in tables %//

    // Table ${ r.name }$: ${ r.rows }$ rows of ${ r.width }$ bits, a row is there one step after its address
    reg [${ r.width - 1 }$:0] ${ r.name }$ [0:${ r.rows - 1 }$];
    initial $readmemh("coefficients/${ r.name }$.mem", ${ r.name }$);
    reg [${ r.address - 1 }$:0] ${ r.name }$_address;
    reg [${ r.width - 1 }$:0] ${ r.name }$_row;

    always @*
        case (step)
//%- for a in r.reads %//
            ${ step_bits }$'d${ a.0 }$: ${ r.name }$_address = ${ a.1 }$;
//%- endfor %//
            default: ${ r.name }$_address = ${ r.fallback }$;
        endcase

    always @(posedge clk)
        ${ r.name }$_row <= ${ r.name }$[${ r.name }$_address];
//%- endfor %//
//%- for s in sections %//

    // ${ s.title }$
//%- for line in s.equation %//
    //   ${ line }$
//%- endfor %//
//%- if !s.source.is_empty() %//
    //   (${ s.source }$)
//%- endif %//
//%- for line in s.lines %//
    ${ line }$
//%- endfor %//
//%- endfor %//
//%- for u in shifters %//

    // Shifter ${ u.index }$, shared: gamma is a power of two
    reg signed [${ u.bits - 1 }$:0] unshifted_${ u.index }$;
    always @*
        case (step)
//%- for l in u.loads %//
            ${ step_bits }$'d${ l.0 }$: unshifted_${ u.index }$ = ${ l.1 }$; // ${ l.2 }$
//%- endfor %//
            default: unshifted_${ u.index }$ = ${ u.idle }$;
        endcase
//%- for line in u.lines %//
    ${ line }$
//%- endfor %//
//%- endfor %//
//%- for m in multipliers %//

    // Multiplier ${ m.index }$
    always @(posedge clk)
        product_${ m.index }$ <= operand_a_${ m.index }$ * operand_b_${ m.index }$;
//%- for p in m.ports %//

    always @(posedge clk)
        case (step)
//%- for l in p.loads %//
            ${ l.0 }$: operand_${ p.letter }$_${ m.index }$ <= ${ l.1.source }$;${ l.1.comment }$
//%- endfor %//
            default: operand_${ p.letter }$_${ m.index }$ <= ${ p.idle.source }$;${ p.idle.comment }$
        endcase
//%- endfor %//
//%- endfor %//

    // Values that later steps or the testbench read, at the end of the step that computes them
    always @(posedge clk) begin
//%- for c in captures %//
        if (//% if c.0 == 0 %//start//% else %//step == ${ step_bits }$'d${ c.0 }$//% endif %//) begin
//%- for line in c.1 %//
            ${ line }$
//%- endfor %//
        end
//%- endfor %//
    end

    // The sample commits
    always @(posedge clk or negedge rst_n)
        if (!rst_n) begin
//%- for c in commits %//
            ${ c.0 }$ <= 0;
//%- endfor %//
        end else if (last) begin
//%- for c in commits %//
            ${ c.0 }$ <= ${ c.1 }$;
//%- endfor %//
        end

    assign position = {count, alpha_hat[${ alpha_bits - 1 }$:0]};
//%- if !unread.is_empty() %//

    // Bits that nothing in the chip reads: signs that are known, remainders of roundings, what only the testbench reads
    wire unused = &{
        1'b0,
//%- for u in unread %//
        ${ u }$//%- if !loop.last %//,//%- endif %//
//%- endfor %//
    };
//%- endif %//

endmodule

`default_nettype wire
