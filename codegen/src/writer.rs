//! What the expressions are made of: references to values, their bits, and a record of which bits are read.
//!
//! Widths are explicit everywhere, so that no tool has to guess an extension or a sign. Concatenations and
//! part-selects are unsigned; where the sign matters (comparisons, shifts, products) they are marked `$signed`.

use std::cell::RefCell;
use std::collections::BTreeMap;

use nonius_model::graph::{Graph, Kind, NodeId, Op};

use crate::names::names;
use crate::netlist::{last_use, width};
use crate::schedule::{SAMPLED, Schedule};

/// Writes expressions of one chip.
pub(crate) struct Writer<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) schedule: &'a Schedule,
    pub(crate) names: Vec<String>,
    last: Vec<usize>,
    probed: Vec<bool>,
    uses: Vec<usize>,
    /// What is made of the held inputs alone stands from step 1 until the next sample.
    stable: Vec<bool>,
    widths: RefCell<BTreeMap<String, u32>>,
    read: RefCell<BTreeMap<String, u128>>,
    /// Coefficients in what is being written.
    coefficients: RefCell<Vec<String>>,
    declared: RefCell<Vec<(String, u32)>>,
}

/// A value in an expression.
#[derive(Clone, Debug)]
pub(crate) struct Term {
    /// Its name, or the number of a coefficient.
    pub(crate) source: Source,
    /// Bits, sign included.
    pub(crate) width: u32,
    /// Fraction bits.
    pub(crate) fraction: u32,
    /// Smallest and largest value in units of the last bit.
    pub(crate) range: (i128, i128),
}

#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A declared signal; the value starts at this bit.
    Signal(String, u32),
    /// A coefficient.
    Constant(i128),
    /// A condition in brackets.
    Condition(String),
}

impl<'a> Writer<'a> {
    pub(crate) fn new(graph: &'a Graph, schedule: &'a Schedule) -> Self {
        let mut uses = vec![0; graph.nodes.len()];
        for operand in graph.ids().flat_map(|id| graph.node(id).op.operands()) {
            uses[operand.index()] += 1;
        }
        let mut probed = vec![false; graph.nodes.len()];
        for (_, id) in &graph.probes {
            probed[id.index()] = true;
        }
        let names = names(graph);
        let mut stable = vec![false; graph.nodes.len()];
        for id in graph.ids() {
            let op = graph.node(id).op;
            stable[id.index()] = match op {
                Op::Input => SAMPLED.contains(&names[id.index()].as_str()),
                Op::Constant(_) => true,
                Op::Mul(..) | Op::Lookup { .. } | Op::QuantiseGeared { .. } => false,
                // A port is a register.
                _ if crate::ports::has_port(&names[id.index()]) => false,
                _ => op.operands().all(|o| stable[o.index()]),
            };
        }
        let mut widths = BTreeMap::new();
        for id in graph.ids() {
            let (name, bits) = (&names[id.index()], width(graph, id));
            for form in [name.clone(), format!("{name}_now"), format!("{name}_held")] {
                widths.insert(form, bits);
            }
        }
        Self {
            graph,
            schedule,
            names,
            last: last_use(graph, schedule),
            probed,
            uses,
            stable,
            widths: RefCell::new(widths),
            read: RefCell::default(),
            coefficients: RefCell::default(),
            declared: RefCell::default(),
        }
    }

    /// Whether a register keeps the value after its cycle.
    pub(crate) fn kept(&self, id: NodeId) -> bool {
        let leaf = matches!(self.graph.node(id).op, Op::Input | Op::Constant(_));
        !leaf
            && !self.stable[id.index()]
            && (self.last[id.index()] > self.schedule.ready[id.index()] || self.probed[id.index()])
    }

    /// A condition that stands where it is read instead of having a wire.
    pub(crate) fn inline(&self, id: NodeId) -> bool {
        let node = self.graph.node(id);
        node.kind == Kind::Flag
            && node.name.is_none()
            && !self.kept(id)
            && !matches!(node.op, Op::Input | Op::Constant(_) | Op::Select(..))
            && (self.uses[id.index()] == 1 || matches!(node.op, Op::Not(_)))
    }

