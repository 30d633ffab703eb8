//! From graph to clock cycles.
//!
//! Cycle 0 is the one in which `sample_valid` is high; the ADC codes are registered at its end. A product is issued in
//! a cycle: its operands are put into the multiplier's operand registers at the end of the cycle before, the product
//! register holds the result in the cycle after. What is computed from a product register may go straight into an
//! operand register, so dependent products follow each other every second cycle. A table row is there one cycle after
//! its address. Everything else is combinational, chained within a cycle up to a depth. All registers of the chip
//! commit at the end of the last cycle.

use nonius_model::graph::{Graph, NodeId, Op};

/// Names of the inputs that are registered at the end of cycle 0.
pub const SAMPLED: [&str; 4] = ["adc_cos", "adc_sin", "preset", "calibrate"];

/// Longest chain in a cycle, in about tenths of nanoseconds of an iCE40 HX.
const DEPTH: u32 = 110;

/// When and where each node is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// Cycle in which a node's value is there.
    pub ready: Vec<usize>,
    /// For products: multiplier and cycle of issue.
    pub issue: Vec<Option<(usize, usize)>>,
    /// Number of multipliers.
    pub multipliers: usize,
    /// Clocks from one sample to the next.
    pub clocks: usize,
}

/// Combinational delay of a node in units of [`DEPTH`].
fn delay(graph: &Graph, id: NodeId) -> u32 {
    let width = graph.node(id).format.width;
    match graph.node(id).op {
        Op::Input | Op::Constant(_) | Op::Scale(..) | Op::Lookup { .. } | Op::Mul(..) => 0,
        Op::Add(..) | Op::Sub(..) | Op::Neg(_) | Op::LessThan(..) => 15 + width,
        Op::Quantise(_, to) if to.rounding != nonius_model::format::Rounding::Nearest => 5,
        Op::Quantise(..) => 25 + width,
        Op::QuantiseGeared { .. } => 45 + width,
        Op::Select(..) | Op::And(..) | Op::Or(..) | Op::Xor(..) | Op::Not(_) => 10,
    }
}

/// Lists the graph on `multipliers` multipliers.
#[must_use]
pub fn schedule(graph: &Graph, multipliers: usize) -> Schedule {
    let n = graph.nodes.len();
    let mut urgency = vec![0u32; n];
    for id in graph.ids().collect::<Vec<_>>().into_iter().rev() {
        let own = match graph.node(id).op {
            Op::Mul(..) => 200,
            Op::Lookup { .. } => 100,
            _ => delay(graph, id),
        };
        let here = urgency[id.index()] + own;
        for operand in graph.node(id).op.operands() {
            let u = &mut urgency[operand.index()];
            *u = (*u).max(here);
        }
    }
    let mut ready: Vec<Option<usize>> = vec![None; n];
    let mut arrival = vec![0u32; n];
    let mut issue = vec![None; n];
    for id in graph.ids() {
        let node = graph.node(id);
        match node.op {
            Op::Input => {
                let sampled = node
                    .name
                    .as_deref()
                    .is_some_and(|name| SAMPLED.contains(&name));
                ready[id.index()] = Some(usize::from(sampled));
            }
            Op::Constant(_) => ready[id.index()] = Some(0),
            _ => {}
        }
    }
    let mut cycle = 0;
    while ready.iter().any(Option::is_none) {
        let done =
            |ready: &[Option<usize>], id: NodeId| ready[id.index()].is_some_and(|r| r <= cycle);
        for id in graph.ids() {
            let op = graph.node(id).op;
            let waits = matches!(op, Op::Mul(..) | Op::Lookup { .. });
            if ready[id.index()].is_some()
                || waits
                || !op.operands().iter().all(|&o| done(&ready, o))
            {
                continue;
            }
            let chained = |o: &NodeId| {
                if ready[o.index()] == Some(cycle) {
                    arrival[o.index()]
                } else {
                    0
                }
            };
            let start = op.operands().iter().map(chained).max().unwrap_or(0);
            let end = start + delay(graph, id);
            if start == 0 || end <= DEPTH {
                ready[id.index()] = Some(cycle);
                arrival[id.index()] = end;
            }
        }
        read_tables(graph, &mut ready, cycle);
        let mut waiting: Vec<NodeId> = graph
            .ids()
            .filter(|&id| matches!(graph.node(id).op, Op::Mul(..)) && ready[id.index()].is_none())
            .filter(|&id| {
                graph
                    .node(id)
                    .op
                    .operands()
                    .iter()
                    .all(|&o| done(&ready, o))
            })
            .collect();
        waiting.sort_by_key(|id| (std::cmp::Reverse(urgency[id.index()]), id.index()));
        for (multiplier, id) in waiting.into_iter().take(multipliers).enumerate() {
            issue[id.index()] = Some((multiplier, cycle + 1));
            ready[id.index()] = Some(cycle + 2);
        }
        cycle += 1;
    }
    let ready: Vec<usize> = ready.into_iter().flatten().collect();
    let clocks = ready.iter().max().copied().unwrap_or(0) + 1;
    Schedule {
        ready,
        issue,
        multipliers,
        clocks,
    }
}

/// One address per table and cycle; all columns of its row come together.
fn read_tables(graph: &Graph, ready: &mut [Option<usize>], cycle: usize) {
    for rom in 0..graph.roms.len() {
        let next = graph.ids().find_map(|id| match graph.node(id).op {
            Op::Lookup {
                rom: r, address, ..
            } if r == rom && ready[id.index()].is_none() => ready[address.index()]
                .is_some_and(|at| at <= cycle)
                .then_some(address),
            _ => None,
        });
        for id in graph.ids() {
            if let Op::Lookup {
                rom: r, address, ..
            } = graph.node(id).op
                && r == rom
                && Some(address) == next
            {
                ready[id.index()] = Some(cycle + 1);
            }
        }
    }
}
