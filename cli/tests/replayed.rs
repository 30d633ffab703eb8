//! What a diagnosis writes, moved as the recording was: laid over the recording, and diagnosed again.

use std::fs;
use std::path::Path;

use crate::support::{design, done, nonius, refused};

/// Of each channel, in the unit of the columns.
const NOISE: f64 = 0.0008;

const SENSOR: &str = "\
[signals]
a_c = 0.8
b_c = 0.03
a_s = 0.75
b_s = -0.02
beta = 0.04
noise_rms = 0.001
[adc]
bits = 14
lsb = 0.0001220703125
centre = 0.0
sample_rate_hz = 20000.0
[motion]
file = \"moved.csv\"
periods_travelled = 400.0
speed_max_periods_per_s = 600.0
[[cause]]
name = \"spatial_harmonic\"
order = 3
amplitude_cos = 0.02
phase_cos = 0.7
amplitude_sin = 0.015
phase_sin = -2.0
[[cause]]
name = \"hysteresis\"
offset_cos = 0.008
offset_sin = -0.006
";

/// It stands, goes, slows down, goes back, stands.
const MOVED: &str = "\
time_s,position_periods,speed_periods_per_s
2.5,0,0
2.55,0,0
2.7,45,600
2.75,70,300
2.85,70,-300
2.95,45,0
3,45,0
";

/// Rows of a recording: time, cos, sin.
fn rows(path: &Path) -> Vec<[f64; 3]> {
    let text = fs::read_to_string(path).expect("a recording");
    let rows = text.lines().skip_while(|l| l.starts_with('#')).skip(1);
    let number = |cell: &str| cell.parse::<f64>().expect("a number");
    rows.map(|row| {
        let cells: Vec<f64> = row.split(',').map(number).collect();
        cells.try_into().expect("three cells")
    })
    .collect()
}

/// Names of the causes that a diagnosis found, sorted.
fn causes(dir: &Path, found: &str) -> Vec<String> {
    let text = fs::read_to_string(dir.join(found).join("findings.json")).expect("findings");
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let list = json["findings"].as_array().expect("findings");
    let names = list
        .iter()
        .map(|f| f["cause"].as_str().expect("a name").to_owned());
    let mut names: Vec<String> = names.collect();
    names.sort_unstable();
    names
}

/// Largest rms of a channel's difference.
fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let of = |column: usize| {
        let pairs = a.iter().zip(b);
        let power: f64 = pairs.map(|(a, b)| (a[column] - b[column]).powi(2)).sum();
        (power / a.len().min(b.len()) as f64).sqrt()
    };
    of(1).max(of(2))
}

#[test]
fn the_extended_simulation_lies_over_the_recording() {
    let dir = tempfile::tempdir().expect("scratch");
    let (dir, design) = (dir.path(), design());
    let write = |name: &str, text: &str| fs::write(dir.join(name), text).expect("a file");
    let simulate = |sensor: &str, samples: &str| {
        let to = ["-o", "out.csv", "--samples", samples];
        done(
            dir,
            &[&["simulate", &design, "--sensor", sensor][..], &to].concat(),
        )
    };
    write("sensor.toml", SENSOR);
    write("moved.csv", MOVED);
    simulate("sensor.toml", "r.csv");
    let measured = rows(&dir.join("r.csv"));
    assert_eq!((measured.len(), measured[0][0]), (10_001, 2.5));
    let known = causes_of(dir, "r.csv", "found");
    assert_eq!(known, ["hysteresis", "spatial_harmonic"]);
    simulate("found/sensor.toml", "again.csv");
    let again = rows(&dir.join("again.csv"));
    let same_time = measured.iter().zip(&again).all(|(m, a)| m[0] == a[0]);
    assert!(again.len() == measured.len() && same_time);
    // Both have the same noise, so that hardly any of it is left in the difference.
    let off = apart(&measured, &again);
    assert!(off < 0.5 * NOISE, "{off}");
    assert_eq!(causes_of(dir, "again.csv", "found_again"), known);
    let text = fs::read_to_string(dir.join("found/sensor.toml")).expect("a sensor");
    let without = text.lines().filter(|l| !l.starts_with("file = "));
    let without = without.collect::<Vec<_>>().join("\n");
    write("found/to_and_fro.toml", &without);
    simulate("found/to_and_fro.toml", "other.csv");
    let off = apart(&measured, &rows(&dir.join("other.csv")));
    assert!(off > 300.0 * NOISE, "{off}");
}

/// What a diagnosis of a recording finds.
fn causes_of(dir: &Path, recording: &str, found: &str) -> Vec<String> {
    done(dir, &["diagnose", recording, "-o", found]);
    causes(dir, found)
}

#[test]
fn a_motion_that_cannot_be_followed_is_refused() {
    let dir = tempfile::tempdir().expect("scratch");
    let (dir, design) = (dir.path(), design());
    let folder = dir.join("found");
    fs::create_dir(&folder).expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).expect("a file");
    let to = |output: &str, samples: &str| {
        let sensor = "found/sensor.toml";
        let call = [
            "simulate",
            &design,
            "--sensor",
            sensor,
            "-o",
            output,
            "--samples",
            samples,
        ];
        nonius(dir, &call)
    };
    write("sensor.toml", SENSOR);
    let way_out = [
        "found/sensor.toml: motion.file",
        "to and fro",
        "found/moved.csv",
    ];
    refused(&to("out.csv", "s.csv"), &way_out);
    write("moved.csv", &MOVED.replace("2.85", "2.65"));
    refused(&to("out.csv", "s.csv"), &way_out);
    refused(
        &to("out.csv", "s.csv"),
        &["found/moved.csv:6:", "from 2.75 to 2.65"],
    );
    write("moved.csv", MOVED);
    refused(
        &to("out.csv", "found/moved.csv"),
        &["found/moved.csv", "name another file"],
    );
    refused(&to("out.csv", "found/sensor.toml"), &["found/sensor.toml"]);
    refused(&to("out.csv", "out.csv"), &["out.csv", "name another file"]);
    refused(
        &to("nowhere/out.csv", "./nowhere/out.csv"),
        &["nowhere/out.csv", "name another file"],
    );
    refused(
        &to("out.csv", "found/moved.csv/s.csv"),
        &["cannot write into found/moved.csv"],
    );
    // Of a measured recording, there are samples already.
    let call = [
        "simulate",
        &design,
        "r.csv",
        "-o",
        "out.csv",
        "--samples",
        "s.csv",
    ];
    refused(
        &nonius(dir, &call),
        &["--samples", "cannot be used with", "RECORDING"],
    );
    assert!(!dir.join("out.csv").exists() && !dir.join("s.csv").exists());
}
