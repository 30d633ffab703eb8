//! The coefficients of a chip and what rounding them costs.

use nonius_model::design::Design;
use nonius_model::format::Format;
use nonius_model::graph::{Kind, Op};
use nonius_model::kernel::{Coefficients, Constant};
use serde::Serialize;

/// A coefficient.
#[derive(Clone, Debug, Serialize)]
pub struct Coefficient {
    /// Its name.
    pub name: String,
    /// What it is.
    pub meaning: String,
    /// Integer.
    pub raw: i64,
    /// Bits.
    pub bits: u32,
    /// Fraction bits.
    pub fraction_bits: u32,
    /// What it was derived as, before rounding.
    pub real: f64,
    /// What it is.
    pub quantised: f64,
    /// `quantised` less `real`.
    pub error: f64,
    /// The same as a fraction of `real`; 0 where that is 0.
    pub relative_error: f64,
    /// Why it is not what one would expect: it is shifted on purpose, or has few bits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// What is shifted by part of a bit on purpose, and why.
const SHIFTED: [(&str, &str); 3] = [
    (
        "quarter_turn",
        "the phase in the sine is cut and stands for the middle of what was cut off: its mirror image is its bits inverted",
    ),
    (
        "half_bit",
        "the middle of what was cut off the phase in the sine; without rounding nothing is cut off",
    ),
    (
        "unit_radius",
        "the residual is cut, and with half of its last bit here that is rounding",
    ),
];

/// Limits that are compared with: few bits make short comparators, and they need not be exact.
const LIMITS: [&str; 8] = [
    "lock_error",
    "lock_residual",
    "lock_radius",
    "lock_opposite",
    "restart_residual",
    "hold_residual",
    "small_error",
    "far_error",
];

fn note(name: &str, constant: &Constant) -> Option<String> {
    if let Some((_, why)) = SHIFTED.iter().find(|s| s.0 == name) {
        let by = constant.value() - constant.ideal;
        return Some(format!(
            "{} shifted by {by:e} on purpose: {why}",
            constant.ideal
        ));
    }
    let short = LIMITS.contains(&name) && constant.value() != constant.exact;
    short.then(|| "a limit of few bits makes a short comparator".to_owned())
}

impl Coefficient {
    /// The constant itself, or its negative.
    fn of(name: String, constant: &Constant, sign: i64) -> Self {
        let raw = constant.raw * sign;
        // No negative zero.
        let signed = |value: f64| value * sign as f64 + 0.0;
        let (real, quantised) = (signed(constant.exact), signed(constant.value()));
        let error = quantised - real + 0.0;
        Self {
            meaning: Coefficients::<Constant>::described(&name).unwrap_or_default(),
            raw,
            bits: Format::covering(raw.into(), raw.into(), constant.fraction).width,
            fraction_bits: constant.fraction,
            real,
            quantised,
            error,
            relative_error: if real == 0.0 { 0.0 } else { error / real + 0.0 },
            note: if sign > 0 {
                note(&name, constant)
            } else {
                None
            },
            name,
        }
    }

    /// The negative of the one before it in the list.
    #[must_use]
    pub fn is_negative_of_another(&self) -> bool {
        self.name.starts_with("minus_")
    }
}

/// Those that the chip has, each followed by its negative where the chip has that too. A coefficient of which it has the
/// negative alone is there as well: its name is the one that is known.
#[must_use]
pub fn coefficients(design: &Design) -> Vec<Coefficient> {
    let graph = &design.graph;
    let read = |name: &str| {
        graph.ids().any(|id| {
            let node = graph.node(id);
            node.name.as_deref() == Some(name)
                && matches!(node.op, Op::Constant(_))
                && node.kind == Kind::Value
                && graph.is_read(id)
        })
    };
    let mut list = vec![];
    design.constants.map(|name, constant| {
        let negative = format!("minus_{name}");
        let has_negative = read(&negative);
        if has_negative || read(name) {
            list.push(Coefficient::of(name.into(), &constant, 1));
        }
        if has_negative {
            list.push(Coefficient::of(negative, &constant, -1));
        }
    });
    list
}
