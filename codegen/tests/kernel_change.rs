//! The Verilog is the kernels': a formula that changes there changes the chip, with no other edit.

mod altered;

use std::collections::HashMap;

use crate::shipped;
use nonius_codegen::evaluate::evaluate;
use nonius_codegen::generate;
use nonius_codegen::schedule::schedule;
use nonius_model::chip::record;
use nonius_model::design::Design;
use nonius_model::graph::Evaluation;
use rand::{Rng, SeedableRng, rngs::StdRng};

fn verilog(design: &Design) -> String {
    let files = generate(design, "test", &[]).expect("templates render");
    let rtl = files.files.into_iter().find(|f| f.0 == "rtl/optical.v");
    rtl.expect("the chip").1
}

/// The lines of the Verilog that a formula became, from its title to the empty line.
fn section(design: &Design, formula: &str) -> String {
    let rtl = verilog(design);
    let from = rtl.find(&format!("    // {formula}\n"));
    let from = &rtl[from.unwrap_or_else(|| panic!("{formula} is not in the Verilog"))..];
    from[..from.find("\n\n").expect("its end")].to_owned()
}

/// The shipped design, but with `formula` changed in the kernel: what is a difference there is a sum.
fn changed(design: &Design, formula: &'static str) -> Design {
    altered::change(formula);
    let graph = record(&design.structure, &design.constants, altered::kernel);
    Design {
        graph: graph.expect("formats hold it"),
        ..design.clone()
    }
}

/// What the Verilog's schedule of `other` computes is its graph, and not that of `sound`.
fn computes_what_it_says(other: &Design, sound: &Design) {
    let schedule = schedule(&other.graph, 1);
    let mut random = StdRng::seed_from_u64(3);
    let mut differs = false;
    for _ in 0..50 {
        let inputs: HashMap<String, i128> = other
            .graph
            .inputs
            .iter()
            .map(|(name, id)| {
                let (low, high) = other.graph.node(*id).range;
                (name.clone(), random.random_range(low..=high))
            })
            .collect();
        let plain = Evaluation::new(&other.graph, |name| inputs[name]);
        let before = Evaluation::new(&sound.graph, |name| inputs[name]);
        let timed = evaluate(&other.graph, &schedule, |name| inputs[name]);
        for (name, id) in &other.graph.next {
            assert_eq!(timed[id.index()], Some(plain.raw(*id)), "{name}");
            let was = sound.graph.next.iter().find(|n| n.0 == *name);
            let (_, was) = was.expect("the same registers");
            differs |= plain.raw(*id) != before.raw(*was);
        }
    }
    assert!(differs);
}

#[test]
fn a_changed_formula_changes_the_verilog() {
    let design = shipped::design("optical");
    let formulas = ["Phase detector", "Radial residual", "Travel"];
    for formula in formulas {
        let other = changed(&design, formula);
        for title in formulas {
            let (before, after) = (section(&design, title), section(&other, title));
            assert_eq!(before == after, title != formula, "{title}: {after}");
        }
        computes_what_it_says(&other, &design);
    }
    // The phase detector, word for word.
    let before = section(&design, "Phase detector");
    let (ahead, exact) = before
        .split_once(" e_exact = ")
        .expect("the exact phase error");
    let plus = format!("{ahead} e_exact = {}", exact.replacen(" - ", " + ", 1));
    let after = section(&changed(&design, "Phase detector"), "Phase detector");
    assert_eq!(after, plus);
}

#[test]
fn a_formula_that_is_only_read_otherwise_does_not() {
    let design = shipped::design("optical");
    let same = changed(&design, "no such formula");
    assert!(verilog(&design) == verilog(&same));
}
