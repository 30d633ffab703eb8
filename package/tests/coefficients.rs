//! `design.json` has every coefficient of the chip, with what it was before rounding.

use crate::shipped;
use nonius_model::graph::{Kind, Op};
use nonius_package::coefficients;

#[test]
fn every_named_constant_of_every_chip_is_there() {
    for variant in shipped::variants::everything() {
        let design = variant.design();
        let (graph, list) = (&design.graph, coefficients(&design));
        for id in graph.ids().filter(|id| graph.is_read(*id)) {
            let node = graph.node(id);
            let (Op::Constant(raw), Kind::Value, Some(name)) = (node.op, node.kind, &node.name)
            else {
                continue;
            };
            let of = |name: &str| list.iter().find(|c| c.name == name);
            let found = of(name).unwrap_or_else(|| panic!("{}: no {name}", variant.what));
            assert_eq!(
                (found.raw, found.bits, found.fraction_bits),
                (raw, node.format.width, node.format.fraction),
                "{}: {name}",
                variant.what
            );
            assert!(!found.meaning.is_empty(), "{}: {name}", variant.what);
            // Whoever looks for a limit finds it by its name.
            if let Some(positive) = name.strip_prefix("minus_") {
                assert!(of(positive).is_some(), "{}: no {positive}", variant.what);
            }
        }
    }
}

#[test]
fn errors_are_those_of_rounding() {
    for variant in shipped::variants::everything() {
        let design = variant.design();
        for c in coefficients(&design) {
            let what = format!("{}: {c:?}", variant.what);
            let half = 0.5f64.powi(c.fraction_bits as i32 + 1);
            assert_eq!(c.error, c.quantised - c.real, "{what}");
            assert!(c.error.abs() <= half, "{what}");
            // What is shifted on purpose is no error.
            if ["quarter_turn", "half_bit", "unit_radius"].contains(&c.name.as_str()) {
                assert_eq!(c.error, 0.0, "{what}");
                let note = c.note.as_deref().unwrap_or_default();
                assert!(note.contains("on purpose"), "{what}");
            }
        }
    }
}

#[test]
fn real_is_what_was_derived() {
    let design = shipped::design("optical");
    let list = coefficients(&design);
    let real = |name: &str| {
        let found = list.iter().find(|c| c.name == name);
        found.unwrap_or_else(|| panic!("no {name}")).real
    };
    assert_eq!(real("loop_a"), design.tracking.a);
    assert_eq!(real("loop_ab"), design.tracking.ab);
    let spec = &design.spec;
    assert_eq!(real("restart_residual"), spec.calibration.restart_residual);
    assert_eq!(real("hold_residual"), spec.hold_residual());
    // The limits have few bits: what rounds them shows.
    let rounded = list.iter().filter(|c| c.error != 0.0).count();
    assert!(rounded >= 4, "{rounded}");
}
