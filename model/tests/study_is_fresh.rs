//! The kept table of docs/convergence is what the study says today.

#[path = "../examples/study_convergence/costs.rs"]
#[allow(dead_code, reason = "clocks and LUTs are measured elsewhere")]
mod costs;
#[path = "../examples/study_convergence/method.rs"]
#[allow(dead_code, reason = "the plots need more of it")]
mod method;
#[path = "../examples/study_convergence/on_chip.rs"]
mod on_chip;
#[path = "../examples/study_convergence/scenario.rs"]
#[allow(dead_code, reason = "the plots need more of it")]
mod scenario;
mod support;
#[path = "../examples/study_convergence/table.rs"]
mod table;

use support::shipped;

use nonius_model::design::Design;
use scenario::Scenario;

const COMMAND: &str = "cargo run --release -p nonius-model --example study_convergence -- designs/optical.toml docs/convergence docs/on-line-costs.csv";

/// (method and scenario, the numbers) of each row.
fn rows(csv: &str) -> Vec<(String, Vec<f64>)> {
    let row = |line: &str| {
        let (method, rest) = line.rsplit_once("\",").expect("a name in quotes");
        let mut cells = rest.split(',');
        let name = format!(
            "{}, {}",
            method.trim_start_matches('"'),
            cells.next().expect("a scenario")
        );
        // Not the parameter error, which may be empty, and not the periods, which hang on single samples.
        let numbers: Vec<f64> = cells
            .skip(1)
            .take(3)
            .map(|c| c.parse().expect("a number"))
            .collect();
        (name, numbers)
    };
    csv.lines().skip(1).map(row).collect()
}

/// To a tenth: other machines have other last digits of the sine, and noise takes it from there.
#[test]
fn the_kept_table_is_fresh() {
    let kept = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../docs/convergence/methods.csv"
    );
    let kept = rows(&std::fs::read_to_string(kept).expect("the kept table"));
    let scenarios = [Scenario::Quiet, Scenario::Drift, Scenario::ThirdHarmonic];
    let design = Design::new(&support::optical()).expect("a shipped design");
    let found = rows(&table::methods(
        &design,
        &scenarios,
        &costs::Costs::default(),
    ));
    assert!(found.len() > 60);
    for (name, numbers) in found {
        let (_, expected) = kept
            .iter()
            .find(|(kept, _)| *kept == name)
            .unwrap_or_else(|| panic!("{name} is not kept: {COMMAND}"));
        for (found, expected) in numbers.iter().zip(expected) {
            let near = (found - expected).abs() <= 0.1 * expected.abs() + 1e-3;
            assert!(
                near,
                "{name}: {found}, kept {expected}. If that is right: {COMMAND}"
            );
        }
    }
}
