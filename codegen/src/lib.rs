//! A design and its recorded graph become Verilog.
//!
//! [`schedule`] lays the graph on multipliers and clock cycles, [`netlist`] names registers and wires and writes one
//! expression per operation, the templates hold ports, resets, step counter, memories and the testbench. No number of
//! the chip is computed here.

mod about;
mod condition;
mod constants;
mod declared;
pub mod evaluate;
mod expression;
mod layout;
mod names;
pub mod netlist;
mod ports;
mod quantise;
pub mod schedule;
mod settle;
mod shifter;
mod tables;
mod templates;
mod units;
mod writer;

pub use declared::declared;
pub use templates::{Files, generate};

use nonius_model::design::Design;
use nonius_model::graph::Op;
use sha2::Digest;

/// The design's hash: of what was asked for and of the numbers that the chip has.
#[must_use]
pub fn hash(design: &Design) -> String {
    let graph = &design.graph;
    let constants: Vec<_> = graph
        .ids()
        .map(|id| graph.node(id))
        .filter_map(|node| match node.op {
            Op::Constant(raw) => Some((node.name.as_deref(), raw, node.format.fraction)),
            _ => None,
        })
        .collect();
    let mut spec = design.spec.clone();
    // What the design does not say is of the chip all the same.
    spec.calibration.gamma_last = Some(spec.calibration.gamma_last());
    let all = serde_json::json!([spec, constants]).to_string();
    let digest = sha2::Sha256::digest(all);
    digest
        .iter()
        .take(6)
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
