//! What `nonius diagnose` makes of the RM44 recordings, which have a reference.
//!
//! The table is kept in docs/diagnosed-recordings.md; NONIUS_BLESS=1 writes it anew.

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

const KEPT: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../docs/diagnosed-recordings.md"
);

#[test]
fn the_line_and_the_harmonics_of_the_rm44_are_named() {
    let dir = tempfile::tempdir().expect("scratch folder");
    let mut table = String::from(
        "# Measured recordings, diagnosed\n\n\
         Written by `NONIUS_BLESS=1 cargo test -p nonius --test diagnosed_recordings`; do not edit.\n\n\
         RM44 magnetic encoder, one turn each, against an optical reference: `nonius diagnose RECORDING.csv -o DIR\n\
         --periods-per-revolution 1`. One turn is one scale period, so orders of the period and of the revolution are one and\n\
         the same here, and time and angle as well: drift cannot be told.\n\n",
    );
    for name in ["rm44_center", "rm44_static_x500um", "rm44_gap_z500um"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../shared/data")
            .join(format!("{name}.csv"));
        if !path.is_file() {
            println!("NOT RUN: diagnosed_recordings: ../shared/data/{name}.csv is not there");
            return;
        }
        let output = Command::new(env!("CARGO_BIN_EXE_nonius"))
            .current_dir(dir.path())
            .arg("diagnose")
            .arg(&path)
            .args(["-o", name, "--periods-per-revolution", "1", "--json"])
            .output()
            .expect("nonius runs");
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let degrees = |part: &str| {
            let value = json[part]["position_error_rms_rad"].as_f64();
            value.expect("a reference").to_degrees()
        };
        let (before, after) = (degrees("simulation"), degrees("extended"));
        let findings = json["findings"].as_array().expect("findings");
        writeln!(
            table,
            "## {name}\n\nAngle error {before:.3}° rms with five parameters, {after:.3}° with what was found.\n"
        )
        .expect("text");
        for finding in findings {
            let sentence = finding["evidence"].as_str().expect("a sentence");
            let sentence = sentence.split("; it raises").next().unwrap_or(sentence);
            let cause = finding["cause"].as_str().expect("a name");
            writeln!(table, "- `{cause}`: {sentence}").expect("text");
        }
        let left = json["unexplained"]["signature"]
            .as_str()
            .expect("a sentence");
        writeln!(table, "\nLeft: {left}.\n").expect("text");
        let hum = findings.iter().any(|f| {
            let frequency = f["parameters"][0]["value"].as_f64().unwrap_or(0.0);
            f["cause"] == "interference" && (frequency - 256.0).abs() < 3.0
        });
        assert!(hum, "{name}: the line near 256 Hz");
        assert!(after < 0.5 * before, "{name}: {before} {after}");
    }
    if std::env::var_os("NONIUS_BLESS").is_some() {
        std::fs::write(KEPT, &table).expect("docs");
    }
    let kept = std::fs::read_to_string(KEPT).unwrap_or_default();
    if let Some((was, is)) = first_difference(&kept, &table) {
        panic!(
            "{was:?} is {is:?} now; stale: NONIUS_BLESS=1 cargo test -p nonius --test diagnosed_recordings"
        );
    }
}

/// The first words that differ; numbers may differ by what another machine's sine does to an estimate.
fn first_difference(kept: &str, table: &str) -> Option<(String, String)> {
    let (mut a, mut b) = (kept.split_whitespace(), table.split_whitespace());
    loop {
        let (was, is) = (a.next(), b.next());
        let number = |word: Option<&str>| -> Option<f64> {
            word?.trim_end_matches(['°', ',', '.', '%']).parse().ok()
        };
        let near = match (number(was), number(is)) {
            (Some(x), Some(y)) => (x - y).abs() <= 0.01 * x.abs().max(0.01),
            _ => was == is,
        };
        if !near {
            return Some((was.unwrap_or("").into(), is.unwrap_or("").into()));
        }
        was?;
    }
}
