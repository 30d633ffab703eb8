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
        let graph = w.graph;
        let mut this = Self {
            sections: sections(graph),
            captures: (0..w.schedule.clocks).map(|step| (step, vec![])).collect(),
            kept: vec![],
            state: vec![],
            commits: vec![],
            held: vec![],
        };
        for id in graph.ids().filter(|id| has_statement(w, *id)) {
            this.write_statement(w, id);
            if w.kept(id) {
                this.keep_value(w, id);
            }
        }
        for (name, id) in &graph.probes {
            if graph.node(*id).op == Op::Input {
                this.keep_register(w, name, *id);
            }
        }
        this.captures.retain(|c| !c.1.is_empty());
        this.sections.retain(|s| !s.lines.is_empty());
        for (name, id) in &graph.inputs {
            if SAMPLED.contains(&name.as_str()) {
                this.hold_pin(w, name, *id);
            } else {
                this.declare_register(w, name, *id);
            }
        }
        this
    }

    /// The statement that computes a value, in its formula's section, with the coefficients in it.
    fn write_statement(&mut self, w: &Writer, id: NodeId) {
        let (mut lines, with) = w.with_coefficients(|| expression::lines(w, id));
        let with = with.join(", ");
        if let (Some(last), false) = (lines.last_mut(), with.is_empty()) {
            *last += &format!(", with {with}");
        }
        self.sections[w.graph.node(id).formula]
            .lines
            .extend(layout::laid_out(&lines));
    }

    /// A value that is read after its step, in a register of its own.
    fn keep_value(&mut self, w: &Writer, id: NodeId) {
        let (name, bits) = (w.name(id), width(w.graph, id));
        w.declare(name, bits);
        w.read(&w.wire(id), bits - 1, 0);
        let step = w.schedule.ready[id.index()];
        self.capture(step, name, &w.wire(id), range(w.graph, id));
    }

    /// A probe that shows a register shows what it was before the sample.
    fn keep_register(&mut self, w: &Writer, name: &str, id: NodeId) {
        let bits = width(w.graph, id);
        w.read(w.name(id), bits - 1, 0);
        w.declare(name, bits);
        let sampled = SAMPLED.contains(&w.name(id));
        let (step, form) = if sampled { (1, "_held") } else { (0, "") };
        let shown = format!("{}{form}", w.name(id));
        self.capture(step, name, &shown, range(w.graph, id));
    }

    /// Register `name` takes `value` at the end of `step`.
    fn capture(&mut self, step: usize, name: &str, value: &str, range: String) {
        self.captures[step].1.push(format!("{name} <= {value};"));
        self.kept.push(Register {
            range,
            name: name.into(),
            meaning: String::new(),
        });
    }

    /// A pin, held while its sample is worked on. One that no formula reads needs no register: `calibrate` of a chip without
    /// calibration.
    fn hold_pin(&mut self, w: &Writer, name: &str, id: NodeId) {
        let read = w.graph.is_read(id);
        let form = if read {
            format!("{name}_held")
        } else {
            name.to_owned()
        };
        w.declare(&form, width(w.graph, id));
        self.held.extend(read.then(|| register(w.graph, name, id)));
    }

    /// A register of the chip, and what it becomes at the end of a sample.
    fn declare_register(&mut self, w: &Writer, name: &str, id: NodeId) {
        w.declare(name, width(w.graph, id));
        self.state.push(register(w.graph, name, id));
        let next = w.graph.next.iter().find(|(n, _)| n == name);
        if let Some(&(_, next)) = next {
            let value = next_value(w, next, width(w.graph, id));
            self.commits.push((name.to_owned(), value));
        }
    }
}

/// The formulas, without statements as yet.
fn sections(graph: &Graph) -> Vec<Section> {
    let formulas = graph.formulas.iter();
    formulas
        .map(|f| Section {
            title: f.title.into(),
            equation: layout::wrap("", f.equation, layout::COMMENT - 6),
            source: f.source.into(),
            lines: vec![],
        })
        .collect()
}

/// Whether a value is computed by a statement of its own: it is not there from the start, nor another one with its point moved, nor
/// written inside its only reader.
fn has_statement(w: &Writer, id: NodeId) -> bool {
    !matches!(w.graph.node(id).op, Op::Input | Op::Constant(_))
        && w.moved(id).is_none()
        && !crate::quantise::fused(w, w.graph, id)
}

/// A register or a pin of the chip.
fn register(graph: &Graph, name: &str, id: NodeId) -> Register {
    Register {
        range: range(graph, id),
        name: name.to_owned(),
        meaning: meaning(name),
    }
}

/// What a register of so many `bits` takes when the sample ends.
fn next_value(w: &Writer, next: NodeId, bits: u32) -> String {
    let commit = w.schedule.clocks - 1;
    let node = w.graph.node(next);
    match node.kind {
        Kind::Flag => w.condition_of(next, commit),
        _ => w.fit(&w.at(next, commit), node.format.fraction, bits, None),
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
