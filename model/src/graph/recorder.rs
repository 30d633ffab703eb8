//! The recorder: collects what kernels compute on its [`Node`]s.

use std::cell::RefCell;
use std::collections::HashMap;

use super::interval::{RangeError, input_fits, reach};
use super::node::{Flag, Node};
use super::{Entry, Graph, Kind, NodeId, Op};
use crate::format::Format;
use crate::rom::Rom;
use crate::signal::Formula;

static INPUTS: Formula = Formula {
    title: "Registers, inputs and coefficients",
    equation: "",
    source: "",
};

/// Collects the graph while kernels run on its nodes.
#[derive(Debug)]
pub struct Recorder {
    inner: RefCell<Inner>,
}

#[derive(Debug)]
struct Inner {
    graph: Graph,
    seen: HashMap<(Op, Format), NodeId>,
    formula: usize,
    error: Option<RangeError>,
}

impl Default for Recorder {
    fn default() -> Self {
        Self::new()
    }
}

impl Recorder {
    /// An empty recording.
    #[must_use]
    pub fn new() -> Self {
        let graph = Graph {
            nodes: vec![],
            formulas: vec![&INPUTS],
            roms: vec![],
            inputs: vec![],
            probes: vec![],
            next: vec![],
        };
        let inner = Inner {
            graph,
            seen: HashMap::new(),
            formula: 0,
            error: None,
        };
        Self {
            inner: RefCell::new(inner),
        }
    }

    /// A register or input of the chip, anywhere in its format.
    pub fn input(&self, name: &str, format: Format) -> Node<'_> {
        let range = (format.min_raw(), format.max_raw());
        self.enter(name, format, range, Kind::Value)
    }

    /// A one-bit register or input of the chip.
    pub fn flag_input(&self, name: &str) -> Flag<'_> {
        Flag(self.enter(name, Format::unsigned(1, 0), (0, 1), Kind::Flag))
    }

    /// The flag that is always false.
    pub fn constant_flag(&self) -> Flag<'_> {
        let mut inner = self.inner.borrow_mut();
        let format = Format::unsigned(1, 0);
        let entry = Entry {
            op: Op::Constant(0),
            kind: Kind::Flag,
            format,
            range: (0, 0),
            name: None,
            formula: 0,
        };
        let id = inner.push(entry);
        Flag(Node { recorder: self, id })
    }

    fn enter(&self, name: &str, format: Format, range: (i128, i128), kind: Kind) -> Node<'_> {
        let mut inner = self.inner.borrow_mut();
        let entry = Entry {
            op: Op::Input,
            kind,
            format,
            range,
            name: Some(name.into()),
            formula: 0,
        };
        let id = inner.push(entry);
        inner.graph.inputs.push((name.into(), id));
        if let Err(error) = input_fits(name, format) {
            inner.error.get_or_insert(error);
        }
        Node { recorder: self, id }
    }

    /// A coefficient of value `raw` · 2^-`fraction`. Equal coefficients of one name are one node.
    pub fn constant(&self, name: Option<&str>, raw: i64, fraction: u32) -> Node<'_> {
        let id = self.inner.borrow_mut().constant(name, raw, fraction);
        Node { recorder: self, id }
    }

    /// A constant times 2^`power`, as a constant; `None`: it is none, or less of it would be left.
    pub(super) fn scaled(&self, id: NodeId, power: i32) -> Option<Node<'_>> {
        let mut inner = self.inner.borrow_mut();
        let entry = &inner.graph.nodes[id.index()];
        let Op::Constant(raw) = entry.op else {
            return None;
        };
        let fraction = entry.format.fraction;
        let raw = raw.checked_mul(1i64.checked_shl(u32::try_from(power).ok()?)?)?;
        let id = inner.constant(None, raw, fraction);
        Some(Node { recorder: self, id })
    }

    /// States that `node` is what register `name` holds after the sample.
    pub fn next(&self, name: &str, node: NodeId) {
        self.inner.borrow_mut().graph.next.push((name.into(), node));
    }

    /// States that waves and vectors show `node` under `name`.
    pub fn probe(&self, name: &str, node: NodeId) {
        let mut inner = self.inner.borrow_mut();
        inner.name(node, name);
        inner.graph.probes.push((name.into(), node));
    }

    /// The finished graph: what registers and probes depend on.
    ///
    /// # Errors
    /// The first value that interval analysis found not to fit.
    pub fn finish(self) -> Result<Graph, RangeError> {
        let inner = self.inner.into_inner();
        match inner.error {
            Some(error) => Err(error),
            None => Ok(inner.graph.pruned()),
        }
    }

    /// Records an operation.
    pub(super) fn record(&self, op: Op) -> Node<'_> {
        let id = self.inner.borrow_mut().record(op);
        Node { recorder: self, id }
    }

    /// Names a node.
    pub(super) fn name(&self, node: NodeId, name: &str) {
        self.inner.borrow_mut().name(node, name);
    }

    /// What is recorded from here on belongs to `formula`.
    pub(super) fn begin(&self, formula: &'static Formula) {
        let mut inner = self.inner.borrow_mut();
        let known = inner.graph.formulas.iter().position(|f| *f == formula);
        inner.formula = known.unwrap_or_else(|| {
            inner.graph.formulas.push(formula);
            inner.graph.formulas.len() - 1
        });
    }

    /// Index of a table.
    pub(super) fn rom(&self, rom: &Rom) -> usize {
        let mut inner = self.inner.borrow_mut();
        let known = inner.graph.roms.iter().position(|r| r.name == rom.name);
        known.unwrap_or_else(|| {
            inner.graph.roms.push(rom.clone());
            inner.graph.roms.len() - 1
        })
    }
}

