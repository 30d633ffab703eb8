//! Interval analysis: what each operation can reach, in integers.

use thiserror::Error;

use super::{Entry, Kind, NodeId, Op};
use crate::format::{CONTAINER_FRACTION, CONTAINER_INTEGER, Format, Overflow, Quantiser, Rounding};
use crate::rom::Rom;

/// A value that does not fit, with the operands that lead there.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error(
    "{signal} does not fit {limit}: it reaches {reach} when {worst_case}; shorter words in \
     [formats] would help"
)]
pub struct RangeError {
    /// Name of the signal, or of the formula and operation where it has none.
    pub signal: String,
    /// What it should fit.
    pub limit: String,
    /// Smallest and largest value, and its steps.
    pub reach: String,
    /// The operands' ranges that lead there.
    pub worst_case: String,
}

/// Format, range and kind of what an operation yields.
pub(super) struct Reach {
    pub(super) format: Format,
    pub(super) range: (i128, i128),
    pub(super) kind: Kind,
}

const FLAG: Reach = Reach {
    format: Format::unsigned(1, 0),
    range: (0, 1),
    kind: Kind::Flag,
};

fn exact(range: (i128, i128), fraction: u32, kind: Kind) -> Reach {
    Reach {
        format: Format::covering(range.0, range.1, fraction),
        range,
        kind,
    }
}

fn lift(entry: &Entry, fraction: u32) -> (i128, i128) {
    let by = fraction - entry.format.fraction;
    (entry.range.0 << by, entry.range.1 << by)
}

fn widest(a: &Entry, b: &Entry) -> Kind {
    if a.kind == Kind::Wide || b.kind == Kind::Wide {
        Kind::Wide
    } else {
        Kind::Value
    }
}

fn hull(products: [i128; 4]) -> (i128, i128) {
    let [a, b, c, d] = products;
    (a.min(b).min(c).min(d), a.max(b).max(c).max(d))
}

/// A quantisation's reach; `None` where the range was to be proven and does not fit.
fn quantised(range: (i128, i128), fraction: u32, to: &Quantiser) -> Option<Reach> {
    let fits = |v: i128| v >= to.format.min_raw() && v <= to.format.max_raw();
    let rounded =
        |v: i128| Quantiser::new(to.format, to.rounding, Overflow::Never).apply(v, fraction);
    let (low, high) = (rounded(range.0), rounded(range.1));
    let all = (to.format.min_raw(), to.format.max_raw());
    let range = match to.overflow {
        Overflow::Saturate => (low.clamp(all.0, all.1), high.clamp(all.0, all.1)),
        Overflow::Wrap if fits(low) && fits(high) => (low, high),
        Overflow::Wrap => all,
        Overflow::Never if fits(low) && fits(high) => (low, high),
        Overflow::Never => return None,
    };
    Some(Reach {
        format: to.format,
        range,
        kind: Kind::Value,
    })
}

/// What `op` can reach, given the nodes before it.
pub(super) fn reach(op: &Op, nodes: &[Entry], roms: &[Rom]) -> Result<Reach, RangeError> {
    let at = |id: NodeId| &nodes[id.index()];
    let reached = match *op {
        Op::Input => unreachable!("inputs state their format"),
        Op::Constant(_) => unreachable!("constants state their format"),
        Op::Add(a, b) | Op::Sub(a, b) => {
            let (a, b) = (at(a), at(b));
            let fraction = a.format.fraction.max(b.format.fraction);
            let (x, y) = (lift(a, fraction), lift(b, fraction));
            let y = if matches!(op, Op::Sub(..)) {
                (-y.1, -y.0)
            } else {
                y
            };
            exact((x.0 + y.0, x.1 + y.1), fraction, widest(a, b))
        }
        Op::Neg(a) => exact(
            (-at(a).range.1, -at(a).range.0),
            at(a).format.fraction,
            at(a).kind,
        ),
        Op::Mul(a, b) => {
            let (x, y) = (at(a).range, at(b).range);
            let range = hull([x.0 * y.0, x.0 * y.1, x.1 * y.0, x.1 * y.1]);
            exact(
                range,
                at(a).format.fraction + at(b).format.fraction,
                Kind::Wide,
            )
        }
        Op::Scale(a, power) => {
            let fraction = i64::from(at(a).format.fraction) - i64::from(power);
            let pad = u32::try_from(-fraction.min(0)).unwrap_or(0);
            let range = (at(a).range.0 << pad, at(a).range.1 << pad);
            exact(range, fraction.max(0) as u32, at(a).kind)
        }
        Op::Quantise(a, ref to) => match quantised(at(a).range, at(a).format.fraction, to) {
            Some(reach) => reach,
            None => {
                return Err(outside(
                    op,
                    nodes,
                    at(a).range,
                    at(a).format.fraction,
                    to.format,
                ));
            }
        },
        Op::QuantiseGeared {
            value,
            stride,
            last,
            ref to,
            ..
        } => {
            let value = at(value);
            let fraction = value.format.fraction;
            let first = quantised(value.range, fraction, to);
            let slow = quantised(value.range, fraction + stride * last, to);
            match (first, slow) {
                (Some(a), Some(b)) => {
                    let range = (a.range.0.min(b.range.0), a.range.1.max(b.range.1));
                    Reach { range, ..a }
                }
                _ => return Err(outside(op, nodes, value.range, fraction, to.format)),
            }
        }
        Op::Select(_, a, b) => {
            let (a, b) = (at(a), at(b));
            let fraction = a.format.fraction.max(b.format.fraction);
            let (x, y) = (lift(a, fraction), lift(b, fraction));
            let range = (x.0.min(y.0), x.1.max(y.1));
            let kind = widest(a, b);
            if a.format == b.format {
                Reach {
                    format: a.format,
                    range,
                    kind,
                }
            } else {
                exact(range, fraction, kind)
            }
        }
        Op::LessThan(..) | Op::And(..) | Op::Or(..) | Op::Xor(..) | Op::Not(_) => FLAG,
        Op::Lookup { rom, column, .. } => {
            let column = &roms[rom].columns[column];
            let low = column.raw.iter().copied().min().unwrap_or(0);
            let high = column.raw.iter().copied().max().unwrap_or(0);
            Reach {
                format: column.format,
                range: (low.into(), high.into()),
                kind: Kind::Value,
            }
        }
    };
    in_container(op, nodes, reached)
}

