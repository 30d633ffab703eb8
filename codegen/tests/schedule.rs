//! A schedule computes what the graph computes, whatever the number of multipliers.

#[path = "../../designs/shipped.rs"]
mod shipped;

use nonius_codegen::evaluate::evaluate;
use nonius_codegen::schedule::schedule;
use nonius_model::design::Design;
use nonius_model::graph::{Evaluation, Graph};
use nonius_model::spec::Overrides;
use rand::{Rng, SeedableRng, rngs::StdRng};
use shipped::variants::{kinds, with_every_word};
use shipped::words::{key, say};

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

/// Whatever word is said, the shortest and the longest of each: the schedule computes the graph, and the Verilog is written.
#[test]
fn chips_of_other_words_are_scheduled_and_written() {
    let mut random = StdRng::seed_from_u64(8);
    let mut done = std::collections::BTreeSet::new();
    for chip in with_every_word() {
        for word in chip.design().word_lengths() {
            let key = key(&word);
            // Each word in one chip that has it.
            if !done.insert(key.to_owned()) {
                continue;
            }
            let mut built = 0;
            for value in [word.lowest, word.highest] {
                let mut spec = chip.spec.clone();
                say(&mut spec, key, value);
                let Ok(design) = Design::new(&spec) else {
                    continue;
                };
                built += 1;
                let what = format!("{}, {key} = {value}", chip.what);
                scheduled_equals_recorded(&what, &design.graph, &mut random);
                nonius_codegen::generate(&design, "0", &[]).expect("Verilog");
            }
            assert!(built > 0, "{}: {key}", chip.what);
        }
    }
    assert_eq!(done.len(), Overrides::KEYS.len());
}

#[test]
fn one_multiplier_takes_at_most_twenty_clocks() {
    for name in shipped::NAMES {
        let clocks = schedule(&shipped::design(name).graph, 1).clocks;
        println!("{name}: {clocks} clocks");
        assert!(clocks <= 20, "{name}: {clocks} clocks");
    }
}
