//! The coefficients that a chip reads.

use nonius_model::graph::{Graph, Kind, Op};
use nonius_model::kernel::{Coefficients, Constant};

use crate::layout::{COMMENT, wrap};

/// A coefficient of the chip.
pub(crate) struct Coefficient {
    pub(crate) name: String,
    /// Integer in units of 2^-`fraction`.
    pub(crate) raw: i64,
    /// Bits, sign included.
    pub(crate) bits: u32,
    pub(crate) fraction: u32,
    pub(crate) value: f64,
    /// What it is, in a sentence.
    pub(crate) meaning: String,
}

/// All that anything reads, in the order of the kernel.
pub(crate) fn coefficients(graph: &Graph) -> Vec<Coefficient> {
    let of = |id| {
        let node = graph.node(id);
        let (Op::Constant(raw), Kind::Value) = (node.op, node.kind) else {
            return None;
        };
        let name = node.name.clone().filter(|_| graph.is_read(id))?;
        Some(Coefficient {
            raw,
            bits: node.format.width,
            fraction: node.format.fraction,
            value: raw as f64 * node.format.lsb(),
            meaning: Coefficients::<Constant>::described(&name).unwrap_or_default(),
            name,
        })
    };
    graph.ids().filter_map(of).collect()
}

/// The list in the head of the Verilog.
pub(crate) fn listed(graph: &Graph) -> Vec<String> {
    let all = coefficients(graph);
    let width = all.iter().map(|c| c.name.len()).max().unwrap_or(0);
    let lines = |c: &Coefficient| {
        let first = format!("  {:<width$} {:<24}", c.name, c.value);
        wrap(&first, &c.meaning, COMMENT - 2)
    };
    all.iter().flat_map(lines).collect()
}
