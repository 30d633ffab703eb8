//! The Verilog is the kernels': a formula that changes there changes the chip, with no other edit.

#[path = "../../designs/shipped.rs"]
mod shipped;

use nonius_codegen::evaluate::evaluate;
use nonius_codegen::generate;
use nonius_codegen::schedule::schedule;
use nonius_model::chip::record;
use nonius_model::design::Design;
use nonius_model::graph::{Evaluation, Node};
use nonius_model::kernel::{Coefficients, Input, Probes, State, Structure, sample};
use nonius_model::signal::{Signal, Wide};
use rand::{Rng, SeedableRng, rngs::StdRng};

/// The chip, but with a phase error that leaves a quarter of the radial residual in.
fn altered<'g>(
    input: &Input<Node<'g>>,
    state: &State<Node<'g>>,
    k: &Coefficients<Node<'g>>,
    structure: &Structure,
) -> (State<Node<'g>>, Probes<Node<'g>>) {
    let (mut next, probes) = sample(input, state, k, structure);
    next.error_previous = (next.error_previous
        + (probes.rho * k.quarter).quantise(&structure.formats.signal))
    .quantise(&structure.formats.signal);
    (next, probes)
}

fn chip(design: &Design) -> String {
    let files = generate(design, "test", &[]).expect("templates render");
    let rtl = files.files.iter().find(|f| f.0 == "rtl/optical.v");
    rtl.expect("the chip").1.clone()
}

#[test]
fn a_changed_formula_changes_the_verilog() {
    let design = shipped::design("optical");
    let mut other = design.clone();
    other.graph = record(&design.structure, &design.constants, altered).expect("formats hold it");
    let (before, after) = (chip(&design), chip(&other));
    assert!(before.contains("16 products") && after.contains("17 products"));
    let assigned = |verilog: &str| {
        let line = verilog
            .lines()
            .find(|l| l.contains(" error_previous <= ") && !l.contains("<= 0;"));
        line.expect("the register is committed").trim().to_owned()
    };
    assert_eq!(assigned(&before), "error_previous <= e;");
    assert_ne!(assigned(&after), "error_previous <= e;");
    assert!(after.contains("rho_times_quarter"), "{after}");

    // And what the Verilog's schedule computes is the altered formula.
    let schedule = schedule(&other.graph, 1);
    let mut random = StdRng::seed_from_u64(3);
    let mut differs = false;
    for _ in 0..50 {
        let inputs: std::collections::HashMap<String, i128> = other
            .graph
            .inputs
            .iter()
            .map(|(name, id)| {
                let (low, high) = other.graph.node(*id).range;
                (name.clone(), random.random_range(low..=high))
            })
            .collect();
        let plain = Evaluation::new(&other.graph, |name| inputs[name]);
        let sound = Evaluation::new(&design.graph, |name| inputs[name]);
        let timed = evaluate(&other.graph, &schedule, |name| inputs[name]);
        for (name, id) in &other.graph.next {
            assert_eq!(timed[id.index()], Some(plain.raw(*id)), "{name}");
            let (_, was) = design
                .graph
                .next
                .iter()
                .find(|n| n.0 == *name)
                .expect("the same registers");
            differs |= plain.raw(*id) != sound.raw(*was);
        }
    }
    assert!(differs);
}
