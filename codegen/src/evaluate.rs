//! The scheduled reading of a graph: cycle by cycle, with operand and product registers and captured values, as the
//! Verilog does it. What a schedule forgets to keep is lost here too.

use nonius_model::graph::{Graph, NodeId, Op, compute};

use crate::netlist::last_use;
use crate::schedule::Schedule;

/// Runs one sample through the schedule; `input` gives each input's integer by name. The result is the integer of
/// each node that is still there in the last cycle.
pub fn evaluate(
    graph: &Graph,
    schedule: &Schedule,
    mut input: impl FnMut(&str) -> i128,
) -> Vec<Option<i128>> {
    let n = graph.nodes.len();
    let last = last_use(graph, schedule);
    let mut held: Vec<Option<i128>> = vec![None; n];
    let mut products: Vec<Option<i128>> = vec![None; schedule.multipliers];
    let mut operands: Vec<Option<(i128, i128)>> = vec![None; schedule.multipliers];
    let mut rows: Vec<Option<i128>> = vec![None; n];
    let mut inputs = vec![0; n];
    for id in graph.ids() {
        if graph.node(id).op == Op::Input {
            inputs[id.index()] = input(graph.node(id).name.as_deref().unwrap_or_default());
        }
    }
    for cycle in 0..schedule.clocks {
        let mut now = held.clone();
        for id in graph.ids() {
            let i = id.index();
            if schedule.ready[i] != cycle {
                continue;
            }
            let read = |o: NodeId| now[o.index()].unwrap_or_default();
            let known = graph
                .node(id)
                .op
                .operands()
                .all(|o| now[o.index()].is_some());
            now[i] = match graph.node(id).op {
                Op::Input => Some(inputs[i]),
                Op::Mul(..) => schedule.issue[i].and_then(|(m, _)| products[m]),
                Op::Lookup { .. } => rows[i],
                _ if known => Some(compute(graph, id, read)),
                _ => None,
            };
        }
        for m in 0..schedule.multipliers {
            products[m] = operands[m].map(|(a, b)| a * b);
            operands[m] = graph.ids().find_map(|id| match graph.node(id).op {
                Op::Mul(a, b) if schedule.issue[id.index()] == Some((m, cycle + 1)) => {
                    Some((now[a.index()]?, now[b.index()]?))
                }
                _ => None,
            });
        }
        rows = graph
            .ids()
            .map(|id| match graph.node(id).op {
                Op::Lookup { address, .. } if schedule.ready[id.index()] == cycle + 1 => now
                    [address.index()]
                .map(|_| compute(graph, id, |o| now[o.index()].unwrap_or_default())),
                _ => None,
            })
            .collect();
        if cycle + 1 == schedule.clocks {
            return now;
        }
        held = (0..n)
            .map(|i| if last[i] > cycle { now[i] } else { None })
            .collect();
    }
    held
}
