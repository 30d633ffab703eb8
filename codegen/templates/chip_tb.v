// Testbench of ${ name }$: plays the vectors and compares every probe and register after every sample.
//
// Run from the folder above: iverilog -g2005 -o chip_tb.vvp rtl/*.v tb/*.v && vvp chip_tb.vvp

`default_nettype none
`timescale 1ns / 1ps

module chip_tb;
    reg clk = 1'b0;
    initial forever #5 clk = ~clk;

    reg rst_n = 1'b0;
    reg sample_valid = 1'b0;
    reg [${ adc_msb }$:0] adc_cos = 0;
    reg [${ adc_msb }$:0] adc_sin = 0;
    reg preset = 1'b0;
    reg calibrate = 1'b0;
    wire valid;
//% for p in ports %//
    wire ${ p.0 }$${ p.1 }$;
    reg ${ p.0 }$expect_${ p.1 }$;
//% endfor %//
    wire [${ count_bits + alpha_bits - 1 }$:0] position;
    wire top_valid;
    wire top_locked;

    ${ name }$_core core (
        .clk(clk), .rst_n(rst_n), .sample_valid(sample_valid), .adc_cos_pin(adc_cos), .adc_sin_pin(adc_sin),
        .preset_pin(preset), .calibrate_pin(calibrate),
//% for p in ports %//
        .${ p.1 }$(${ p.1 }$),
//% endfor %//
        .valid(valid)
    );

    ${ name }$ chip (
        .clk(clk), .rst_n(rst_n), .sample_valid(sample_valid), .adc_cos(adc_cos), .adc_sin(adc_sin),
        .preset(preset), .calibrate(calibrate), .position(position), .speed(), .valid(top_valid), .locked(top_locked),
        .lock_lost(), .signal_lost(),
//% for t in thetas %//
        .${ t.0 }$(),
//% endfor %//
        .direction()
    );

    integer file;
    integer got;
    integer waited;
    reg [31:0] sample;
    reg [31:0] expected_samples;
    reg bad;
    reg any_bad = 1'b0;

    task check_failed(input [8*32-1:0] signal, input [127:0] expected, input [127:0] actual);
        if (!bad) begin
            bad = 1'b1;
            $display("signal %0s sample %0d expected %0h actual %0h", signal, sample, expected, actual);
        end
    endtask

    task play(input [8*64-1:0] path, input [8*32-1:0] name, input integer rows);
        begin
            bad = 1'b0;
            expected_samples = 0;
            file = $fopen(path, "r");
            rst_n = 1'b0;
            @(negedge clk);
            @(negedge clk);
            rst_n = 1'b1;
            if (file == 0) begin
                bad = 1'b1;
                $display("cannot open the vectors of %0s", name);
            end
            got = ${ columns }$;
            while (!bad && expected_samples != rows) begin
                got = $fscanf(file, "${ scan }$"${ scan_args }$);
                if (got != ${ columns }$) begin
                    bad = 1'b1;
                    $display("row %0d of %0s cannot be read", expected_samples, name);
                end else begin
                    sample_valid = 1'b1;
                    @(negedge clk);
                    sample_valid = 1'b0;
                    waited = 1;
                    while (!valid && waited <= ${ clocks }$) begin
                        @(negedge clk);
                        waited = waited + 1;
                    end
                    if (waited != ${ clocks }$) check_failed("latency", ${ clocks }$, waited);
                    if (top_valid !== valid) check_failed("valid", {127'd0, valid}, {127'd0, top_valid});
                    if (position !== {reg_count, reg_alpha_hat[${ alpha_bits - 1 }$:0]}) check_failed("position", 0, 1);
                    if (top_locked !== reg_locked) check_failed("locked", 0, 1);
//% for p in ports %//
                    if (${ p.1 }$ !== expect_${ p.1 }$) check_failed("${ p.1 }$", {${ 128 - p.3 }$'d0, expect_${ p.1 }$}, {${ 128 - p.3 }$'d0, ${ p.1 }$});
//% endfor %//
                    expected_samples = expected_samples + 1;
                end
            end
            if (bad) begin
                any_bad = 1'b1;
                $display("FAIL %0s", name);
            end else
                $display("PASS %0s: %0d samples", name, expected_samples);
            $fclose(file);
        end
    endtask

    initial begin
//% for s in stimuli %//
        play("vectors/${ s.0 }$.vec", "${ s.0 }$", ${ s.1 }$);
//% endfor %//
        if (any_bad) $display("FAIL");
        else $display("PASS");
        $finish(0);
    end
endmodule

`default_nettype wire
