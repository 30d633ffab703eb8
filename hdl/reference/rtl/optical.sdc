# Timing constraints of optical (design ec8b484df4fe), for Vivado, Quartus and every tool that reads SDC.
#
# 20 clocks per sample at 1000000 samples per second: the clock needs at least 20000000 Hz.
# For nextpnr: --freq 20.000

create_clock -name clk -period 50.000 [get_ports clk]

# rst_n may fall at any time. It must rise in step with clk: drive it from a synchroniser of two registers. The path to
# the pin is then false; recovery is met by the synchroniser's own registers.
set_false_path -from [get_ports rst_n]

# All other pins are synchronous to clk. Put the delays outside the chip in place of 0: with 0 the whole period is the
# chip's.
set_input_delay -clock clk 0 [get_ports {sample_valid adc_cos[*] adc_sin[*] preset calibrate}]
set_output_delay -clock clk 0 [all_outputs]
