//! Geared quantisations: an arithmetic shift, then the lossy step, alone or shared by several values.

use nonius_model::graph::{NodeId, Op};

use crate::layout;
use crate::quantise::covering;
use crate::writer::{Source, Term, Writer, literal};

/// `value` with `keep` fraction bits: text, bits and range. Bits that no shift can bring to the rounding are cut off.
///
/// One bit below the last is enough: floor((floor(2x) + 1) / 2) = floor(x + 1/2).
pub(crate) fn input(w: &Writer, value: &Term, keep: u32) -> (String, u32, (i128, i128)) {
    let drop = value.fraction.saturating_sub(keep);
    let zeros = keep.saturating_sub(value.fraction);
    let range = (
        value.range.0 << zeros >> drop,
        value.range.1 << zeros >> drop,
    );
    let bits = covering(range.0, range.1);
    let mut term = value.clone();
    if drop > 0
        && let Source::Signal(name, base) = &value.source
    {
        term.source = Source::Signal(name.clone(), base + drop);
        term.width = value.width.saturating_sub(drop).max(1);
        term.fraction = keep;
    }
    (w.fit(&term, keep, bits, None), bits, range)
}

/// The shift amount of a gear.
pub(crate) fn amount(w: &Writer, gear: &Term, stride: u32, last: u32) -> String {
    let bits = 32 - last.leading_zeros();
    let own = w.slice(gear, bits.min(gear.width - 1) - 1, 0);
    match stride {
        1 => own,
        n if n.is_power_of_two() => format!("{{{own}, {}'b0}}", n.trailing_zeros()),
        n => {
            let wide = 32 - (n * last).leading_zeros();
            let pad = wide - bits.min(wide);
            let own = if pad > 0 {
                format!("{{{pad}'b0, {own}}}")
            } else {
                own
            };
            format!("({own} * {wide}'d{n})")
        }
    }
}

/// A shared shifter in Verilog.
pub(crate) struct Unit {
    pub(crate) index: usize,
    pub(crate) bits: u32,
    /// Step, input, what it is for.
    pub(crate) loads: Vec<(usize, String, String)>,
    pub(crate) idle: String,
    pub(crate) lines: Vec<String>,
}

/// All shared shifters.
pub(crate) fn units(w: &Writer) -> Vec<Unit> {
    let schedule = w.schedule;
    let mut list = vec![];
    for (index, kind) in schedule.shifters.iter().enumerate() {
        let keep = kind.to.format.fraction + 1;
        let users: Vec<(NodeId, NodeId)> = w
            .graph
            .ids()
            .filter(|id| schedule.shift[id.index()] == Some(index))
            .filter_map(|id| match w.graph.node(id).op {
                Op::QuantiseGeared { value, .. } => Some((id, value)),
                _ => None,
            })
            .collect();
        let terms: Vec<(usize, Term, NodeId)> = users
            .iter()
            .map(|&(id, value)| {
                let cycle = schedule.ready[id.index()];
                (cycle, w.at(value, cycle), id)
            })
            .collect();
        let ranges: Vec<(i128, i128)> = terms.iter().map(|t| input(w, &t.1, keep).2).collect();
        let low = ranges.iter().map(|r| r.0).min().unwrap_or(0);
        let high = ranges.iter().map(|r| r.1).max().unwrap_or(0);
        let bits = covering(low, high);
        let mut loads: Vec<_> = terms
            .iter()
            .map(|(cycle, term, id)| {
                let (_, own, _) = input(w, term, keep);
                let text = widened(w, term, keep, own, bits);
                (*cycle, text, w.name(*id).to_owned())
            })
            .collect();
        loads.sort();
        let idle = loads.pop().map_or_else(|| literal(0, bits), |l| l.1);
        let first = terms.first().map_or(0, |t| t.0);
        let gear = w.at(kind.gear, first);
        let amount = amount(w, &gear, kind.stride, kind.last);
        let target_bits = kind.to.format.width + u32::from(!kind.to.format.signed);
        let mut lines = vec![];
        let shift = format!("shift_{index}");
        w.declare(&shift, bits);
        w.read(&format!("unshifted_{index}"), bits - 1, 0);
        lines.push(format!(
            "wire signed [{}:0] {shift} = unshifted_{index} >>> {amount};",
            bits - 1
        ));
        let term = Term {
            source: Source::Signal(shift, 0),
            width: bits,
            fraction: keep,
            range: (low, high),
        };
        lines.extend(crate::quantise::into_signal(
            w,
            &term,
            &kind.to,
            target_bits,
            &format!("shifted_{index}"),
        ));
        list.push(Unit {
            index,
            bits,
            loads,
            idle,
            lines: layout::laid_out(&lines),
        });
    }
    list
}

fn widened(w: &Writer, value: &Term, keep: u32, own: u32, bits: u32) -> String {
    let drop = value.fraction.saturating_sub(keep);
    let mut term = value.clone();
    if drop > 0
        && let Source::Signal(name, base) = &value.source
    {
        term.source = Source::Signal(name.clone(), base + drop);
        term.width = own.min(value.width.saturating_sub(drop).max(1));
        term.fraction = keep;
    }
    w.fit(&term, keep, bits, None)
}
