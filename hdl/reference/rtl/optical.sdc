# Timing constraints of optical (design a31246b9e5bd), for Vivado, Quartus and every tool that reads SDC.
#
# 19 clocks per sample at 1000000 samples per second: the clock needs at least 19000000 Hz.
# For nextpnr: --freq 19.000

create_clock -name clk -period 52.631 [get_ports clk]

# rst_n is asynchronous; release it in step with clk.
set_false_path -from [get_ports rst_n]

# sample_valid, adc_cos, adc_sin, preset and calibrate are synchronous to clk. So are all outputs.
