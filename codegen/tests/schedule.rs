//! A schedule computes what the graph computes, whatever the number of multipliers.

#[path = "../../designs/shipped.rs"]
mod shipped;

use nonius_codegen::evaluate::evaluate;
use nonius_codegen::schedule::schedule;
use nonius_model::graph::{Evaluation, Graph};
use rand::{Rng, SeedableRng, rngs::StdRng};
use shipped::variants::kinds;

#[test]
fn scheduled_graph_equals_recorded_graph() {
    let mut random = StdRng::seed_from_u64(7);
    for kind in kinds() {
        scheduled_equals_recorded(&kind.what, &kind.design().graph, &mut random);
    }
}

fn scheduled_equals_recorded(kind: &str, graph: &Graph, random: &mut StdRng) {
    for multipliers in [1, 2, 3, 5, graph.products()] {
        let schedule = schedule(graph, multipliers);
        for _ in 0..60 {
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
                    "{kind}: {name} on {multipliers} multipliers"
                );
            }
        }
    }
}

#[test]
fn one_multiplier_takes_at_most_twenty_clocks() {
    for name in shipped::NAMES {
        let clocks = schedule(&shipped::design(name).graph, 1).clocks;
        println!("{name}: {clocks} clocks");
        assert!(clocks <= 20, "{name}: {clocks} clocks");
    }
}
