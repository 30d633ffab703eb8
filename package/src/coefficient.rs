//! The coefficients of a chip and what rounding them costs.

use nonius_model::design::Design;
use nonius_model::format::Format;
use nonius_model::graph::Op;
use nonius_model::kernel::{Coefficients, Constant};
use serde::Serialize;

/// A coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct Coefficient {
    /// Its name.
    pub name: String,
    /// What it is.
    pub meaning: &'static str,
    /// Integer.
    pub raw: i64,
    /// Bits.
    pub bits: u32,
    /// Fraction bits.
    pub fraction_bits: u32,
    /// What it should be.
    pub real: f64,
    /// What it is.
    pub quantised: f64,
    /// The difference as a fraction of `real`; 0 where that is 0.
    pub relative_error: f64,
}

impl Coefficient {
    /// Those that the chip has.
    pub(crate) fn all(design: &Design) -> Vec<Self> {
        let (t, mut list) = (&design.tracking, vec![]);
        design.constants.map(|name, constant| {
            let used = design.graph.ids().any(|id| {
                let node = design.graph.node(id);
                let named = node.name.as_deref() == Some(name);
                named && matches!(node.op, Op::Constant(_)) && design.graph.is_read(id)
            });
            if !used {
                return;
            }
            let quantised = constant.value();
            let real = match name {
                "loop_a" => t.a,
                "loop_ab" => t.ab,
                "loop_leak" => 1.0 - t.pole,
                "skew_delay" => design.skew.map_or(0.0, |skew| skew.delay),
                _ => constant.ideal,
            };
            let bits =
                Format::covering(constant.raw.into(), constant.raw.into(), constant.fraction).width;
            list.push(Self {
                name: name.into(),
                meaning: Coefficients::<Constant>::meaning(name).unwrap_or_default(),
                raw: constant.raw,
                bits,
                fraction_bits: constant.fraction,
                real,
                quantised,
                relative_error: if real == 0.0 {
                    0.0
                } else {
                    // No negative zero.
                    (quantised - real) / real + 0.0
                },
            });
        });
        list
    }
}
