//! One operation, one expression. Widths are explicit everywhere, so that no tool has to guess a sign.

use nonius_model::format::{Overflow, Quantiser, Rounding};
use nonius_model::graph::{Graph, Kind, NodeId, Op};

use crate::netlist::{base_name, declaration, reference, width};
use crate::schedule::Schedule;

/// A sized literal.
pub(crate) fn literal(raw: i64, bits: u32, kind: Kind) -> String {
    if kind == Kind::Flag {
        return format!("1'b{raw}");
    }
    let mask = if bits >= 64 {
        u64::MAX
    } else {
        (1u64 << bits) - 1
    };
    format!("{bits}'sh{:x}", raw as u64 & mask)
}

/// `name` of `from` bits, sign-extended to `to` bits after appending `zeros`.
fn extend(name: &str, from: u32, zeros: u32, to: u32) -> String {
    let copies = to - from - zeros;
    let mut parts = vec![];
    if copies > 0 {
        parts.push(format!("{{{copies}{{{name}[{}]}}}}", from - 1));
    }
    parts.push(name.to_owned());
    if zeros > 0 {
        parts.push(format!("{zeros}'b0"));
    }
    if parts.len() == 1 {
        name.to_owned()
    } else {
        format!("$signed({{{}}})", parts.join(", "))
    }
}

/// The declarations and assignments that compute node `id` in its cycle.
pub(crate) fn lines(graph: &Graph, schedule: &Schedule, id: NodeId) -> Vec<String> {
    let cycle = schedule.ready[id.index()];
    let node = graph.node(id);
    let at = |o: NodeId| reference(graph, schedule, o, cycle);
    let fraction = |o: NodeId| graph.node(o).format.fraction;
    let bits = width(graph, id);
    let name = format!("{}_now", base_name(graph, id));
    let declare =
        |expression: String| format!("{} = {expression};", declaration("wire", graph, id, &name));
    let aligned = |o: NodeId, fraction_to: u32, to: u32| {
        let zeros = fraction_to - fraction(o);
        extend(&at(o), width(graph, o), zeros, to)
    };
    // Operands may be wider than the interval of the result: compute wide enough, keep what is needed.
    let common = |a: NodeId, b: NodeId| {
        let f = fraction(a).max(fraction(b));
        let need = |o: NodeId| width(graph, o) + f - fraction(o);
        (f, need(a).max(need(b)))
    };
    let binary = |a: NodeId, b: NodeId, symbol: &str| {
        let (f, need) = common(a, b);
        let wide = bits.max(need + 1);
        let full = format!("{name}_full");
        let sum = format!("{} {symbol} {}", aligned(a, f, wide), aligned(b, f, wide));
        narrowed(wide, bits, full, sum, &declare)
    };
    match node.op {
        Op::Input | Op::Constant(_) => vec![],
        Op::Add(a, b) => binary(a, b, "+"),
        Op::Sub(a, b) => binary(a, b, "-"),
        Op::Neg(a) => {
            let wide = bits.max(width(graph, a) + 1);
            narrowed(
                wide,
                bits,
                format!("{name}_full"),
                format!("-{}", aligned(a, fraction(a), wide)),
                &declare,
            )
        }
        Op::Mul(..) => {
            let multiplier = schedule.issue[id.index()].map_or(0, |(m, _)| m);
            vec![declare(format!(
                "$signed(product_{multiplier}[{}:0])",
                bits - 1
            ))]
        }
        Op::Scale(a, power) => {
            let pad = (i64::from(power) - i64::from(fraction(a))).max(0) as u32;
            let (from, wide) = (width(graph, a) + pad, bits.max(width(graph, a) + pad));
            let _ = from;
            narrowed(
                wide,
                bits,
                format!("{name}_full"),
                extend(&at(a), width(graph, a), pad, wide),
                &declare,
            )
        }
        Op::Quantise(a, to) => quantise(
            &at(a),
            width(graph, a),
            fraction(a),
            &to,
            &name,
            bits,
            &declare,
        ),
        Op::QuantiseGeared {
            value,
            gear,
            stride,
            last,
            to,
        } => {
            // One bit below the last is enough for rounding: floor(floor(2x) + 1) / 2) = floor(x + 1/2).
            let grow = stride * last;
            let (from, f) = (width(graph, value), fraction(value));
            let keep = to.format.fraction + 1;
            let pad = keep.saturating_sub(f);
            let wide = from + pad;
            let whole = format!("{name}_whole");
            let shifted = format!("{name}_shifted");
            let amount = if stride == 1 {
                at(gear)
            } else {
                format!(
                    "({} * {stride})",
                    extend(&at(gear), width(graph, gear), 0, 8.max(width(graph, gear)))
                )
            };
            let mut lines = vec![format!(
                "wire signed [{}:0] {whole} = {};",
                wide - 1,
                extend(&at(value), from, pad, wide)
            )];
            let (source, f, wide) = if f > keep {
                let cut = format!("{name}_cut");
                lines.push(format!(
                    "wire signed [{}:0] {cut} = $signed({whole}[{}:{}]);",
                    wide - (f - keep) - 1,
                    wide - 1,
                    f - keep
                ));
                (cut, keep, wide - (f - keep))
            } else {
                (whole, f + pad, wide)
            };
            let _ = grow;
            lines.push(format!(
                "wire signed [{}:0] {shifted} = {source} >>> {amount};",
                wide - 1
            ));
            lines.extend(quantise(&shifted, wide, f, &to, &name, bits, &declare));
            lines
        }
        Op::LessThan(a, b) => {
            let (f, need) = common(a, b);
            vec![declare(format!(
                "{} < {}",
                aligned(a, f, need),
                aligned(b, f, need)
            ))]
        }
        Op::Select(c, a, b) => {
            let f = node.format.fraction;
            let need = |o: NodeId| width(graph, o) + f - fraction(o);
            let wide = bits.max(need(a)).max(need(b));
            let chosen = format!(
                "{} ? {} : {}",
                at(c),
                aligned(a, f, wide),
                aligned(b, f, wide)
            );
            narrowed(wide, bits, format!("{name}_full"), chosen, &declare)
        }
        Op::And(a, b) => vec![declare(format!("{} & {}", at(a), at(b)))],
        Op::Or(a, b) => vec![declare(format!("{} | {}", at(a), at(b)))],
        Op::Xor(a, b) => vec![declare(format!("{} ^ {}", at(a), at(b)))],
        Op::Not(a) => vec![declare(format!("~{}", at(a)))],
        Op::Lookup { rom, column, .. } => {
            let rom = &graph.roms[rom];
            let below: u32 = rom.columns[column + 1..]
                .iter()
                .map(|c| c.format.width)
                .sum();
            let own = rom.columns[column].format.width;
            vec![declare(format!(
                "$signed({{1'b0, {}_row[{}:{below}]}})",
                rom.name,
                below + own - 1
            ))]
        }
    }
}

