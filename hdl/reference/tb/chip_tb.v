// Testbench of optical: plays the vectors and compares every probe, register and output after every sample.
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
    reg [11:0] adc_cos = 0;
    reg [11:0] adc_sin = 0;
    reg preset = 1'b0;
    reg calibrate = 1'b0;
    wire valid;
    wire signed [58:0] position;
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

    optical chip (
        .clk(clk),
        .rst_n(rst_n),
        .sample_valid(sample_valid),
        .adc_cos(adc_cos),
        .adc_sin(adc_sin),
        .preset(preset),
        .calibrate(calibrate),
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

    // What the model says
    reg signed [11:0] expect_y_c;
    reg signed [11:0] expect_y_s;
    reg signed [15:0] expect_theta_1;
    reg signed [23:0] expect_theta_2;
    reg signed [15:0] expect_theta_3;
    reg signed [23:0] expect_theta_4;
    reg signed [13:0] expect_theta_5;
    reg signed [17:0] expect_c;
    reg signed [17:0] expect_s;
    reg signed [17:0] expect_cos_hat;
    reg signed [17:0] expect_sin_hat;
    reg signed [17:0] expect_e;
    reg signed [17:0] expect_rho;
    reg signed [17:0] expect_rho_c;
    reg signed [17:0] expect_rho_s;
    reg signed [25:0] expect_speed;
    reg expect_in_window;
    reg expect_fresh;
    reg expect_whole_period;
    reg signed [27:0] expect_alpha_hat;
    reg signed [31:0] expect_count;
    reg signed [25:0] expect_rate;
    reg signed [17:0] expect_error_previous;
    reg signed [24:0] expect_theta_1_deviation;
    reg signed [23:0] expect_theta_2_deviation;
    reg signed [24:0] expect_theta_3_deviation;
    reg signed [23:0] expect_theta_4_deviation;
    reg signed [23:0] expect_theta_5_deviation;
    reg signed [6:0] expect_lock_level;
    reg signed [2:0] expect_loop_gear;
    reg signed [3:0] expect_gamma_gear;
    reg signed [6:0] expect_gear_periods;
    reg signed [8:0] expect_held_periods;
    reg signed [7:0] expect_travel_origin;
    reg signed [7:0] expect_travel_low;
    reg signed [7:0] expect_travel_high;
    reg signed [24:0] expect_running_1;
    reg signed [23:0] expect_running_2;
    reg signed [24:0] expect_running_3;
    reg signed [23:0] expect_running_4;
    reg signed [23:0] expect_running_5;
    reg signed [17:0] expect_recent_1;
    reg signed [16:0] expect_recent_2;
    reg signed [17:0] expect_recent_3;
    reg signed [16:0] expect_recent_4;
    reg signed [16:0] expect_recent_5;
    reg signed [17:0] expect_proven_1;
    reg signed [16:0] expect_proven_2;
    reg signed [17:0] expect_proven_3;
    reg signed [16:0] expect_proven_4;
    reg signed [16:0] expect_proven_5;
    reg expect_locked;
    reg expect_lock_lost;
    reg expect_signal_lost;
    reg expect_direction;
    reg expect_ahead_used;
    reg expect_behind_used;
    reg expect_disturbed;
    reg expect_rough;
    reg expect_calm;
    reg expect_risen;
    reg expect_held;
    reg expect_astray;
    reg expect_astray_before;
    reg expect_astray_long;
    reg expect_returning;
    reg expect_fading;
    reg expect_known;
    reg expect_halfway;
    reg expect_apart;
    reg [58:0] expect_position;

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
                got = got + $fscanf(file, "%h %h %h",
                    expect_y_c, expect_y_s, expect_theta_1);
                got = got + $fscanf(file, "%h %h %h",
                    expect_theta_2, expect_theta_3, expect_theta_4);
                got = got + $fscanf(file, "%h %h %h",
                    expect_theta_5, expect_c, expect_s);
                got = got + $fscanf(file, "%h %h %h",
                    expect_cos_hat, expect_sin_hat, expect_e);
                got = got + $fscanf(file, "%h %h %h",
                    expect_rho, expect_rho_c, expect_rho_s);
                got = got + $fscanf(file, "%h %h %h",
                    expect_speed, expect_in_window, expect_fresh);
                got = got + $fscanf(file, "%h %h %h",
                    expect_whole_period, expect_alpha_hat, expect_count);
                got = got + $fscanf(file, "%h %h %h",
                    expect_rate, expect_error_previous, expect_theta_1_deviation);
                got = got + $fscanf(file, "%h %h %h",
                    expect_theta_2_deviation, expect_theta_3_deviation, expect_theta_4_deviation);
                got = got + $fscanf(file, "%h %h %h",
                    expect_theta_5_deviation, expect_lock_level, expect_loop_gear);
                got = got + $fscanf(file, "%h %h %h",
                    expect_gamma_gear, expect_gear_periods, expect_held_periods);
                got = got + $fscanf(file, "%h %h %h",
                    expect_travel_origin, expect_travel_low, expect_travel_high);
                got = got + $fscanf(file, "%h %h %h",
                    expect_running_1, expect_running_2, expect_running_3);
                got = got + $fscanf(file, "%h %h %h",
                    expect_running_4, expect_running_5, expect_recent_1);
                got = got + $fscanf(file, "%h %h %h",
                    expect_recent_2, expect_recent_3, expect_recent_4);
                got = got + $fscanf(file, "%h %h %h",
                    expect_recent_5, expect_proven_1, expect_proven_2);
                got = got + $fscanf(file, "%h %h %h",
                    expect_proven_3, expect_proven_4, expect_proven_5);
                got = got + $fscanf(file, "%h %h %h",
                    expect_locked, expect_lock_lost, expect_signal_lost);
                got = got + $fscanf(file, "%h %h %h",
                    expect_direction, expect_ahead_used, expect_behind_used);
                got = got + $fscanf(file, "%h %h %h",
                    expect_disturbed, expect_rough, expect_calm);
                got = got + $fscanf(file, "%h %h %h",
                    expect_risen, expect_held, expect_astray);
                got = got + $fscanf(file, "%h %h %h",
                    expect_astray_before, expect_astray_long, expect_returning);
                got = got + $fscanf(file, "%h %h %h",
                    expect_fading, expect_known, expect_halfway);
                got = got + $fscanf(file, "%h",
                    expect_apart);
                // No wire: Verilator does not notice what $fscanf changes.
                expect_position = {expect_count, expect_alpha_hat[26:0]};
                if (got != 75) begin
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
                    while (!valid && waited <= 20) begin
                        // A strobe that comes too early must not matter either.
                        sample_valid = sample[2:0] == 3'd5 && waited == 1;
                        @(negedge clk);
                        sample_valid = 1'b0;
                        waited = waited + 1;
                    end
                    if (waited != 20) check_failed("latency", 20, {96'd0, waited});
                    // In the order of the data flow: the first that differs is nearest to the cause.
                    if (theta_2 !== expect_theta_2)
                        check_failed("theta_2",
                            {104'd0, expect_theta_2}, {104'd0, theta_2});
                    if (theta_4 !== expect_theta_4)
                        check_failed("theta_4",
                            {104'd0, expect_theta_4}, {104'd0, theta_4});
                    if (chip.sin_hat !== expect_sin_hat)
                        check_failed("sin_hat",
                            {110'd0, expect_sin_hat}, {110'd0, chip.sin_hat});
                    if (chip.cos_hat !== expect_cos_hat)
                        check_failed("cos_hat",
                            {110'd0, expect_cos_hat}, {110'd0, chip.cos_hat});
                    if (chip.y_c !== expect_y_c)
                        check_failed("y_c",
                            {116'd0, expect_y_c}, {116'd0, chip.y_c});
                    if (chip.y_s !== expect_y_s)
                        check_failed("y_s",
                            {116'd0, expect_y_s}, {116'd0, chip.y_s});
                    if (theta_1 !== expect_theta_1)
                        check_failed("theta_1",
                            {112'd0, expect_theta_1}, {112'd0, theta_1});
                    if (theta_3 !== expect_theta_3)
                        check_failed("theta_3",
                            {112'd0, expect_theta_3}, {112'd0, theta_3});
                    if (theta_5 !== expect_theta_5)
                        check_failed("theta_5",
                            {114'd0, expect_theta_5}, {114'd0, theta_5});
                    if (chip.c !== expect_c)
                        check_failed("c",
                            {110'd0, expect_c}, {110'd0, chip.c});
                    if (chip.s !== expect_s)
                        check_failed("s",
                            {110'd0, expect_s}, {110'd0, chip.s});
                    if (signal_lost !== expect_signal_lost)
                        check_failed("signal_lost",
                            {127'd0, expect_signal_lost}, {127'd0, signal_lost});
                    if (chip.rho !== expect_rho)
                        check_failed("rho",
                            {110'd0, expect_rho}, {110'd0, chip.rho});
                    if (chip.e !== expect_e)
                        check_failed("e",
                            {110'd0, expect_e}, {110'd0, chip.e});
                    if (chip.error_previous !== expect_error_previous)
                        check_failed("error_previous",
                            {110'd0, expect_error_previous}, {110'd0, chip.error_previous});
                    if (chip.in_window !== expect_in_window)
                        check_failed("in_window",
                            {127'd0, expect_in_window}, {127'd0, chip.in_window});
                    if (locked !== expect_locked)
                        check_failed("locked",
                            {127'd0, expect_locked}, {127'd0, locked});
                    if (chip.lock_level !== expect_lock_level)
                        check_failed("lock_level",
                            {121'd0, expect_lock_level}, {121'd0, chip.lock_level});
                    if (chip.loop_gear !== expect_loop_gear)
                        check_failed("loop_gear",
                            {125'd0, expect_loop_gear}, {125'd0, chip.loop_gear});
                    if (speed !== expect_speed)
                        check_failed("speed",
                            {102'd0, expect_speed}, {102'd0, speed});
                    if (chip.rate !== expect_rate)
                        check_failed("rate",
                            {102'd0, expect_rate}, {102'd0, chip.rate});
                    if (chip.alpha_hat !== expect_alpha_hat)
                        check_failed("alpha_hat",
                            {100'd0, expect_alpha_hat}, {100'd0, chip.alpha_hat});
                    if (chip.count !== expect_count)
                        check_failed("count",
                            {96'd0, expect_count}, {96'd0, chip.count});
                    if (direction !== expect_direction)
                        check_failed("direction",
                            {127'd0, expect_direction}, {127'd0, direction});
                    if (chip.whole_period !== expect_whole_period)
                        check_failed("whole_period",
                            {127'd0, expect_whole_period}, {127'd0, chip.whole_period});
                    if (chip.travel_origin !== expect_travel_origin)
                        check_failed("travel_origin",
                            {120'd0, expect_travel_origin}, {120'd0, chip.travel_origin});
                    if (chip.travel_low !== expect_travel_low)
                        check_failed("travel_low",
                            {120'd0, expect_travel_low}, {120'd0, chip.travel_low});
                    if (chip.travel_high !== expect_travel_high)
                        check_failed("travel_high",
                            {120'd0, expect_travel_high}, {120'd0, chip.travel_high});
                    if (chip.ahead_used !== expect_ahead_used)
                        check_failed("ahead_used",
                            {127'd0, expect_ahead_used}, {127'd0, chip.ahead_used});
                    if (chip.behind_used !== expect_behind_used)
                        check_failed("behind_used",
                            {127'd0, expect_behind_used}, {127'd0, chip.behind_used});
                    if (chip.fresh !== expect_fresh)
                        check_failed("fresh",
                            {127'd0, expect_fresh}, {127'd0, chip.fresh});
                    if (chip.rho_c !== expect_rho_c)
                        check_failed("rho_c",
                            {110'd0, expect_rho_c}, {110'd0, chip.rho_c});
                    if (chip.rho_s !== expect_rho_s)
                        check_failed("rho_s",
                            {110'd0, expect_rho_s}, {110'd0, chip.rho_s});
                    if (chip.held_periods !== expect_held_periods)
                        check_failed("held_periods",
                            {119'd0, expect_held_periods}, {119'd0, chip.held_periods});
                    if (chip.gear_periods !== expect_gear_periods)
                        check_failed("gear_periods",
                            {121'd0, expect_gear_periods}, {121'd0, chip.gear_periods});
                    if (chip.disturbed !== expect_disturbed)
                        check_failed("disturbed",
                            {127'd0, expect_disturbed}, {127'd0, chip.disturbed});
                    if (chip.rough !== expect_rough)
                        check_failed("rough",
                            {127'd0, expect_rough}, {127'd0, chip.rough});
                    if (chip.risen !== expect_risen)
                        check_failed("risen",
                            {127'd0, expect_risen}, {127'd0, chip.risen});
                    if (chip.held !== expect_held)
                        check_failed("held",
                            {127'd0, expect_held}, {127'd0, chip.held});
                    if (chip.running_1 !== expect_running_1)
                        check_failed("running_1",
                            {103'd0, expect_running_1}, {103'd0, chip.running_1});
                    if (chip.running_2 !== expect_running_2)
                        check_failed("running_2",
                            {104'd0, expect_running_2}, {104'd0, chip.running_2});
                    if (chip.running_3 !== expect_running_3)
                        check_failed("running_3",
                            {103'd0, expect_running_3}, {103'd0, chip.running_3});
                    if (chip.running_4 !== expect_running_4)
                        check_failed("running_4",
                            {104'd0, expect_running_4}, {104'd0, chip.running_4});
                    if (chip.running_5 !== expect_running_5)
                        check_failed("running_5",
                            {104'd0, expect_running_5}, {104'd0, chip.running_5});
                    if (chip.calm !== expect_calm)
                        check_failed("calm",
                            {127'd0, expect_calm}, {127'd0, chip.calm});
                    if (chip.gamma_gear !== expect_gamma_gear)
                        check_failed("gamma_gear",
                            {124'd0, expect_gamma_gear}, {124'd0, chip.gamma_gear});
                    if (chip.recent_1 !== expect_recent_1)
                        check_failed("recent_1",
                            {110'd0, expect_recent_1}, {110'd0, chip.recent_1});
                    if (chip.recent_2 !== expect_recent_2)
                        check_failed("recent_2",
                            {111'd0, expect_recent_2}, {111'd0, chip.recent_2});
                    if (chip.recent_3 !== expect_recent_3)
                        check_failed("recent_3",
                            {110'd0, expect_recent_3}, {110'd0, chip.recent_3});
                    if (chip.recent_4 !== expect_recent_4)
                        check_failed("recent_4",
                            {111'd0, expect_recent_4}, {111'd0, chip.recent_4});
                    if (chip.recent_5 !== expect_recent_5)
                        check_failed("recent_5",
                            {111'd0, expect_recent_5}, {111'd0, chip.recent_5});
                    if (chip.proven_1 !== expect_proven_1)
                        check_failed("proven_1",
                            {110'd0, expect_proven_1}, {110'd0, chip.proven_1});
                    if (chip.proven_2 !== expect_proven_2)
                        check_failed("proven_2",
                            {111'd0, expect_proven_2}, {111'd0, chip.proven_2});
                    if (chip.proven_3 !== expect_proven_3)
                        check_failed("proven_3",
                            {110'd0, expect_proven_3}, {110'd0, chip.proven_3});
                    if (chip.proven_4 !== expect_proven_4)
                        check_failed("proven_4",
                            {111'd0, expect_proven_4}, {111'd0, chip.proven_4});
                    if (chip.proven_5 !== expect_proven_5)
                        check_failed("proven_5",
                            {111'd0, expect_proven_5}, {111'd0, chip.proven_5});
                    if (chip.returning !== expect_returning)
                        check_failed("returning",
                            {127'd0, expect_returning}, {127'd0, chip.returning});
                    if (chip.fading !== expect_fading)
                        check_failed("fading",
                            {127'd0, expect_fading}, {127'd0, chip.fading});
                    if (chip.halfway !== expect_halfway)
                        check_failed("halfway",
                            {127'd0, expect_halfway}, {127'd0, chip.halfway});
                    if (chip.known !== expect_known)
                        check_failed("known",
                            {127'd0, expect_known}, {127'd0, chip.known});
                    if (chip.apart !== expect_apart)
                        check_failed("apart",
                            {127'd0, expect_apart}, {127'd0, chip.apart});
                    if (chip.astray !== expect_astray)
                        check_failed("astray",
                            {127'd0, expect_astray}, {127'd0, chip.astray});
                    if (chip.astray_before !== expect_astray_before)
                        check_failed("astray_before",
                            {127'd0, expect_astray_before}, {127'd0, chip.astray_before});
                    if (chip.astray_long !== expect_astray_long)
                        check_failed("astray_long",
                            {127'd0, expect_astray_long}, {127'd0, chip.astray_long});
                    if (chip.theta_1_deviation !== expect_theta_1_deviation)
                        check_failed("theta_1_deviation",
                            {103'd0, expect_theta_1_deviation}, {103'd0, chip.theta_1_deviation});
                    if (chip.theta_2_deviation !== expect_theta_2_deviation)
                        check_failed("theta_2_deviation",
                            {104'd0, expect_theta_2_deviation}, {104'd0, chip.theta_2_deviation});
                    if (chip.theta_3_deviation !== expect_theta_3_deviation)
                        check_failed("theta_3_deviation",
                            {103'd0, expect_theta_3_deviation}, {103'd0, chip.theta_3_deviation});
                    if (chip.theta_4_deviation !== expect_theta_4_deviation)
                        check_failed("theta_4_deviation",
                            {104'd0, expect_theta_4_deviation}, {104'd0, chip.theta_4_deviation});
                    if (chip.theta_5_deviation !== expect_theta_5_deviation)
                        check_failed("theta_5_deviation",
                            {104'd0, expect_theta_5_deviation}, {104'd0, chip.theta_5_deviation});
                    if (lock_lost !== expect_lock_lost)
                        check_failed("lock_lost",
                            {127'd0, expect_lock_lost}, {127'd0, lock_lost});
                    if (position !== expect_position)
                        check_failed("position", {69'd0, expect_position}, {69'd0, position});
                    // Some samples come later than they might: until then nothing moves, and valid is one clock long.
                    if (sample[1:0] == 2'd2) begin
                        repeat (20 + 2) begin
                            @(negedge clk);
                            if (valid) check_failed("valid", 128'd0, 128'd1);
                        end
                        if (theta_2 !== expect_theta_2)
                            check_failed("theta_2",
                                {104'd0, expect_theta_2}, {104'd0, theta_2});
                        if (theta_4 !== expect_theta_4)
                            check_failed("theta_4",
                                {104'd0, expect_theta_4}, {104'd0, theta_4});
                        if (theta_1 !== expect_theta_1)
                            check_failed("theta_1",
                                {112'd0, expect_theta_1}, {112'd0, theta_1});
                        if (theta_3 !== expect_theta_3)
                            check_failed("theta_3",
                                {112'd0, expect_theta_3}, {112'd0, theta_3});
                        if (theta_5 !== expect_theta_5)
                            check_failed("theta_5",
                                {114'd0, expect_theta_5}, {114'd0, theta_5});
                        if (signal_lost !== expect_signal_lost)
                            check_failed("signal_lost",
                                {127'd0, expect_signal_lost}, {127'd0, signal_lost});
                        if (locked !== expect_locked)
                            check_failed("locked",
                                {127'd0, expect_locked}, {127'd0, locked});
                        if (speed !== expect_speed)
                            check_failed("speed",
                                {102'd0, expect_speed}, {102'd0, speed});
                        if (direction !== expect_direction)
                            check_failed("direction",
                                {127'd0, expect_direction}, {127'd0, direction});
                        if (lock_lost !== expect_lock_lost)
                            check_failed("lock_lost",
                                {127'd0, expect_lock_lost}, {127'd0, lock_lost});
                        if (position !== expect_position)
                            check_failed("position", {69'd0, expect_position}, {69'd0, position});
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
                0: begin path = "vectors/standstill.vec"; name = "standstill"; rows = 24; end
                1: begin path = "vectors/forwards.vec"; name = "forwards"; rows = 24; end
                2: begin path = "vectors/backwards.vec"; name = "backwards"; rows = 24; end
                3: begin path = "vectors/sweep.vec"; name = "sweep"; rows = 24; end
                4: begin path = "vectors/creep.vec"; name = "creep"; rows = 24; end
                5: begin path = "vectors/loss.vec"; name = "loss"; rows = 24; end
                6: begin path = "vectors/fade.vec"; name = "fade"; rows = 24; end
                7: begin path = "vectors/vanish.vec"; name = "vanish"; rows = 24; end
                8: begin path = "vectors/early.vec"; name = "early"; rows = 24; end
                9: begin path = "vectors/weak.vec"; name = "weak"; rows = 24; end
                10: begin path = "vectors/step.vec"; name = "step"; rows = 24; end
                11: begin path = "vectors/corners.vec"; name = "corners"; rows = 24; end
                12: begin path = "vectors/bounds.vec"; name = "bounds"; rows = 24; end
                13: begin path = "vectors/drift.vec"; name = "drift"; rows = 24; end
                14: begin path = "vectors/jolts.vec"; name = "jolts"; rows = 24; end
                15: begin path = "vectors/reversals.vec"; name = "reversals"; rows = 24; end
                16: begin path = "vectors/small.vec"; name = "small"; rows = 24; end
                17: begin path = "vectors/smaller.vec"; name = "smaller"; rows = 24; end
                18: begin path = "vectors/ties.vec"; name = "ties"; rows = 24; end
                19: begin path = "vectors/random.vec"; name = "random"; rows = 24; end
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
