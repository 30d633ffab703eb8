// Testbench of ${ name }$: plays the vectors and compares every probe, register and output after every sample.
//
// Run from the folder above: iverilog -g2005 -o chip_tb.vvp rtl/*.v tb/*.v && vvp chip_tb.vvp
//
// A vector row is: sample number, adc_cos, adc_sin, preset, calibrate, then one column per signal below, in hex.

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
    wire signed [${ count_bits + alpha_bits - 1 }$:0] position;
//%- for p in outputs %//
    wire ${ p.0 }$${ p.1 }$;
//%- endfor %//

    ${ name }$ chip (
        .clk(clk),
        .rst_n(rst_n),
        .sample_valid(sample_valid),
        .adc_cos(adc_cos),
        .adc_sin(adc_sin),
        .preset(preset),
        .calibrate(calibrate),
//%- for p in outputs %//
        .${ p.1 }$(${ p.1 }$),
//%- endfor %//
        .position(position),
        .valid(valid)
    );

    // What the model says
//%- for p in columns %//
    reg ${ p.0 }$expect_${ p.1 }$;
//%- endfor %//
    reg [${ count_bits + alpha_bits - 1 }$:0] expect_position;

    integer file;
    integer got;
    integer waited;
    integer played;
    reg [31:0] sample;
    reg bad;
    reg any_bad = 1'b0;

    task check_failed(input [8*32-1:0] signal, input [127:0] expected, input [127:0] actual);
        if (!bad) begin
            bad = 1'b1;
            $display("signal %0s sample %0d expected %0h actual %0h", signal, sample, expected, actual);
        end
    endtask

    // The stimulus that is played
    integer stimulus;
    reg [8*64-1:0] path;
    reg [8*32-1:0] name;
    integer rows;

    task play;
        begin
            bad = 1'b0;
            played = 0;
            file = $fopen(path, "r");
            rst_n = 1'b0;
            @(negedge clk);
            @(negedge clk);
            rst_n = 1'b1;
            if (file == 0) begin
                bad = 1'b1;
                $display("cannot open the vectors of %0s", name);
            end
            while (!bad && played != rows) begin
                got = $fscanf(file, "%h %h %h %h %h", sample, adc_cos, adc_sin, preset, calibrate);
//%- for part in scans %//
                got = got + $fscanf(file, "${ part.0 }$",
                    ${ part.1 }$);
//%- endfor %//
                // No wire: Verilator does not notice what $fscanf changes.
                expect_position = {expect_count, expect_alpha_hat[${ alpha_bits - 1 }$:0]};
                if (got != ${ fields }$) begin
                    bad = 1'b1;
                    $display("row %0d of %0s cannot be read", played, name);
                end else if (sample != played) begin
                    bad = 1'b1;
                    $display("row %0d of %0s is of sample %0d", played, name, sample);
                end else begin
                    sample_valid = 1'b1;
                    @(negedge clk);
                    sample_valid = 1'b0;
                    // What is on the pins between samples must not matter.
                    adc_cos = ~adc_cos;
                    adc_sin = ~adc_sin;
                    preset = ~preset;
                    calibrate = ~calibrate;
                    waited = 1;
                    // The watchdog: a chip that hangs is late.
                    while (!valid && waited <= ${ clocks }$) begin
                        // A strobe that comes too early must not matter either.
                        sample_valid = sample[2:0] == 3'd5 && waited == 1;
                        @(negedge clk);
                        sample_valid = 1'b0;
                        waited = waited + 1;
                    end
                    if (waited != ${ clocks }$) check_failed("latency", ${ clocks }$, {96'd0, waited});
                    // In the order of the data flow: the first that differs is nearest to the cause.
//%- for p in flow %//
                    if (${ p.0 }$${ p.1 }$ !== expect_${ p.1 }$)
                        check_failed("${ p.1 }$",
                            {${ 128 - p.2 }$'d0, expect_${ p.1 }$}, {${ 128 - p.2 }$'d0, ${ p.0 }$${ p.1 }$});
//%- endfor %//
                    if (position !== expect_position)
                        check_failed("position", {${ 128 - count_bits - alpha_bits }$'d0, expect_position}, {${ 128 - count_bits - alpha_bits }$'d0, position});
                    // Some samples come later than they might: until then nothing moves, and valid is one clock long.
                    if (sample[1:0] == 2'd2) begin
                        repeat (${ clocks }$ + 2) begin
                            @(negedge clk);
                            if (valid) check_failed("valid", 128'd0, 128'd1);
                        end
//%- for p in flow if p.0.is_empty() %//
                        if (${ p.1 }$ !== expect_${ p.1 }$)
                            check_failed("${ p.1 }$",
                                {${ 128 - p.2 }$'d0, expect_${ p.1 }$}, {${ 128 - p.2 }$'d0, ${ p.1 }$});
//%- endfor %//
                        if (position !== expect_position)
                            check_failed("position", {${ 128 - count_bits - alpha_bits }$'d0, expect_position}, {${ 128 - count_bits - alpha_bits }$'d0, position});
                    end
                    played = played + 1;
                end
            end
            if (bad) begin
                any_bad = 1'b1;
                $display("FAIL %0s", name);
            end else
                $display("PASS %0s: %0d samples", name, played);
            $fclose(file);
        end
    endtask

    // Played in one place: Verilator compiles a task, or the inside of a loop that it can count, once for each time.
    reg finished = 1'b0;
    initial begin
        stimulus = 0;
        while (!finished) begin
            case (stimulus)
//%- for s in stimuli %//
                ${ loop.index0 }$: begin path = "vectors/${ s.0 }$.vec"; name = "${ s.0 }$"; rows = ${ s.1 }$; end
//%- endfor %//
                default: finished = 1'b1;
            endcase
            // With +stop_at_first nothing is played after a stimulus that failed.
            if (any_bad && $test$plusargs("stop_at_first")) finished = 1'b1;
            if (!finished) play;
            stimulus = stimulus + 1;
        end
        if (any_bad) $display("FAIL");
        else $display("PASS");
        $finish(0);
    end
endmodule

`default_nettype wire
