//! The plain reading of a graph: integers, one node after the other. Slow and obvious, it judges the fast readings.

use super::{Graph, NodeId, Op};
use crate::format::Quantiser;

/// The integer of every node, in units of the last bit of its format.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Evaluation(Vec<i128>);

impl Evaluation {
    /// Evaluates `graph`; `input` gives the integer of each input by its name.
    pub fn new(graph: &Graph, mut input: impl FnMut(&str) -> i128) -> Self {
        let mut values: Vec<i128> = Vec::with_capacity(graph.nodes.len());
        for id in graph.ids() {
            let value = match graph.node(id).op {
                Op::Input => input(graph.node(id).name.as_deref().unwrap_or_default()),
                _ => compute(graph, id, |operand| values[operand.index()]),
            };
            values.push(value);
        }
        Self(values)
    }

    /// The integer of a node.
    #[must_use]
    pub fn raw(&self, id: NodeId) -> i128 {
        self.0[id.index()]
    }
}

/// What node `id` yields, given its operands. Inputs have no operands and yield 0.
pub fn compute(graph: &Graph, id: NodeId, value: impl Fn(NodeId) -> i128) -> i128 {
    let entry = graph.node(id);
    let fraction = |n: NodeId| graph.node(n).format.fraction;
    let aligned = |n: NodeId, to: u32| value(n) << (to - fraction(n));
    let common = |a: NodeId, b: NodeId| fraction(a).max(fraction(b));
    match entry.op {
        Op::Input => 0,
        Op::Constant(raw) => raw.into(),
        Op::Add(a, b) => aligned(a, entry.format.fraction) + aligned(b, entry.format.fraction),
        Op::Sub(a, b) => aligned(a, entry.format.fraction) - aligned(b, entry.format.fraction),
        Op::Neg(a) => -value(a),
        Op::Mul(a, b) => value(a) * value(b),
        Op::Scale(a, power) => {
            let pad = i64::from(power) - i64::from(fraction(a));
            value(a) << pad.max(0)
        }
        Op::Quantise(a, to) => to.apply(value(a), fraction(a)),
        Op::QuantiseGeared {
            value: v,
            gear,
            stride,
            to,
            ..
        } => to.apply(value(v), fraction(v) + stride * value(gear) as u32),
        Op::LessThan(a, b) => (aligned(a, common(a, b)) < aligned(b, common(a, b))).into(),
        Op::Select(c, a, b) => {
            let chosen = if value(c) != 0 { a } else { b };
            aligned(chosen, entry.format.fraction)
        }
        Op::And(a, b) => value(a) & value(b),
        Op::Or(a, b) => value(a) | value(b),
        Op::Xor(a, b) => value(a) ^ value(b),
        Op::Not(a) => 1 - value(a),
        Op::Lookup {
            rom,
            column,
            address,
        } => {
            let rom = &graph.roms[rom];
            let row = Quantiser::grid(crate::format::Format::unsigned(
                rom.address_bits,
                rom.index_fraction,
            ))
            .apply(value(address), fraction(address));
            rom.columns[column].raw[row as usize].into()
        }
    }
}
