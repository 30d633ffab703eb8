//! The kept table of docs/convergence is what the study says today.
#![cfg_attr(test, allow(clippy::unwrap_used))]

#[path = "../examples/study_convergence/method.rs"]
#[allow(dead_code, reason = "the plots need more of it")]
mod method;
#[path = "../examples/study_convergence/scenario.rs"]
#[allow(dead_code, reason = "the plots need more of it")]
mod scenario;
mod support;
#[path = "../examples/study_convergence/table.rs"]
mod table;

use nonius_model::design::Design;
use scenario::Scenario;

const COMMAND: &str = "cargo run --release -p nonius-model --example study_convergence -- designs/optical.toml docs/convergence";

/// (method and scenario, the numbers) of each row.
fn rows(csv: &str) -> Vec<(String, Vec<f64>)> {
    let row = |line: &str| {
        let (method, rest) = line.rsplit_once("\",").unwrap();
        let mut cells = rest.split(',');
        let name = format!(
            "{}, {}",
            method.trim_start_matches('"'),
            cells.next().unwrap()
        );
        // Not the parameter error, which may be empty, and not the periods, which hang on single samples.
        let numbers: Vec<f64> = cells.skip(1).take(3).map(|c| c.parse().unwrap()).collect();
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
    let kept = rows(&std::fs::read_to_string(kept).unwrap());
    let scenarios = [Scenario::Quiet, Scenario::Drift, Scenario::ThirdHarmonic];
    let design = Design::new(&support::optical()).unwrap();
    let found = rows(&table::methods(&design, &scenarios));
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
