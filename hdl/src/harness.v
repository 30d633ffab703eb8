// Places a chip that has more ports than the device has pins.
//
// Its inputs come from a shift register; its outputs are caught all at once in a second one
// and leave it bit by bit. Every output bit has a flip-flop and a multiplexer of its own, so
// no output can cancel against another and none is swept away. The chip is mapped to cells
// before it meets the harness, and nothing is optimised across the border afterwards.
`default_nettype none
module nonius_harness (
    input  wire clk,
    input  wire rst_n,
    input  wire serial_in,
    input  wire load,
    output wire serial_out
);
    localparam INPUTS = @INPUTS@;
    localparam OUTPUTS = @OUTPUTS@;

    reg  [INPUTS:0]    in;
    reg  [OUTPUTS-1:0] out;
    reg                load_now;
    wire [OUTPUTS-1:0] caught;

    always @(posedge clk) begin
        in <= {in[INPUTS-1:0], serial_in};
        load_now <= load;
        out <= load_now ? {1'b0, caught} : {out, in[INPUTS]};
    end
    assign serial_out = out[OUTPUTS-1];

    @CHIP@ chip (@CONNECTIONS@);
endmodule
`default_nettype wire
