//! A schedule computes what the graph computes, whatever the number of multipliers.

use nonius_codegen::evaluate::evaluate;
use nonius_codegen::schedule::schedule;
use nonius_model::design::Design;
use nonius_model::graph::Evaluation;
use nonius_model::spec::Spec;
use rand::{Rng, SeedableRng, rngs::StdRng};

fn optical() -> Design {
    let text = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../designs/optical.toml"
    ));
    let spec = Spec::from_toml(&text.expect("designs/optical.toml"), "optical.toml");
    Design::new(&spec.expect("a shipped design")).expect("a shipped design")
}

#[test]
fn scheduled_graph_equals_recorded_graph() {
    let design = optical();
    let graph = &design.graph;
    let mut random = StdRng::seed_from_u64(7);
    for multipliers in [1, 2, 3, 5, graph.products()] {
        let schedule = schedule(graph, multipliers);
        for _ in 0..200 {
            let mut inputs = std::collections::HashMap::new();
            for (name, id) in &graph.inputs {
                let (low, high) = graph.node(*id).range;
                inputs.insert(name.clone(), random.random_range(low..=high));
            }
            let plain = Evaluation::new(graph, |name| inputs[name]);
            let timed = evaluate(graph, &schedule, |name| inputs[name]);
            for (name, id) in graph.next.iter().chain(&graph.probes) {
                assert_eq!(
                    timed[id.index()],
                    Some(plain.raw(*id)),
                    "{name} on {multipliers} multipliers"
                );
            }
        }
    }
}

#[test]
fn one_multiplier_takes_at_most_twenty_clocks() {
    let design = optical();
    let clocks = schedule(&design.graph, 1).clocks;
    assert!(clocks <= 20, "{clocks} clocks");
}
