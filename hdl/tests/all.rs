//! The tests of what runs the chips in one program: one for each file would each be built and linked with all that they share.

mod any_state;
mod bit_exact;
mod chip;
mod closing_the_loop;
mod command;
mod missing_tools;
mod netlist;
mod planted_faults;
mod recordings_in_verilog;
mod reference_is_fresh;
mod support;
mod verify;
mod waves;
mod yosys;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
