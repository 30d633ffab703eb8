// total = a + b, one clock later. Probe: negative.
`default_nettype none
module adder_core (
    input  wire              clk,
    input  wire              rst_n,
    input  wire              sample_valid,
    input  wire signed [7:0] a,
    input  wire signed [7:0] b,
    output reg  signed [8:0] total,
    output reg               valid,
    output wire              negative
);
    assign negative = total[8];

    always @(posedge clk)
        if (!rst_n) begin
            total <= 9'sd0;
            valid <= 1'b0;
        end else begin
            valid <= sample_valid;
            if (sample_valid) total <= a + b;
        end
endmodule
`default_nettype wire
