//! A design and its recorded graph become Verilog.
//!
//! [`schedule`] lays the graph on multipliers and clock cycles, [`netlist`] names registers and wires and writes one
//! expression per operation, the templates hold ports, resets, step counter, memories and the testbench. No number of
//! the chip is computed here.

pub mod evaluate;
mod expression;
mod names;
pub mod netlist;
mod quantise;
pub mod schedule;
mod settle;
mod shifter;
mod tables;
mod templates;
mod units;
mod writer;

pub use templates::{Files, generate};

/// The design's hash: of everything it was made from.
#[must_use]
pub fn hash(design: &nonius_model::design::Design) -> String {
    use sha2::Digest;
    let digest = sha2::Sha256::digest(format!("{:?}{:?}", design.spec, design.constants));
    digest
        .iter()
        .take(6)
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