    /// The value that node `id` is with another point only.
    fn rescaled(&self, id: NodeId) -> Option<NodeId> {
        let node = self.graph.node(id);
        let Op::Scale(value, _) = node.op else {
            return None;
        };
        let alike = width(self.graph, id) == width(self.graph, value)
            && node.range == self.graph.node(value).range;
        alike.then_some(value)
    }

    /// The value that is only read with another point where nameless node `id` stands: it has no wire of its own.
    pub(crate) fn moved(&self, id: NodeId) -> Option<NodeId> {
        let value = self.rescaled(id)?;
        let wire = self.graph.node(id).name.is_some() || self.kept(id) || self.is_next(id);
        (!wire).then(|| self.moved(value).unwrap_or(value))
    }

    /// The nameless value that nothing but node `id`, which has a wire, reads, with another point: it is computed there.
    pub(crate) fn pointed(&self, id: NodeId) -> Option<NodeId> {
        let value = self.rescaled(id).filter(|_| self.moved(id).is_none())?;
        let of = self.graph.node(value);
        // The name of a product says of what it is.
        let computed = matches!(of.op, Op::Add(..) | Op::Sub(..) | Op::Quantise(..));
        (computed && of.name.is_none() && self.only_for(value, id)).then_some(value)
    }

    fn is_next(&self, id: NodeId) -> bool {
        self.graph.next.iter().any(|(_, next)| *next == id)
    }

    pub(crate) fn name(&self, id: NodeId) -> &str {
        &self.names[id.index()]
    }

    /// The name that stands where the node is read.
    pub(crate) fn shown(&self, id: NodeId) -> &str {
        self.name(self.moved(id).unwrap_or(id))
    }

    /// The wire on which the value is computed.
    pub(crate) fn wire(&self, id: NodeId) -> String {
        if self.kept(id) {
            format!("{}_now", self.name(id))
        } else {
            self.name(id).to_owned()
        }
    }

    /// Whether nothing but node `by` reads `id`, in the cycle in which it is computed.
    pub(crate) fn only_for(&self, id: NodeId, by: NodeId) -> bool {
        self.uses[id.index()] == 1
            && !self.kept(id)
            && !self.is_next(id)
            && self.schedule.ready[id.index()] == self.schedule.ready[by.index()]
    }

    /// Node `id`, read in `cycle`.
    pub(crate) fn at(&self, id: NodeId, cycle: usize) -> Term {
        let node = self.graph.node(id);
        if let Some(value) = self.moved(id) {
            return Term {
                fraction: node.format.fraction,
                ..self.at(value, cycle)
            };
        }
        let source = match node.op {
            Op::Constant(raw) => {
                if let Some(name) = &node.name {
                    self.note_coefficient(name);
                }
                Source::Constant(raw.into())
            }
            Op::Input if SAMPLED.contains(&self.name(id)) => {
                Source::Signal(format!("{}_held", self.name(id)), 0)
            }
            Op::Input => Source::Signal(self.name(id).to_owned(), 0),
            _ if self.schedule.ready[id.index()] != cycle && !self.stable[id.index()] => {
                Source::Signal(self.name(id).to_owned(), 0)
            }
            _ if self.inline(id) => Source::Condition(self.condition(id)),
            _ => Source::Signal(self.wire(id), 0),
        };
        Term {
            source,
            width: width(self.graph, id),
            fraction: node.format.fraction,
            range: node.range,
        }
    }

    /// A coefficient stands in what is written: its name, unless it says no more than its value.
    fn note_coefficient(&self, name: &str) {
        let mut noted = self.coefficients.borrow_mut();
        let says = !matches!(name, "zero" | "one" | "minus_one" | "half" | "quarter");
        if says && !noted.iter().any(|n| n == name) {
            noted.push(name.to_owned());
        }
    }

    /// What `write` writes, and the coefficients that stand in it.
    pub(crate) fn with_coefficients<T>(&self, write: impl FnOnce() -> T) -> (T, Vec<String>) {
        self.coefficients.take();
        let written = write();
        (written, self.coefficients.take())
    }

    /// Declares a signal of `bits` bits, so that bits nobody reads can be named.
    pub(crate) fn declare(&self, name: &str, bits: u32) {
        self.widths.borrow_mut().insert(name.to_owned(), bits);
        self.declared.borrow_mut().push((name.to_owned(), bits));
    }

