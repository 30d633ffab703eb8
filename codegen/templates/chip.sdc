# Timing constraints of ${ name }$ (design ${ hash }$), for Vivado, Quartus and every tool that reads SDC.
#
# ${ clocks }$ clocks per sample at ${ rate }$ samples per second: the clock needs at least ${ clock }$ Hz.
# For nextpnr: --freq ${ megahertz }$

create_clock -name clk -period ${ period }$ [get_ports clk]

# rst_n is asynchronous; release it in step with clk.
set_false_path -from [get_ports rst_n]

# sample_valid, adc_cos, adc_sin, preset and calibrate are synchronous to clk. So are all outputs.
