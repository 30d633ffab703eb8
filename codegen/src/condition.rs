//! Expressions of conditions. Some synthesis tools get short comparisons with negative numbers wrong: none is written.

use nonius_model::graph::{NodeId, Op};

use crate::writer::{Source, Term, Writer, literal};

impl Writer<'_> {
    /// The expression of a condition.
    pub(crate) fn condition(&self, id: NodeId) -> String {
        let cycle = self.schedule.ready[id.index()];
        let flag = |o: NodeId| self.flag(&self.at(o, cycle));
        match self.graph.node(id).op {
            Op::And(a, b) => format!("({} & {})", flag(a), flag(b)),
            Op::Or(a, b) => format!("({} | {})", flag(a), flag(b)),
            Op::Xor(a, b) => format!("({} ^ {})", flag(a), flag(b)),
            Op::Not(a) => {
                let text = flag(a);
                let negated = text.strip_prefix('~').map(str::to_owned);
                negated.unwrap_or_else(|| format!("~{text}"))
            }
            Op::LessThan(a, b) => {
                let (a, b) = (self.at(a, cycle), self.at(b, cycle));
                let fraction = a.fraction.max(b.fraction);
                let need = |t: &Term| t.width + fraction - t.fraction;
                let wide = need(&a).max(need(&b));
                if let Some(short) = self.short_comparison(&a, &b, fraction, wide) {
                    return short;
                }
                let left = self.signed(&a, fraction, wide);
                let right = self.signed(&b, fraction, wide);
                match (&a.source, &b.source) {
                    (_, Source::Constant(limit)) if *limit < 0 => {
                        let limit = limit << (fraction - b.fraction);
                        format!("~{}", at_least(&format!("~{left}"), limit, wide))
                    }
                    (Source::Constant(limit), _) if *limit < 0 => {
                        let limit = limit << (fraction - a.fraction);
                        at_least(&format!("~{right}"), limit + 1, wide)
                    }
                    _ => format!("({left} < {right})"),
                }
            }
            _ => flag(id),
        }
    }

    /// Condition `id`, read in `cycle`.
    pub(crate) fn condition_of(&self, id: NodeId, cycle: usize) -> String {
        self.flag(&self.at(id, cycle))
    }

    /// Below the last one of a coefficient no bit matters: x < m 2^k is floor(x / 2^k) < m.
    fn short_comparison(&self, a: &Term, b: &Term, fraction: u32, wide: u32) -> Option<String> {
        let Source::Constant(limit) = b.source else {
            return None;
        };
        let Source::Signal(..) = a.source else {
            return None;
        };
        let limit = limit << (fraction - b.fraction);
        let below = if limit == 0 {
            wide - 1
        } else {
            limit.trailing_zeros()
        };
        let below = below.min(wide - 1);
        let drop = below.checked_sub(fraction - a.fraction)?.min(a.width - 1);
        if drop == 0 {
            return None;
        }
        let limit = limit >> (drop + fraction - a.fraction);
        let upper = self.slice(a, a.width - 1, drop);
        if limit == 0 {
            // Negative or not: the sign bit.
            return Some(self.slice(a, a.width - 1, a.width - 1));
        }
        let bits = (a.width - drop).max(crate::quantise::covering(limit, -limit));
        let upper = if bits > a.width - drop {
            let sign = self.slice(a, a.width - 1, a.width - 1);
            format!("{{{{{}{{{sign}}}}}, {upper}}}", bits - (a.width - drop))
        } else {
            upper
        };
        if limit < 0 {
            let not_below = at_least(&format!("$signed(~{upper})"), limit, bits);
            return Some(format!("~{not_below}"));
        }
        Some(format!("($signed({upper}) < {})", literal(limit, bits)))
    }

    fn flag(&self, term: &Term) -> String {
        match &term.source {
            Source::Constant(raw) => format!("1'b{raw}"),
            Source::Condition(text) => text.clone(),
            Source::Signal(name, _) => {
                self.read(name, 0, 0);
                name.clone()
            }
        }
    }
}

/// x ≥ `limit`, which is not above 0, given ~x: ~x < −limit. Yosys 0.23 gets wrong what compares four bits or fewer with a
/// negative number (`hdl/tests/netlist.rs` sees it).
fn at_least(complement: &str, limit: i128, bits: u32) -> String {
    let bits = bits.max(crate::quantise::covering(limit, -limit));
    format!("({complement} < {})", literal(-limit, bits))
}
