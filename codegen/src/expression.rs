//! One operation, one statement; a rounding or choice with one reader stands in that, what only moves the point in each, and what has a
//! name only with its point moved has that one.

use nonius_model::graph::{NodeId, Op};

use crate::netlist::width;
use crate::quantise::{Target, quantise};
use crate::writer::{Source, Term, Writer};

/// The declarations and assignments that compute node `id` in its cycle.
pub(crate) fn lines(w: &Writer, id: NodeId) -> Vec<String> {
    computed(w, w.pointed(id).unwrap_or(id), id)
}

/// The same where node `of` is computed, and called `id`.
fn computed(w: &Writer, of: NodeId, id: NodeId) -> Vec<String> {
    let graph = w.graph;
    let cycle = w.schedule.ready[of.index()];
    let node = graph.node(of);
    let bits = width(graph, of);
    let fraction = node.format.fraction;
    let at = |o: NodeId| w.at(o, cycle);
    let one = |expression: String| vec![declaration(w, id, &expression)];
    match node.op {
        Op::Input | Op::Constant(_) => vec![],
        Op::Add(a, b) => one(appended(w, &at(a), &at(b), fraction, bits)
            .unwrap_or_else(|| sum(w, &at(a), &at(b), "+", fraction, bits, None))),
        Op::Sub(a, b) => one(mirrored(w, &at(a), &at(b), bits)
            .unwrap_or_else(|| sum(w, &at(a), &at(b), "-", fraction, bits, None))),
        Op::Neg(a) => one(format!("-{}", w.fit(&at(a), fraction, bits, None))),
        Op::Mul(..) => {
            let unit = w.schedule.issue[id.index()].map_or(0, |(unit, _)| unit);
            let product = Term {
                source: Source::Signal(format!("product_{unit}"), 0),
                width: bits,
                fraction,
                range: node.range,
            };
            one(w.slice(&product, bits - 1, 0))
        }
        Op::Scale(a, power) => {
            let mut term = at(a);
            // The point moves; zeros are appended only where it would pass the last bit.
            let moved = i64::from(term.fraction) - i64::from(power);
            let zeros = (-moved).max(0) as u32;
            term.fraction = 0;
            one(w.fit(&term, zeros, bits, None))
        }
        Op::Quantise(a, to) => {
            if let Some(choice) = crate::quantise::choice(w, a, of) {
                return one(chosen(w, choice, cycle, fraction, bits));
            }
            let target = Target { id, to, bits };
            if let Some(lines) = crate::quantise::of_sum(w, a, &target) {
                return lines;
            }
            quantise(w, &at(a), &target)
        }
        Op::QuantiseGeared {
            value,
            gear,
            stride,
            last,
            to,
        } => match w.schedule.shift[id.index()] {
            Some(unit) => {
                let name = format!("shifted_{unit}");
                w.read(&name, bits - 1, 0);
                one(name)
            }
            None => {
                let keep = to.format.fraction + 1;
                let input = crate::shifter::input(w, &at(value), keep);
                let name = w.name(id);
                let (wide, whole) = (input.1, format!("{name}_unshifted"));
                let shifted = format!("{name}_shifted");
                w.declare(&whole, wide);
                w.declare(&shifted, wide);
                w.read(&whole, wide - 1, 0);
                let amount = crate::shifter::amount(w, &at(gear), stride, last);
                let mut lines = vec![
                    format!("wire signed [{}:0] {whole} = {};", wide - 1, input.0),
                    format!(
                        "wire signed [{}:0] {shifted} = {whole} >>> {amount};",
                        wide - 1
                    ),
                ];
                let term = Term {
                    source: Source::Signal(shifted, 0),
                    width: wide,
                    fraction: keep,
                    range: input.2,
                };
                lines.extend(quantise(w, &term, &Target { id, to, bits }));
                lines
            }
        },
        Op::Select(c, a, b) => one(chosen(w, [c, a, b], cycle, fraction, bits)),
        Op::LessThan(..) | Op::And(..) | Op::Or(..) | Op::Xor(..) | Op::Not(_) => {
            if w.inline(id) {
                return vec![];
            }
            let text = w.condition(id);
            let bare = text.strip_prefix('(').and_then(|t| t.strip_suffix(')'));
            one(bare.map_or(text.clone(), ToOwned::to_owned))
        }
        Op::Lookup { rom, column, .. } => {
            let rom = &graph.roms[rom];
            let below: u32 = rom.columns[column + 1..]
                .iter()
                .map(|c| c.format.width)
                .sum();
            let format = rom.columns[column].format;
            let own = format.width;
            let row = format!("{}_row", rom.name);
            w.read(&row, below + own - 1, below);
            let word = if own == rom.row_width() {
                row
            } else {
                format!("{row}[{}:{below}]", below + own - 1)
            };
            one(if format.signed {
                word
            } else {
                format!("{{1'b0, {word}}}")
            })
        }
    }
}