    /// Notes that the bits from `high` to `low` are read.
    pub(crate) fn read(&self, name: &str, high: u32, low: u32) {
        let mut read = self.read.borrow_mut();
        let entry = read.entry(name.to_owned()).or_insert(0);
        for bit in low..=high {
            *entry |= 1u128 << bit;
        }
    }

    /// Parts of declared signals that nothing reads.
    pub(crate) fn unread(&self) -> Vec<String> {
        let all = self.read.borrow();
        let mut list = vec![];
        for (name, bits) in self.declared.borrow().iter() {
            let (bits, read) = (*bits, all.get(name).copied().unwrap_or(0));
            let mut bit = 0;
            while bit < bits {
                let start = bit;
                let is_read = |b: u32| read >> b & 1 == 1;
                while bit < bits && is_read(bit) == is_read(start) {
                    bit += 1;
                }
                if is_read(start) {
                    continue;
                }
                list.push(if bit - start == bits {
                    name.clone()
                } else if bit - start == 1 {
                    format!("{name}[{start}]")
                } else {
                    format!("{name}[{}:{start}]", bit - 1)
                });
            }
        }
        list
    }

    /// Bits `high` to `low` of a term that is a signal.
    pub(crate) fn slice(&self, term: &Term, high: u32, low: u32) -> String {
        let Source::Signal(name, base) = &term.source else {
            return literal(slice_of(term, high, low), high - low + 1);
        };
        let (high, low) = (high + base, low + base);
        self.read(name, high, low);
        let whole = self.widths.borrow().get(name).copied().unwrap_or(0);
        if low == 0 && high + 1 == whole {
            name.clone()
        } else if high == low {
            format!("{name}[{high}]")
        } else {
            format!("{name}[{high}:{low}]")
        }
    }

    /// The term with `fraction` fraction bits in exactly `bits` bits; `half` sets one of the appended zeros. Right
    /// modulo 2^`bits`: what the interval says cannot be there is cut off.
    pub(crate) fn fit(&self, term: &Term, fraction: u32, bits: u32, half: Option<u32>) -> String {
        let zeros = fraction - term.fraction;
        if let Source::Constant(raw) = term.source {
            let half = half.map_or(0, |h| 1i128 << h);
            return literal((raw << zeros) + half, bits);
        }
        if zeros >= bits {
            // Nothing of it is left.
            return literal(half.map_or(0, |h| 1i128 << h), bits);
        }
        let own = term.width.min(bits - zeros);
        let copies = bits - zeros - own;
        let mut parts = vec![];
        if copies > 0 {
            let sign = self.slice(term, own - 1, own - 1);
            parts.push(match copies {
                1 => sign,
                _ => format!("{{{copies}{{{sign}}}}}"),
            });
        }
        parts.push(self.slice(term, own - 1, 0));
        if zeros > 0 {
            parts.push(match half {
                Some(bit) => format!("{zeros}'h{:x}", 1u128 << bit),
                None => format!("{zeros}'b0"),
            });
        }
        if parts.len() == 1 {
            parts.remove(0)
        } else {
            format!("{{{}}}", parts.join(", "))
        }
    }

    /// The same where the sign matters.
    pub(crate) fn signed(&self, term: &Term, fraction: u32, bits: u32) -> String {
        let text = self.fit(term, fraction, bits, None);
        if text.starts_with('{') || text.ends_with(']') {
            format!("$signed({text})")
        } else {
            text
        }
    }
}

fn slice_of(term: &Term, high: u32, low: u32) -> i128 {
    let raw = match term.source {
        Source::Constant(raw) => raw,
        _ => 0,
    };
    (raw >> low) & ((1i128 << (high - low + 1)) - 1)
}

/// A sized literal, decimal where it is short.
pub(crate) fn literal(raw: i128, bits: u32) -> String {
    let mask = (1u128 << bits) - 1;
    if (0..10).contains(&raw) {
        return format!("{bits}'sd{raw}");
    }
    format!("{bits}'sh{:x}", raw as u128 & mask)
}

/// `signed [n:0] ` or nothing for a flag.
pub(crate) fn range(graph: &Graph, id: NodeId) -> String {
    if graph.node(id).kind == Kind::Flag {
        String::new()
    } else {
        format!("signed [{}:0] ", width(graph, id) - 1)
    }
}
