//! The lossy step in Verilog: rounding, then saturation or wrapping, and neither where intervals show that it cannot
//! matter.

use nonius_model::format::{Overflow, Quantiser, Rounding};
use nonius_model::graph::{Graph, NodeId, Op};

use crate::expression::{declaration, sum};
use crate::writer::{Source, Term, Writer, literal};

/// What becomes of the value.
pub(crate) struct Target {
    /// The node.
    pub(crate) id: NodeId,
    /// Its format and the way into it.
    pub(crate) to: Quantiser,
    /// Bits of the node in the Verilog.
    pub(crate) bits: u32,
}

/// Bits that hold the integers from `low` to `high` in two's complement.
pub(crate) fn covering(low: i128, high: i128) -> u32 {
    nonius_model::format::Format::covering(low, high, 0).width
}

/// The half bit that rounds, as the index of the bit that is added.
fn half(to: &Quantiser, fraction: u32) -> Option<u32> {
    let drop = fraction.checked_sub(to.format.fraction)?;
    (to.rounding == Rounding::Nearest && drop > 0).then(|| drop - 1)
}

/// Quantisation of a sum in one adder: the half bit stands among the zeros appended to one of the summands.
pub(crate) fn of_sum(w: &Writer, a: NodeId, target: &Target) -> Option<Vec<String>> {
    let graph = w.graph;
    let cycle = w.schedule.ready[target.id.index()];
    let node = graph.node(a);
    let half = half(&target.to, node.format.fraction)?;
    let (x, y, symbol) = match node.op {
        Op::Add(x, y) => (w.at(x, cycle), w.at(y, cycle), "+"),
        Op::Sub(x, y) => (w.at(x, cycle), w.at(y, cycle), "-"),
        _ => return None,
    };
    if !fused(w, graph, a) {
        return None;
    }
    let fraction = node.format.fraction;
    let offset = 1i128 << half;
    let range = (node.range.0 + offset, node.range.1 + offset);
    let bits = covering(range.0, range.1);
    let name = format!("{}_rounded", w.name(target.id));
    let rounded = sum(w, &x, &y, symbol, fraction, bits, Some(half));
    w.declare(&name, bits);
    let term = Term {
        source: Source::Signal(name.clone(), 0),
        width: bits,
        fraction,
        range,
    };
    let clamped = clamp(w, &drop_bits(&term, &target.to), &target.to, target.bits);
    Some(vec![
        format!("wire signed [{}:0] {name} = {rounded};", bits - 1),
        declaration(w, target.id, &clamped),
    ])
}

/// Condition and values of choice `a` where it is written inside its only reader, in whose format all of it has room.
pub(crate) fn choice(w: &Writer, a: NodeId, reader: NodeId) -> Option<[NodeId; 3]> {
    let node = w.graph.node(a);
    let (Op::Select(condition, yes, no), Op::Quantise(_, to)) = (node.op, w.graph.node(reader).op)
    else {
        return None;
    };
    let whole =
        node.format.fraction <= to.format.fraction && holds(&to, node.range, node.format.fraction);
    (whole && node.name.is_none() && w.only_for(a, reader)).then_some([condition, yes, no])
}

/// A range in units of the target's last bit.
fn in_target(to: &Quantiser, range: (i128, i128), fraction: u32) -> (i128, i128) {
    let shift = to.format.fraction - fraction.min(to.format.fraction);
    (range.0 << shift, range.1 << shift)
}

/// Whether everything in `range` is in the target's.
fn holds(to: &Quantiser, range: (i128, i128), fraction: u32) -> bool {
    let (low, high) = in_target(to, range, fraction);
    low >= to.format.min_raw() && high <= to.format.max_raw()
}

/// Whether `a` is written inside its only reader: a sum, a choice, or what has its name.
pub(crate) fn fused(w: &Writer, graph: &Graph, a: NodeId) -> bool {
    let reader = graph
        .ids()
        .find(|&id| graph.node(id).op.operands().any(|o| o == a));
    let Some(reader) = reader else { return false };
    if w.pointed(reader) == Some(a) {
        return true;
    }
    let Op::Quantise(_, to) = graph.node(reader).op else {
        return false;
    };
    if !w.only_for(a, reader) {
        return false;
    }
    if choice(w, a, reader).is_some() {
        return true;
    }
    let node = graph.node(a);
    let Some(half) = half(&to, node.format.fraction) else {
        return false;
    };
    let room = |o: NodeId| {
        let entry = graph.node(o);
        matches!(entry.op, Op::Constant(_)) || node.format.fraction - entry.format.fraction > half
    };
    match node.op {
        Op::Add(x, y) => room(x) || room(y),
        Op::Sub(x, _) => room(x),
        _ => false,
    }
}

