// Replays vectors/*.vec: rows of `sample a b total negative`.
`default_nettype none
module chip_tb;
    reg               clk = 1'b0;
    reg               rst_n = 1'b0;
    reg               sample_valid = 1'b0;
    reg  signed [7:0] a = 8'sd0;
    reg  signed [7:0] b = 8'sd0;
    wire signed [8:0] total;
    wire              valid;
    wire              negative;

    adder_core dut (
        .clk(clk),
        .rst_n(rst_n),
        .sample_valid(sample_valid),
        .a(a),
        .b(b),
        .total(total),
        .valid(valid),
        .negative(negative)
    );

    initial forever #5 clk = ~clk;

    // The watchdog: no run of this chip takes so long.
    initial begin
        #1000000;
        $display("FAIL watchdog");
        $display("FAIL");
        $finish(0);
    end

    integer failures = 0;
    integer differences;
    integer file;
    integer fields;
    integer sample;
    integer samples;
    reg  signed [8:0] expected_total;
    reg               expected_negative;
    reg  [8*8-1:0]    stimulus;

    task compare(input [8*8-1:0] signal, input integer actual, input integer expected);
        if (actual !== expected && differences == 0) begin
            differences = 1;
            $write("FAIL %0s: ", stimulus);
            $display("signal %0s sample %0d expected %0d actual %0d", signal, sample, expected, actual);
        end
    endtask

    task replay(input [8*8-1:0] name, input [8*24-1:0] path);
        begin
            stimulus = name;
            differences = 0;
            samples = 0;
            rst_n = 1'b0;
            @(negedge clk);
            rst_n = 1'b1;
            file = $fopen(path, "r");
            if (file == 0) begin
                differences = 1;
                $display("FAIL %0s: no file %0s", name, path);
            end else begin
                fields = 5;
                while (fields == 5) begin
                    fields = $fscanf(file, "%d %d %d %d %d", sample, a, b, expected_total, expected_negative);
                    if (fields == 5) begin
                        samples = samples + 1;
                        sample_valid = 1'b1;
                        @(negedge clk);
                        sample_valid = 1'b0;
                        compare("valid", {31'd0, valid}, 1);
                        compare("total", {{23{total[8]}}, total}, {{23{expected_total[8]}}, expected_total});
                        compare("negative", {31'd0, negative}, {31'd0, expected_negative});
                    end
                end
                $fclose(file);
            end
            if (differences == 0) $display("PASS %0s: %0d samples", name, samples);
            failures = failures + differences;
        end
    endtask

    initial begin
        replay("ramp", "vectors/ramp.vec");
        replay("corners", "vectors/corners.vec");
        if (failures == 0) $display("PASS");
        else $display("FAIL");
        $finish(0);
    end
endmodule
`default_nettype wire
