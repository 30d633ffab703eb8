//! Names for everything: which values are kept in registers, and the expression of each.

use nonius_model::graph::{Graph, Kind, NodeId, Op};

use crate::expression;
use crate::schedule::{SAMPLED, Schedule};

/// The last cycle in which each node is read; `usize::MAX` for registers of the chip and coefficients.
#[must_use]
pub fn last_use(graph: &Graph, schedule: &Schedule) -> Vec<usize> {
    let mut last = schedule.ready.clone();
    for id in graph.ids() {
        let at = match graph.node(id).op {
            Op::Mul(..) => schedule.issue[id.index()].map_or(0, |(_, cycle)| cycle - 1),
            Op::Lookup { .. } => schedule.ready[id.index()] - 1,
            _ => schedule.ready[id.index()],
        };
        for operand in graph.node(id).op.operands() {
            last[operand.index()] = last[operand.index()].max(at);
        }
    }
    for (_, id) in graph.probes.iter().chain(&graph.next) {
        last[id.index()] = last[id.index()].max(schedule.clocks - 1);
    }
    for id in graph.ids() {
        if matches!(graph.node(id).op, Op::Input | Op::Constant(_)) {
            last[id.index()] = usize::MAX;
        }
    }
    last
}

/// Bits of a node in the Verilog, where every number is signed.
#[must_use]
pub fn width(graph: &Graph, id: NodeId) -> u32 {
    let node = graph.node(id);
    match node.kind {
        Kind::Flag => 1,
        _ if node.format.signed => node.format.width,
        _ => node.format.width + 1,
    }
}

/// The name of a node in the Verilog.
#[must_use]
pub fn base_name(graph: &Graph, id: NodeId) -> String {
    graph
        .node(id)
        .name
        .clone()
        .unwrap_or_else(|| format!("t{}", id.0))
}

/// Whether the node is a register of the chip or a registered input.
fn is_register(graph: &Graph, id: NodeId) -> bool {
    graph.node(id).op == Op::Input
}

/// What to write for `id` in an expression that is evaluated in `cycle`.
pub(crate) fn reference(graph: &Graph, schedule: &Schedule, id: NodeId, cycle: usize) -> String {
    let name = base_name(graph, id);
    match graph.node(id).op {
        Op::Input | Op::Constant(_) => name,
        _ if schedule.ready[id.index()] == cycle => format!("{name}_now"),
        _ => name,
    }
}

/// A declaration: `kind`, signedness and range, name.
pub(crate) fn declaration(kind: &str, graph: &Graph, id: NodeId, name: &str) -> String {
    let bits = width(graph, id);
    if graph.node(id).kind == Kind::Flag {
        format!("{kind} {name}")
    } else {
        format!("{kind} signed [{}:0] {name}", bits - 1)
    }
}

/// A wire and its expression.
pub(crate) struct Wire {
    pub(crate) lines: Vec<String>,
}

/// Everything the core template needs besides structure.
pub(crate) struct Netlist {
    pub(crate) constants: Vec<String>,
    pub(crate) sections: Vec<(String, String, String, Vec<Wire>)>,
    pub(crate) captured: Vec<(usize, String)>,
    pub(crate) captured_names: Vec<(String, String)>,
    pub(crate) registers: Vec<(String, String, String)>,
    pub(crate) inputs: Vec<(String, String)>,
    pub(crate) probes: Vec<(String, String, String)>,
}

impl Netlist {
    pub(crate) fn new(graph: &Graph, schedule: &Schedule) -> Self {
        let last = last_use(graph, schedule);
        let commit = schedule.clocks - 1;
        let mut sections: Vec<_> = graph
            .formulas
            .iter()
            .map(|f| {
                (
                    f.title.to_owned(),
                    f.equation.to_owned(),
                    f.source.to_owned(),
                    vec![],
                )
            })
            .collect();
        let mut constants = vec![];
        let mut captured = vec![];
        let mut captured_names = vec![];
        for id in graph.ids() {
            let node = graph.node(id);
            let name = base_name(graph, id);
            match node.op {
                Op::Input => continue,
                Op::Constant(raw) => {
                    if last_read(graph, id) {
                        let value = expression::literal(raw, width(graph, id), node.kind);
                        constants.push(format!(
                            "{} = {value};",
                            declaration("wire", graph, id, &name)
                        ));
                    }
                    continue;
                }
                _ => {}
            }
            let lines = expression::lines(graph, schedule, id);
            sections[node.formula].3.push(Wire { lines });
            if last[id.index()] > schedule.ready[id.index()] {
                captured.push((schedule.ready[id.index()], format!("{name} <= {name}_now;")));
                captured_names.push((declaration("reg", graph, id, &name), name));
            }
        }
        let sampled = |id: NodeId| SAMPLED.contains(&base_name(graph, id).as_str());
        let next = |name: &str| {
            let node = graph.next.iter().find(|(n, _)| n == name);
            node.map(|&(_, id)| reference(graph, schedule, id, commit))
                .unwrap_or_default()
        };
        let registers = graph
            .inputs
            .iter()
            .filter(|(_, id)| is_register(graph, *id) && !sampled(*id))
            .map(|(name, id)| {
                (
                    declaration("reg", graph, *id, name),
                    name.clone(),
                    next(name),
                )
            })
            .collect();
        let inputs = graph
            .inputs
            .iter()
            .filter(|(_, id)| sampled(*id))
            .map(|(name, id)| (declaration("reg", graph, *id, name), name.clone()))
            .collect();
        let probes = graph
            .probes
            .iter()
            .map(|(name, id)| {
                (
                    declaration("reg", graph, *id, &format!("probe_{name}")),
                    name.clone(),
                    reference(graph, schedule, *id, commit),
                )
            })
            .collect();
        Self {
            constants,
            sections,
            captured,
            captured_names,
            registers,
            inputs,
            probes,
        }
    }
}

fn last_read(graph: &Graph, id: NodeId) -> bool {
    graph.nodes.iter().any(|n| n.op.operands().contains(&id))
        || graph
            .next
            .iter()
            .chain(&graph.probes)
            .any(|(_, n)| *n == id)
}
