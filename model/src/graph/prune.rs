//! What nothing comes of is left out: it would cost a multiplier a clock, and a reader his time.

use super::{Graph, NodeId};

impl Graph {
    /// The same graph without the operations that neither a register nor a probe depends on. Inputs stay: they are
    /// ports.
    pub(super) fn pruned(mut self) -> Self {
        let mut live = vec![false; self.nodes.len()];
        for (_, id) in self.inputs.iter().chain(&self.probes).chain(&self.next) {
            live[id.index()] = true;
        }
        // Operands stand before the node that uses them: one pass from the end finds all.
        for i in (0..self.nodes.len()).rev() {
            if live[i] {
                for operand in self.nodes[i].op.operands() {
                    live[operand.index()] = true;
                }
            }
        }
        let mut place = vec![NodeId(0); self.nodes.len()];
        let mut kept = 0;
        for (place, &live) in place.iter_mut().zip(&live) {
            *place = NodeId(kept);
            kept += u32::from(live);
        }
        let to = |id: &mut NodeId| *id = place[id.index()];
        let mut live = live.iter();
        self.nodes
            .retain(|_| *live.next().expect("as many flags as nodes"));
        for node in &mut self.nodes {
            node.op.operands_mut().for_each(to);
        }
        for (_, id) in self
            .inputs
            .iter_mut()
            .chain(&mut self.probes)
            .chain(&mut self.next)
        {
            to(id);
        }
        self
    }
}
