//! The recording reading: kernels write themselves down as a graph.
//!
//! The graph of one sample is small, a few hundred nodes of about a dozen operations. It knows no clock, no loop and
//! no memory but read-only tables; operands always stand before the node that uses them.

mod evaluate;
mod interval;
mod node;
mod prune;
mod recorder;

pub use evaluate::{Evaluation, compute};
pub use interval::RangeError;
pub use node::{Flag, Node, WideNode};
pub use recorder::Recorder;

use crate::format::{Format, Quantiser};
use crate::signal::Formula;

/// Index of a node in [`Graph::nodes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

impl NodeId {
    /// The index as `usize`.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a node computes. All operations but the quantisations are exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Op {
    /// A register's value before the sample, or an input of the chip; the node's name says which.
    Input,
    /// A coefficient; the integer in units of the node's last bit.
    Constant(i64),
    /// Sum.
    Add(NodeId, NodeId),
    /// Difference.
    Sub(NodeId, NodeId),
    /// Negation.
    Neg(NodeId),
    /// Product; the only operation that needs a multiplier.
    Mul(NodeId, NodeId),
    /// Times 2^power: a renaming of bits.
    Scale(NodeId, i32),
    /// The lossy step.
    Quantise(NodeId, Quantiser),
    /// Times 2^(−stride·gear), then the lossy step; the gear is an integer node between 0 and `last`.
    QuantiseGeared {
        /// The value.
        value: NodeId,
        /// The gear.
        gear: NodeId,
        /// Bits of shift per gear.
        stride: u32,
        /// Highest gear.
        last: u32,
        /// Format, rounding and overflow of the result.
        to: Quantiser,
    },
    /// First smaller than second.
    LessThan(NodeId, NodeId),
    /// Condition, value if true, value if false.
    Select(NodeId, NodeId, NodeId),
    /// Both.
    And(NodeId, NodeId),
    /// At least one.
    Or(NodeId, NodeId),
    /// Exactly one.
    Xor(NodeId, NodeId),
    /// The opposite.
    Not(NodeId),
    /// A column of the row of table `rom` (index in [`Graph::roms`]) that the address falls in.
    Lookup {
        /// Index of the table.
        rom: usize,
        /// Index of the column.
        column: usize,
        /// The address.
        address: NodeId,
    },
}

impl Op {
    /// The nodes that this one reads.
    pub fn operands(&self) -> impl Iterator<Item = NodeId> + use<> {
        let mut op = *self;
        let ids = op.each_operand().map(|id| id.map(|id| *id));
        ids.into_iter().flatten()
    }

    /// The same, to be renumbered.
    fn operands_mut(&mut self) -> impl Iterator<Item = &mut NodeId> {
        self.each_operand().into_iter().flatten()
    }

    // No list on the heap: schedules are made by asking for these some million times.
    fn each_operand(&mut self) -> [Option<&mut NodeId>; 3] {
        match self {
            Op::Input | Op::Constant(_) => [None, None, None],
            Op::Neg(a)
            | Op::Scale(a, _)
            | Op::Quantise(a, _)
            | Op::Not(a)
            | Op::Lookup { address: a, .. } => [Some(a), None, None],
            Op::Add(a, b)
            | Op::Sub(a, b)
            | Op::Mul(a, b)
            | Op::LessThan(a, b)
            | Op::And(a, b)
            | Op::Or(a, b)
            | Op::Xor(a, b)
            | Op::QuantiseGeared {
                value: a, gear: b, ..
            } => [Some(a), Some(b), None],
            Op::Select(c, a, b) => [Some(c), Some(a), Some(b)],
        }
    }
}

/// Number or decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// A number that fits the container.
    Value,
    /// An exact product or a sum of such.
    Wide,
    /// A decision, one bit.
    Flag,
}

/// One operation of the graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What it computes.
    pub op: Op,
    /// Number or decision.
    pub kind: Kind,
    /// A format that holds every value the node can take; exactly the stated one for inputs and quantisations.
    pub format: Format,
    /// Smallest and largest value by interval analysis, in units of the format's last bit.
    pub range: (i128, i128),
    /// Its name in waves and Verilog; unique.
    pub name: Option<String>,
    /// Index in [`Graph::formulas`] of the formula it belongs to.
    pub formula: usize,
}

/// Everything that one sample computes.
#[derive(Clone, Debug, PartialEq)]
pub struct Graph {
    /// The operations, operands first.
    pub nodes: Vec<Entry>,
    /// The formulas in the order of the first node of each.
    pub formulas: Vec<&'static Formula>,
    /// The tables.
    pub roms: Vec<crate::rom::Rom>,
    /// Registers and inputs of the chip: name and node.
    pub inputs: Vec<(String, NodeId)>,
    /// Named results.
    pub probes: Vec<(String, NodeId)>,
    /// The next value of each register, under the register's name.
    pub next: Vec<(String, NodeId)>,
}

impl Graph {
    /// The node with this identifier.
    #[must_use]
    pub fn node(&self, id: NodeId) -> &Entry {
        &self.nodes[id.index()]
    }

    /// The identifiers of all nodes in order.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// Whether anything reads the node: another one, a register or a probe.
    #[must_use]
    pub fn is_read(&self, id: NodeId) -> bool {
        let used = self.nodes.iter().any(|n| n.op.operands().any(|o| o == id));
        used || self.next.iter().chain(&self.probes).any(|(_, n)| *n == id)
    }

    /// How many products one sample takes.
    #[must_use]
    pub fn products(&self) -> usize {
        self.nodes
            .iter()
            .filter(|n| matches!(n.op, Op::Mul(..)))
            .count()
    }
}