/// Refuses an input or register that the container cannot hold.
pub(super) fn input_fits(name: &str, format: Format) -> Result<(), RangeError> {
    let range = (format.min_raw(), format.max_raw());
    let reached = Reach {
        format,
        range,
        kind: Kind::Value,
    };
    in_container(&Op::Input, &[], reached)
        .map(|_| ())
        .map_err(|e| RangeError {
            signal: name.into(),
            ..e
        })
}

/// Refuses what the container of the bit-true reading cannot hold.
fn in_container(op: &Op, nodes: &[Entry], reached: Reach) -> Result<Reach, RangeError> {
    let scale = if reached.kind == Kind::Wide { 2 } else { 1 };
    // A product is cut off at the container's last bit, so what it is rounded to ends before that.
    let rounds_product = match op {
        Op::Quantise(value, to) | Op::QuantiseGeared { value, to, .. } => {
            nodes[value.index()].kind == Kind::Wide && to.rounding == Rounding::Nearest
        }
        _ => false,
    };
    // One integer bit fewer than there is, so that rounding up stays inside. A product's sum ends in a value, so it
    // may have no more of them either.
    let integer = CONTAINER_INTEGER - 1;
    let fraction = scale * CONTAINER_FRACTION - u32::from(rounds_product);
    let limit = Format::signed(fraction + integer, fraction);
    let format = Format::covering(reached.range.0, reached.range.1, reached.format.fraction);
    let too_fine = format.fraction > fraction;
    let too_large = format.width > format.fraction + integer;
    if too_fine || too_large {
        return Err(outside(
            op,
            nodes,
            reached.range,
            reached.format.fraction,
            limit,
        ));
    }
    Ok(reached)
}

fn outside(
    op: &Op,
    nodes: &[Entry],
    range: (i128, i128),
    fraction: u32,
    limit: Format,
) -> RangeError {
    let describe = |id: NodeId| {
        let entry = &nodes[id.index()];
        let low = real(entry.range.0, entry.format.fraction);
        let high = real(entry.range.1, entry.format.fraction);
        format!("{} is {low} … {high} ({})", called(nodes, id), entry.format)
    };
    let operands: Vec<_> = op.operands().map(describe).collect();
    RangeError {
        signal: "a signal".into(),
        limit: limit.to_string(),
        reach: format!(
            "{} … {} in steps of 2^-{fraction}",
            real(range.0, fraction),
            real(range.1, fraction)
        ),
        worst_case: operands.join(" and "),
    }
}

/// Its name, or what it is made of, by names.
fn called(nodes: &[Entry], id: NodeId) -> String {
    let entry = &nodes[id.index()];
    if let Some(name) = &entry.name {
        return name.clone();
    }
    let of = |id: NodeId| called(nodes, id);
    match entry.op {
        Op::Add(a, b) => format!("({} + {})", of(a), of(b)),
        Op::Sub(a, b) => format!("({} - {})", of(a), of(b)),
        Op::Mul(a, b) => format!("{} * {}", of(a), of(b)),
        Op::Select(_, a, b) => format!("({} or {})", of(a), of(b)),
        Op::Neg(a) => format!("-{}", of(a)),
        Op::Scale(a, _) | Op::Quantise(a, _) => of(a),
        Op::QuantiseGeared { value, .. } => of(value),
        Op::Lookup { address, .. } => format!("the row at {}", of(address)),
        Op::Constant(raw) => real(raw.into(), entry.format.fraction),
        _ => "an input or a condition".into(),
    }
}

fn real(raw: i128, fraction: u32) -> String {
    format!("{}", raw as f64 * Format::signed(2, fraction).lsb())
}
