//! A schedule computes what the graph computes, whatever the number of multipliers.

use crate::shipped;
use crate::shipped::variants::{costed, kinds, with_every_word};
use crate::shipped::words::{key, say};
use nonius_codegen::evaluate::evaluate;
use nonius_codegen::schedule::{Schedule, schedule, schedule_for};
use nonius_model::design::Design;
use nonius_model::graph::{Evaluation, Graph};
use nonius_model::spec::Overrides;
use rand::{Rng, SeedableRng, rngs::StdRng};

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
        let idle = idle(&schedule);
        assert!(
            idle.is_empty(),
            "{kind} on {multipliers} multipliers: {idle:?}"
        );
        for _ in 0..24 {
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

/// Multipliers that never have a product.
fn idle(schedule: &Schedule) -> Vec<usize> {
    let busy = |m: usize| schedule.issue.iter().flatten().any(|issue| issue.0 == m);
    (0..schedule.multipliers).filter(|&m| !busy(m)).collect()
}

/// More multipliers never take more clocks, and "all" takes the fewest multipliers that take the fewest clocks.
#[test]
fn all_multipliers_are_those_that_are_of_use() {
    for kind in kinds() {
        let design = kind.design();
        let graph = &design.graph;
        let all = schedule_for(graph, shipped::variants::ALL);
        let few = 1..=graph.products().min(6);
        let clocks: Vec<usize> = few
            .chain([graph.products()])
            .map(|m| schedule(graph, m).clocks)
            .collect();
        println!(
            "{}: {} products, {} multipliers and {} clocks for all of {clocks:?}",
            kind.what,
            graph.products(),
            all.multipliers,
            all.clocks
        );
        assert!(clocks.is_sorted_by(|a, b| a >= b), "{}", kind.what);
        assert_eq!(Some(&all.clocks), clocks.last(), "{}", kind.what);
        if let Some(fewer) = all.multipliers.checked_sub(2) {
            assert!(clocks[fewer] > all.clocks, "{}", kind.what);
        }
        assert!(idle(&all).is_empty(), "{}", kind.what);
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

/// The clocks and products of the page of costs are those of today's schedule; its cells take minutes of Yosys, and are measured by the
/// command that the page names.
#[test]
fn the_page_of_costs_has_the_clocks_of_now() {
    let page = std::fs::read_to_string("../docs/on-line-costs.md").expect("the page");
    let mut rows = 0;
    for chip in costed() {
        let graph = &chip.design().graph;
        let begins = format!(
            "| {} | {} | {} | ",
            chip.what,
            chip.spec.calibration.parameters,
            graph.products()
        );
        let row = page.lines().find_map(|line| line.strip_prefix(&begins));
        let row = row.unwrap_or_else(|| panic!("no row {begins}"));
        let clocks = row.split(" | ").nth(1).and_then(|cell| cell.parse().ok());
        assert_eq!(clocks, Some(schedule(graph, 1).clocks), "{begins}");
        rows += 1;
    }
    assert_eq!(
        rows,
        page.lines().filter(|l| l.starts_with("| ")).count() - 1
    );
}

#[test]
fn one_multiplier_takes_at_most_twenty_clocks() {
    for name in shipped::NAMES {
        let clocks = schedule(&shipped::design(name).graph, 1).clocks;
        println!("{name}: {clocks} clocks");
        assert!(clocks <= 20, "{name}: {clocks} clocks");
    }
}