/// A choice between two values, in the format in which it is written.
fn chosen(
    w: &Writer,
    [condition, yes, no]: [NodeId; 3],
    cycle: usize,
    fraction: u32,
    bits: u32,
) -> String {
    let condition = w.condition_of(condition, cycle);
    let [yes, no] = [yes, no].map(|o| w.fit(&w.at(o, cycle), fraction, bits, None));
    format!("{condition} ? {yes} : {no}")
}

/// A coefficient that fits into the zeros appended to `a` needs no adder.
fn appended(w: &Writer, a: &Term, b: &Term, fraction: u32, bits: u32) -> Option<String> {
    let Source::Constant(raw) = b.source else {
        return None;
    };
    let zeros = fraction - a.fraction;
    let raw = raw << (fraction - b.fraction);
    if raw <= 0 || raw >> zeros != 0 {
        return None;
    }
    let upper = w.fit(a, a.fraction, bits - zeros, None);
    Some(format!("{{{upper}, {zeros}'h{raw:x}}}"))
}

/// 2^n − 1 less a number of n bits is that number with every bit inverted.
fn mirrored(w: &Writer, a: &Term, b: &Term, bits: u32) -> Option<String> {
    let Source::Constant(raw) = a.source else {
        return None;
    };
    let n = 128 - raw.leading_zeros();
    let ones = raw > 0 && raw == (1i128 << n) - 1;
    let fits = b.range.0 >= 0 && b.range.1 <= raw;
    if !ones || !fits || a.fraction != b.fraction || bits <= n || b.width < n {
        return None;
    }
    let own = w.slice(b, n - 1, 0);
    Some(match bits - n {
        1 => format!("{{1'b0, ~{own}}}"),
        zeros => format!("{{{zeros}'b0, ~{own}}}"),
    })
}

/// `a` and `b`, aligned and cut to `bits`; `half` sets one of the zeros appended to `a` or, failing that, to `b`.
pub(crate) fn sum(
    w: &Writer,
    a: &Term,
    b: &Term,
    symbol: &str,
    fraction: u32,
    bits: u32,
    half: Option<u32>,
) -> String {
    let room = |t: &Term| match t.source {
        Source::Constant(_) => true,
        _ => half.is_some_and(|h| fraction - t.fraction > h),
    };
    let (half_a, half_b) = if half.is_none() {
        (None, None)
    } else if room(a) {
        (half, None)
    } else {
        (None, half)
    };
    format!(
        "{} {symbol} {}",
        w.fit(a, fraction, bits, half_a),
        w.fit(b, fraction, bits, half_b)
    )
}

/// The wire of node `id` with its expression, its format and its step.
pub(crate) fn declaration(w: &Writer, id: NodeId, expression: &str) -> String {
    let wire = w.wire(id);
    w.declare(&wire, width(w.graph, id));
    let range = crate::writer::range(w.graph, id);
    let line = format!("wire {range}{wire} = {expression};");
    let node = w.graph.node(id);
    let step = w.schedule.ready[id.index()];
    let format = if range.is_empty() {
        String::new()
    } else {
        format!("{}, ", node.format)
    };
    format!("{line} // {format}step {step}")
}
