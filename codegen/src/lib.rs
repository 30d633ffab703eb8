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

/// The design's hash: of everything it was made from. A correction that it does not have is no part of it, so that designs
/// without one keep theirs.
#[must_use]
pub fn hash(design: &nonius_model::design::Design) -> String {
    use nonius_model::spec::Correction;
    use sha2::Digest;
    let without = format!(", correction: {:?}", Correction::default());
    let spec = format!("{:?}", design.spec).replace(&without, "");
    let mut constants = vec![];
    design.constants.map(|name, constant| {
        if design.skew.is_some() || !name.starts_with("skew_") {
            constants.push(format!("{name}: {constant:?}"));
        }
    });
    let constants = constants.join(", ");
    let digest = sha2::Sha256::digest(format!("{spec}Coefficients {{ {constants} }}"));
    digest
        .iter()
        .take(6)
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
