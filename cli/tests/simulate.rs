//! `nonius simulate` through the binary: what it writes and what it refuses.

use std::fs;

use crate::support::{design, nonius, recording, refused};

/// A line of the shipped design.
const LENGTH: &str = "scale_period_m = 20e-6";

/// A row of a table.
fn numbers(row: &str) -> Vec<f64> {
    let cells = row.split(',');
    cells.map(|cell| cell.parse().expect("a number")).collect()
}

/// The last row of a table.
fn last_row(csv: &str) -> Vec<f64> {
    numbers(csv.lines().last().expect("rows"))
}

#[test]
fn simulate_writes_its_files() {
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), recording(4096, 64.0)).expect("recording");
    let design = design();
    for extra in [&[][..], &["--reference"][..]] {
        let mut arguments = vec![
            "simulate", &design, "r.csv", "-o", "out.csv", "--repeat", "3",
        ];
        arguments.extend(extra);
        let output = nonius(dir.path(), &arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        let csv = fs::read_to_string(dir.path().join("out.csv")).expect("out.csv");
        let rows: Vec<Vec<f64>> = csv.lines().skip(1).map(numbers).collect();
        assert_eq!(
            csv.lines().next(),
            Some(
                "time_s,position_periods,speed_periods_per_s,locked,theta_1,theta_2,theta_3,theta_4,theta_5"
            )
        );
        assert_eq!(rows.len(), 3 * 4096);
        // Time goes on from turn to turn.
        assert!((rows[4096][0] - 4096e-6).abs() < 1e-9);
        let last = rows.last().expect("rows");
        assert_eq!(last[3], 1.0, "locked");
        let travelled = last[1] - rows[4096][1];
        assert!(
            (travelled - 2.0 * 64.0 + 1.0 / 64.0).abs() < 2e-3,
            "{travelled}"
        );
        assert!((last[2] - 15625.0).abs() < 30.0, "{}", last[2]);
        // The paper's parameters of this encoder, in 1/V.
        let beta: f64 = 0.03;
        let theta = [
            1.0 / 0.75,
            -0.04 / 0.75,
            1.0 / (0.85 * beta.cos()),
            0.03 / (0.85 * beta.cos()) - 0.04 * beta.tan() / 0.75,
            beta.tan() / 0.75,
        ];
        for (i, expected) in theta.iter().enumerate() {
            let found = last[4 + i];
            assert!(
                (found - expected).abs() < 2e-3,
                "theta_{}: {found} {expected}",
                i + 1
            );
        }
    }
}

#[test]
fn positions_have_the_units_that_the_design_knows() {
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), recording(1000, 64.0)).expect("recording");
    let text = fs::read_to_string(design()).expect("a design");
    let (of_length, without) = (
        text.replace(
            LENGTH,
            "scale_period_m = 20e-6\nperiods_per_revolution = 2500 #",
        ),
        text.replace(LENGTH, "#"),
    );
    fs::write(dir.path().join("both.toml"), of_length).expect("a design");
    fs::write(dir.path().join("neither.toml"), without).expect("a design");
    let arguments = [
        "simulate",
        "both.toml",
        "r.csv",
        "-o",
        "out.csv",
        "--physical",
    ];
    assert!(nonius(dir.path(), &arguments).status.success());
    let csv = fs::read_to_string(dir.path().join("out.csv")).expect("out.csv");
    let header = csv.lines().next().expect("a header");
    assert!(
        header.ends_with("theta_5,position_m,position_rad"),
        "{header}"
    );
    let last = last_row(&csv);
    assert_eq!(last[9], last[1] * 20e-6);
    assert_eq!(last[10], last[1] * (std::f64::consts::TAU / 2500.0));
    let arguments = [
        "simulate",
        "neither.toml",
        "r.csv",
        "-o",
        "out.csv",
        "--physical",
    ];
    refused(
        &nonius(dir.path(), &arguments),
        &[
            "neither.toml:5:2: --physical",
            "scale_period_m",
            "write one of them here",
        ],
    );
}

#[test]
fn simulate_refuses_what_cannot_be() {
    let dir = tempfile::tempdir().expect("scratch");
    let design = design();
    fs::write(dir.path().join("r.csv"), recording(1000, 64.0)).expect("recording");
    fs::write(dir.path().join("bad.csv"), "time_s,cos,sin\n0,1,x\n").expect("recording");
    let run = |rest: &[&str]| {
        let mut arguments = vec!["simulate", &design];
        arguments.extend(rest);
        nonius(dir.path(), &arguments)
    };
    refused(
        &run(&["r.csv", "-o", "o.csv", "--repeat", "2"]),
        &["whole turns", "r.csv"],
    );
    refused(&run(&["none.csv", "-o", "o.csv"]), &["none.csv"]);
    refused(&run(&["bad.csv", "-o", "o.csv"]), &["bad.csv:2"]);
    refused(
        &run(&["r.csv", "-o", "r.csv/o.csv"]),
        &["cannot write into r.csv"],
    );
    refused(
        &run(&["r.csv", "-o", "o.csv", "--repeat", "0"]),
        &["--repeat"],
    );
    refused(
        &nonius(
            dir.path(),
            &["simulate", "none.toml", "r.csv", "-o", "o.csv"],
        ),
        &["none.toml"],
    );
    assert!(!dir.path().join("o.csv").exists());
}

/// Within three periods of lock the start by least squares has found Θ, in the chip and in the paper; the gears have not.
#[test]
fn the_start_by_least_squares_is_that_of_chip_and_paper() {
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), recording(300, 64.37)).expect("recording");
    let text = fs::read_to_string(design()).expect("a design");
    let started = text.replace(
        "parameters = 5",
        "parameters = 5\nstart = \"least_squares\"",
    );
    fs::write(dir.path().join("gears.toml"), text).expect("a design");
    fs::write(dir.path().join("started.toml"), started).expect("a design");
    // θ1 = 1/a_c, θ2 = -b_c/a_c, θ3 = 1/(a_s cos β), θ5 = tan β/a_c.
    let truth = [
        1.0 / 0.75,
        -0.04 / 0.75,
        1.0 / (0.85 * 0.03f64.cos()),
        f64::NAN,
        0.03f64.tan() / 0.75,
    ];
    let off = |design: &str, flags: &[&str]| {
        let common = ["simulate", design, "r.csv", "-o", "o.csv"];
        assert!(
            nonius(dir.path(), &[&common, flags].concat())
                .status
                .success()
        );
        let csv = fs::read_to_string(dir.path().join("o.csv")).expect("o.csv");
        let row = last_row(&csv);
        let misses = row[4..9]
            .iter()
            .zip(truth)
            .map(|(is, should)| (is - should).abs());
        misses.fold(0.0, f64::max)
    };
    let [chip, paper] = [&[][..], &["--reference"]].map(|flags| off("started.toml", flags));
    let [slow, slow_paper] = [&[][..], &["--reference"]].map(|flags| off("gears.toml", flags));
    println!("least squares {chip:.4}, {paper:.4}; gears {slow:.4}, {slow_paper:.4}");
    assert!(chip < 0.001 && paper < 0.001, "{chip} {paper}");
    assert!(
        slow > 5.0 * chip && slow_paper > 5.0 * paper,
        "{slow} {slow_paper}"
    );
}