/// `wide` bits computed, `bits` kept; interval analysis has shown that the rest is sign.
fn narrowed(
    wide: u32,
    bits: u32,
    full: String,
    expression: String,
    declare: &dyn Fn(String) -> String,
) -> Vec<String> {
    if wide == bits {
        return vec![declare(expression)];
    }
    vec![
        format!("wire signed [{}:0] {full} = {expression};", wide - 1),
        declare(format!("$signed({full}[{}:0])", bits - 1)),
    ]
}

fn quantise(
    source: &str,
    from: u32,
    fraction: u32,
    to: &Quantiser,
    name: &str,
    bits: u32,
    declare: &dyn Fn(String) -> String,
) -> Vec<String> {
    let target = to.format;
    let mut lines = vec![];
    let drop = fraction.saturating_sub(target.fraction);
    let pad = target.fraction.saturating_sub(fraction);
    // `whole` has the target's fraction bits and room for the carry of rounding.
    let (whole, have) = if drop > 0 {
        let have = (from + 1).saturating_sub(drop).max(2);
        let sum_bits = have + drop;
        let value = extend(source, from, 0, sum_bits);
        let sum = format!("{name}_sum");
        let expression = if to.rounding == Rounding::Nearest {
            format!(
                "{value} + {}",
                literal(1i64 << (drop - 1), sum_bits, Kind::Value)
            )
        } else {
            value
        };
        lines.push(format!(
            "wire signed [{}:0] {sum} = {expression};",
            sum_bits - 1
        ));
        let whole = format!("{name}_whole_part");
        lines.push(format!(
            "wire signed [{}:0] {whole} = $signed({sum}[{}:{drop}]);",
            have - 1,
            sum_bits - 1
        ));
        (whole, have)
    } else {
        let whole = format!("{name}_whole_part");
        let have = from + pad;
        lines.push(format!(
            "wire signed [{}:0] {whole} = {};",
            have - 1,
            extend(source, from, pad, have)
        ));
        (whole, have)
    };
    let w = target.width;
    if have <= w || (have == w + 1 && !target.signed && to.overflow != Overflow::Wrap) {
        // Nothing to cut; but an unsigned target still clamps negative values.
        let wide = bits.max(have);
        let value = extend(&whole, have, 0, wide);
        let kept = match (target.signed, to.overflow) {
            (true, _) | (false, Overflow::Never) => value,
            (false, Overflow::Saturate) => format!(
                "{whole}[{}] ? {} : {value}",
                have - 1,
                literal(0, wide, Kind::Value)
            ),
            (false, Overflow::Wrap) => {
                format!("$signed({{1'b0, {}}})", extend_bits(&whole, have, w))
            }
        };
        if wide == bits {
            lines.push(declare(kept));
        } else {
            lines.push(format!(
                "wire signed [{}:0] {name}_kept = {kept};",
                wide - 1
            ));
            lines.push(declare(format!("$signed({name}_kept[{}:0])", bits - 1)));
        }
        return lines;
    }
    let low = format!("{whole}[{}:0]", w - 1);
    let slice = if target.signed {
        format!("$signed({low})")
    } else {
        format!("$signed({{1'b0, {low}}})")
    };
    lines.push(declare(match to.overflow {
        Overflow::Wrap | Overflow::Never => slice,
        Overflow::Saturate => {
            let sign = format!("{whole}[{}]", have - 1);
            if target.signed {
                let upper = format!("{whole}[{}:{}]", have - 1, w - 1);
                let fits = format!("(&{upper} | ~|{upper})");
                format!(
                    "{fits} ? {slice} : $signed({{{sign}, {{{}{{~{sign}}}}}}})",
                    w - 1
                )
            } else {
                let upper = format!("{whole}[{}:{w}]", have - 2);
                let zero = literal(0, w + 1, Kind::Value);
                format!(
                    "{sign} ? {zero} : (|{upper}) ? $signed({{1'b0, {{{w}{{1'b1}}}}}}) : {slice}"
                )
            }
        }
    }));
    lines
}

/// `name` of `from` bits as exactly `to` ≥ `from` bits, sign-extended, as a concatenation.
fn extend_bits(name: &str, from: u32, to: u32) -> String {
    if from == to {
        name.to_owned()
    } else {
        format!("{{{}{{{name}[{}]}}}}, {name}", to - from, from - 1)
    }
}

/// A signed name of `from` bits, sign-extended to `to` bits.
pub(crate) fn extended(name: &str, from: u32, to: u32) -> String {
    extend(name, from, 0, to)
}
