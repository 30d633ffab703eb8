//! Recording, diagnosis, emitted design, chip: the angle error that the diagnosis takes away, on the chip.
//!
//! The table is kept in docs/closing-the-loop.md; NONIUS_BLESS=1 writes it anew.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

const KEPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/closing-the-loop.md");
const ROWS: u32 = 120_000;

fn nonius(dir: &Path, arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_nonius"))
        .current_dir(dir)
        .args(arguments)
        .output()
        .expect("nonius runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    said
}

/// A recording of a bent encoder of 64 periods per revolution, with its true angle.
fn recording(bends: [f64; 2]) -> String {
    let mut text = String::from(
        "# sample_rate_hz: 50000\n# adc_bits: 14\n# full_scale: 1\n# periods_per_revolution: 64\ntime_s,cos,sin,reference_rad\n",
    );
    let mut state = 7u64;
    let mut noise = || {
        let mut sum = -6.0;
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            sum += (state >> 40) as f64 / f64::from(1 << 24);
        }
        sum * 1e-3
    };
    for k in 0..ROWS {
        let t = f64::from(k) / 50e3;
        // From 250 to 550 periods a second and back.
        let alpha = TAU * (400.0 * t - 150.0 / TAU / 0.4 * (TAU * 0.4 * t).sin());
        let bent = |u: f64, k: f64| u + k * u * u * u;
        let cos = 0.7 * bent(alpha.cos() + noise(), bends[0]) + 0.03;
        let sin = 0.66 * bent((alpha - 0.05).sin() + noise(), bends[1]) - 0.02;
        let code = |v: f64| (v * 8192.0).round() / 8192.0;
        let _ = writeln!(
            text,
            "{t:.6},{},{},{:.6}",
            code(cos),
            code(sin),
            alpha.rem_euclid(TAU)
        );
    }
    text
}

/// Rms over the last third of the chip's position against the truth, mrad of a scale period.
fn error(dir: &Path, design: &str) -> f64 {
    nonius(dir, &["simulate", design, "r.csv", "-o", "out.csv"]);
    let said = fs::read_to_string(dir.join("out.csv")).expect("what simulate wrote");
    let truth = fs::read_to_string(dir.join("r.csv")).expect("the recording");
    let positions = said.lines().skip(1).map(|l| {
        let cell = l.split(',').nth(1).and_then(|c| c.parse::<f64>().ok());
        cell.expect("a position") * TAU
    });
    let angles = truth.lines().skip(5).map(|l| {
        let cell = l.split(',').nth(3).and_then(|c| c.parse::<f64>().ok());
        cell.expect("an angle")
    });
    let errors: Vec<f64> = positions
        .zip(angles)
        .skip(2 * ROWS as usize / 3)
        .map(|(p, a)| p - a - TAU * ((p - a) / TAU).round())
        .collect();
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    1e3 * (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt()
}

#[test]
fn what_is_found_is_corrected_by_the_chip() {
    let mut table = String::from(
        "# Closing the loop\n\n\
         Written by `NONIUS_BLESS=1 cargo test -p nonius --test closing_the_loop`; do not edit. A bent encoder is simulated with\n\
         its true angle, diagnosed, and the chip of the emitted design run over the same recording. Angle error in mrad of a\n\
         scale period, rms over the last third.\n\n\
         | bends y + k y³ (cos, sin) | named | chip of `new --from` | chip of the diagnosis |\n|---|---|---|---|\n",
    );
    for bends in [[0.04, 0.02], [0.03, -0.03]] {
        let dir = tempfile::tempdir().expect("scratch folder");
        let dir = dir.path();
        fs::write(dir.join("r.csv"), recording(bends)).expect("a recording");
        nonius(dir, &["new", "plain", "--from", "r.csv"]);
        let said = nonius(dir, &["diagnose", "r.csv", "-o", "found"]);
        let json = fs::read_to_string(dir.join("found/findings.json")).expect("findings");
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        assert!(
            said.contains("nine parameters"),
            "{said} {:#}",
            json["findings"]
        );
        let name = json["findings"][0]["cause"].as_str().expect("a name");
        let (before, after) = (error(dir, "plain.toml"), error(dir, "found/design.toml"));
        println!("{bends:?}: {name}, {before:.3} -> {after:.3} mrad");
        let _ = writeln!(
            table,
            "| {:.1} %, {:.1} % | `{name}` | {before:.2} | {after:.2} |",
            100.0 * bends[0],
            100.0 * bends[1]
        );
        assert!(after < 0.5 * before, "{before} -> {after} mrad");
    }
    nonius_kept::same(
        Path::new(KEPT),
        &table,
        "NONIUS_BLESS=1 cargo test -p nonius --test closing_the_loop",
    );
}
