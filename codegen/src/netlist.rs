//! What the Verilog declares, keeps and assigns, in the order in which it is read.

use nonius_model::graph::{Graph, Kind, NodeId, Op};

use crate::expression;
use crate::layout;
use crate::schedule::{SAMPLED, Schedule};
use crate::writer::{Writer, range};

/// The last cycle in which each node is read; `usize::MAX` for registers of the chip and coefficients.
#[must_use]
pub fn last_use(graph: &Graph, schedule: &Schedule) -> Vec<usize> {
    let mut last = schedule.ready.clone();
    for id in graph.ids() {
        let at = schedule.reads_in(graph, id);
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

/// A formula and the statements that compute it.
pub(crate) struct Section {
    pub(crate) title: String,
    pub(crate) equation: Vec<String>,
    pub(crate) source: String,
    pub(crate) lines: Vec<String>,
}

/// A register.
#[derive(Clone)]
pub(crate) struct Register {
    pub(crate) range: String,
    pub(crate) name: String,
    pub(crate) meaning: String,
}

/// What the core template needs besides structure.
pub(crate) struct Netlist {
    pub(crate) sections: Vec<Section>,
    /// Step, values that are kept at its end.
    pub(crate) captures: Vec<(usize, Vec<String>)>,
    pub(crate) kept: Vec<Register>,
    pub(crate) state: Vec<Register>,
    /// Register and its next value.
    pub(crate) commits: Vec<(String, String)>,
    /// The inputs of a sample, held while it is worked on.
    pub(crate) held: Vec<Register>,
}

impl Netlist {
    pub(crate) fn new(w: &Writer) -> Self {
        let (graph, schedule) = (w.graph, w.schedule);
        let commit = schedule.clocks - 1;
        let mut sections: Vec<Section> = graph
            .formulas
            .iter()
            .map(|f| Section {
                title: f.title.into(),
                equation: layout::wrap("", f.equation, layout::COMMENT - 6),
                source: f.source.into(),
                lines: vec![],
            })
            .collect();
        let mut captures: Vec<(usize, Vec<String>)> =
            (0..schedule.clocks).map(|c| (c, vec![])).collect();
        let mut kept = vec![];
        for id in graph.ids() {
            let node = graph.node(id);
            if matches!(node.op, Op::Input | Op::Constant(_))
                || w.moved(id).is_some()
                || crate::quantise::fused(w, graph, id)
            {
                continue;
            }
            let (mut lines, with) = w.with_coefficients(|| expression::lines(w, id));
            let with = with.join(", ");
            if let (Some(last), false) = (lines.last_mut(), with.is_empty()) {
                *last += &format!(", with {with}");
            }
            sections[node.formula]
                .lines
                .extend(layout::laid_out(&lines));
            if w.kept(id) {
                let name = w.name(id);
                w.declare(name, width(graph, id));
                w.read(&w.wire(id), width(graph, id) - 1, 0);
                captures[schedule.ready[id.index()]]
                    .1
                    .push(format!("{name} <= {};", w.wire(id)));
                kept.push(Register {
                    range: range(graph, id),
                    name: name.into(),
                    meaning: String::new(),
                });
            }
        }
        // A probe that shows a register shows what it was before the sample.
        for (name, id) in &graph.probes {
            if graph.node(*id).op == Op::Input {
                let bits = width(graph, *id);
                w.read(w.name(*id), bits - 1, 0);
                w.declare(name, bits);
                let sampled = SAMPLED.contains(&w.name(*id));
                let (step, form) = if sampled { (1, "_held") } else { (0, "") };
                captures[step]
                    .1
                    .push(format!("{name} <= {}{form};", w.name(*id)));
                kept.push(Register {
                    range: range(graph, *id),
                    name: name.clone(),
                    meaning: String::new(),
                });
            }
        }
        captures.retain(|c| !c.1.is_empty());
        sections.retain(|s| !s.lines.is_empty());
        let (mut state, mut commits, mut held) = (vec![], vec![], vec![]);
        for (name, id) in &graph.inputs {
            let sampled = SAMPLED.contains(&name.as_str());
            // A pin that no formula reads needs no register: `calibrate` of a chip without calibration.
            let read = graph.is_read(*id);
            let form = if sampled && read {
                format!("{name}_held")
            } else {
                name.clone()
            };
            w.declare(&form, width(graph, *id));
            let register = Register {
                range: range(graph, *id),
                name: name.clone(),
                meaning: meaning(name),
            };
            if sampled {
                held.extend(read.then_some(register));
                continue;
            }
            state.push(register);
            let next = graph.next.iter().find(|(n, _)| n == name);
            if let Some(&(_, next)) = next {
                let bits = width(graph, *id);
                let text = match graph.node(next).kind {
                    Kind::Flag => w.condition_of(next, commit),
                    _ => w.fit(
                        &w.at(next, commit),
                        graph.node(next).format.fraction,
                        bits,
                        None,
                    ),
                };
                commits.push((name.clone(), text));
            }
        }
        Self {
            sections,
            captures,
            kept,
            state,
            commits,
            held,
        }
    }
}

/// What a register, an input or a probe is, in a sentence.
pub(crate) fn meaning(name: &str) -> String {
    use nonius_model::bits::Bits;
    use nonius_model::kernel::{Input, Probes, State};
    State::<Bits>::meaning(name)
        .or_else(|| Probes::<Bits>::meaning(name))
        .or_else(|| Input::<Bits>::meaning(name))
        .unwrap_or_default()
        .to_owned()
}