/// The term without the bits below the target's last one.
fn drop_bits(term: &Term, to: &Quantiser) -> Term {
    let drop = term.fraction.saturating_sub(to.format.fraction);
    let Source::Signal(name, base) = &term.source else {
        return term.clone();
    };
    let range = (term.range.0 >> drop, term.range.1 >> drop);
    let width = (term.width.saturating_sub(drop)).max(1);
    Term {
        source: Source::Signal(name.clone(), base + drop.min(term.width - 1)),
        width: width.min(covering(range.0, range.1).max(1)),
        fraction: term.fraction - drop,
        range,
    }
}

/// Statements that bring `term` into the target's format.
pub(crate) fn quantise(w: &Writer, term: &Term, target: &Target) -> Vec<String> {
    let (mut lines, text) = convert(w, term, &target.to, target.bits, w.name(target.id));
    lines.push(declaration(w, target.id, &text));
    lines
}

/// The same into a signal that is no node.
pub(crate) fn into_signal(
    w: &Writer,
    term: &Term,
    to: &Quantiser,
    bits: u32,
    name: &str,
) -> Vec<String> {
    let (mut lines, text) = convert(w, term, to, bits, name);
    w.declare(name, bits);
    lines.push(format!("wire signed [{}:0] {name} = {text};", bits - 1));
    lines
}

/// Statements before, and the expression of the result.
fn convert(
    w: &Writer,
    term: &Term,
    to: &Quantiser,
    target_bits: u32,
    name: &str,
) -> (Vec<String>, String) {
    if let (Some(half), Source::Signal(source, base)) = (half(to, term.fraction), &term.source) {
        // Half a bit more and cut off is cut off and one more where the bit below is set.
        let drop = half + 1;
        let offset = 1i128 << half;
        let range = (
            (term.range.0 + offset) >> drop,
            (term.range.1 + offset) >> drop,
        );
        let bits = covering(range.0, range.1);
        // Above its own bits the sign goes on.
        let top = term.width - 1;
        let below = w.slice(term, half.min(top), half.min(top));
        let whole = Term {
            source: Source::Signal(source.clone(), base + drop.min(top)),
            width: term.width.saturating_sub(drop).max(1),
            fraction: term.fraction - drop,
            range: (term.range.0 >> drop, term.range.1 >> drop),
        };
        let name = format!("{name}_rounded");
        w.declare(&name, bits);
        let zeros = match bits {
            1 => String::new(),
            n => format!("{}'b0, ", n - 1),
        };
        let rounded = format!(
            "{} + {{{zeros}{below}}}",
            w.fit(&whole, whole.fraction, bits, None)
        );
        let term = Term {
            source: Source::Signal(name.clone(), 0),
            width: bits,
            fraction: whole.fraction,
            range,
        };
        let text = clamp(w, &drop_bits(&term, to), to, target_bits);
        if text == name {
            return (vec![], rounded);
        }
        let line = format!("wire signed [{}:0] {name} = {rounded};", bits - 1);
        return (vec![line], text);
    }
    (vec![], clamp(w, &drop_bits(term, to), to, target_bits))
}

/// The expression that keeps the value in the target's range; `term` has no bits below the target's last one.
fn clamp(w: &Writer, term: &Term, to: &Quantiser, bits: u32) -> String {
    let format = to.format;
    let fraction = format.fraction.max(term.fraction);
    let shift = format.fraction - term.fraction.min(format.fraction);
    let (low, high) = in_target(to, term.range, term.fraction);
    if holds(to, term.range, term.fraction) || to.overflow == Overflow::Never {
        return w.fit(term, fraction, bits, None);
    }
    // Bits of the format itself; the node of an unsigned one has a sign bit more.
    let own = format.width;
    let kept = |to: u32| w.fit(term, fraction, to, None);
    if to.overflow == Overflow::Wrap {
        return if format.signed {
            kept(own)
        } else {
            format!("{{1'b0, {}}}", kept(own))
        };
    }
    let sign = w.slice(term, term.width - 1, term.width - 1);
    if format.signed {
        // Bits from the target's sign upwards are all alike where the value fits.
        let upper = w.slice(term, term.width - 1, own - 1 - shift);
        let alike = match term.width - (own - 1 - shift) {
            2 => {
                let below = w.slice(term, term.width - 2, term.width - 2);
                format!("{sign} == {below}")
            }
            n => format!("{upper} == {{{n}{{{sign}}}}}"),
        };
        let limit = format!("{{{sign}, {{{}{{~{sign}}}}}}}", own - 1);
        return format!("({alike}) ? {} : {limit}", kept(bits));
    }
    let mut text = kept(bits);
    if high > format.max_raw() {
        let top = w.slice(term, term.width - 2, own - shift);
        let any = if term.width - 2 > own - shift {
            format!("(|{top})")
        } else {
            top
        };
        let limit = literal(format.max_raw(), bits);
        text = format!("{any} ? {limit} : {{1'b0, {}}}", kept(own));
    }
    if low < 0 {
        text = format!("{sign} ? {} : ({text})", literal(0, bits));
    }
    text
}
