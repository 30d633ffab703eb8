//! Values that wait in a register for their first reader are computed when it reads them, where that saves registers.

use nonius_model::graph::{Graph, NodeId, Op};

use crate::netlist::{last_use, width};
use crate::schedule::{Schedule, delay};

/// Cycle of the first read of each node.
fn first_use(graph: &Graph, schedule: &Schedule) -> Vec<usize> {
    let mut first = vec![schedule.clocks - 1; graph.nodes.len()];
    for id in graph.ids() {
        let at = schedule.reads_in(graph, id);
        for operand in graph.node(id).op.operands() {
            first[operand.index()] = first[operand.index()].min(at);
        }
    }
    first
}

/// Whether no chain of `cycle` is longer than `depth`.
fn fits(graph: &Graph, schedule: &Schedule, cycle: usize, depth: u32) -> bool {
    let mut arrival = vec![0u32; graph.nodes.len()];
    for id in graph.ids() {
        if schedule.ready[id.index()] != cycle {
            continue;
        }
        let operands = graph.node(id).op.operands();
        let start = operands.map(|o| arrival[o.index()]).max();
        let start = start.unwrap_or(0);
        arrival[id.index()] = start + delay(graph, id);
        if start > 0 && arrival[id.index()] > depth {
            return false;
        }
    }
    true
}

/// Moves values to the cycle of their first reader where no more register bits are needed for what they are made of.
pub(crate) fn settle(graph: &Graph, schedule: &mut Schedule, depth: u32) {
    let ids: Vec<NodeId> = graph.ids().collect();
    let uses = |schedule: &Schedule| (first_use(graph, schedule), last_use(graph, schedule));
    // They change where a value moves, and else not.
    let (mut first, mut last) = uses(schedule);
    loop {
        let mut moved = false;
        for &id in ids.iter().rev() {
            let op = graph.node(id).op;
            let fixed = matches!(
                op,
                Op::Input
                    | Op::Constant(_)
                    | Op::Mul(..)
                    | Op::Lookup { .. }
                    | Op::QuantiseGeared { .. }
            );
            let probe = graph.probes.iter().any(|&(_, p)| p == id);
            let to = first[id.index()];
            let from = schedule.ready[id.index()];
            if fixed || probe || to <= from {
                continue;
            }
            let saved = if last[id.index()] == to {
                width(graph, id)
            } else {
                0
            };
            let cost: u32 = op
                .operands()
                .filter(|o| {
                    let i = o.index();
                    last[i] <= schedule.ready[i] && last[i] != usize::MAX
                })
                .map(|o| width(graph, o))
                .sum();
            // A bit or two are not worth a longer chain.
            if saved <= cost + 2 {
                continue;
            }
            schedule.ready[id.index()] = to;
            if fits(graph, schedule, to, depth) {
                moved = true;
                (first, last) = uses(schedule);
            } else {
                schedule.ready[id.index()] = from;
            }
        }
        if !moved {
            return;
        }
    }
}