impl Inner {
    fn push(&mut self, entry: Entry) -> NodeId {
        let id = NodeId(self.graph.nodes.len() as u32);
        self.graph.nodes.push(entry);
        id
    }

    fn constant(&mut self, name: Option<&str>, raw: i64, fraction: u32) -> NodeId {
        let entry = Entry {
            op: Op::Constant(raw),
            kind: Kind::Value,
            format: Format::covering(raw.into(), raw.into(), fraction),
            range: (raw.into(), raw.into()),
            name: name.map(str::to_owned),
            formula: 0,
        };
        let same = |e: &Entry| e.name.is_some() && *e == entry;
        if let Some(known) = self.graph.nodes.iter().position(same) {
            return NodeId(known as u32);
        }
        self.push(entry)
    }

    /// What needs no operation: a quantisation to the format the value has, the opposite of an opposite, the negative
    /// of a coefficient.
    fn trivial(&mut self, op: &Op) -> Option<NodeId> {
        match *op {
            Op::Quantise(a, to) if self.graph.node(a).format == to.format => Some(a),
            Op::Not(a) => match self.graph.node(a).op {
                Op::Not(inner) => Some(inner),
                _ => None,
            },
            Op::Neg(a) => {
                let Op::Constant(raw) = self.graph.node(a).op else {
                    return None;
                };
                let negative = self.graph.node(a).name.clone()?;
                let fraction = self.graph.node(a).format.fraction;
                Some(self.constant(Some(&format!("minus_{negative}")), -raw, fraction))
            }
            _ => None,
        }
    }

    fn record(&mut self, op: Op) -> NodeId {
        if let Some(id) = self.trivial(&op) {
            return id;
        }
        let reached = match reach(&op, &self.graph.nodes, &self.graph.roms) {
            Ok(reached) => reached,
            Err(mut error) => {
                let formula = self.graph.formulas[self.formula].title;
                error.signal = format!("a value of “{formula}”");
                self.error.get_or_insert(error);
                // Any placeholder will do: the recording has failed and finish() says so.
                super::interval::Reach {
                    format: Format::signed(2, 0),
                    range: (0, 0),
                    kind: Kind::Value,
                }
            }
        };
        let key = (op, reached.format);
        if let Some(&id) = self.seen.get(&key) {
            return id;
        }
        let (kind, format, range) = (reached.kind, reached.format, reached.range);
        let id = self.push(Entry {
            op,
            kind,
            format,
            range,
            name: None,
            formula: self.formula,
        });
        self.seen.insert(key, id);
        id
    }

    /// The first name given stays; a name that another node has gets a number.
    fn name(&mut self, id: NodeId, name: &str) {
        if self.graph.nodes[id.index()].name.is_some() {
            return;
        }
        let taken = |n: &str| {
            self.graph
                .nodes
                .iter()
                .any(|e| e.name.as_deref() == Some(n))
        };
        let mut unique = name.to_owned();
        let mut count = 1;
        while taken(&unique) {
            count += 1;
            unique = format!("{name}_{count}");
        }
        self.graph.nodes[id.index()].name = Some(unique);
    }
}
