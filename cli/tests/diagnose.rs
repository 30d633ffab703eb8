//! `nonius diagnose` through the binary: what it writes, and that the other commands take it.

use std::f64::consts::TAU;
use std::fs;

use crate::support::calibration::noise;
use crate::support::{done, nonius, refused};

#[test]
fn diagnose_writes_its_files() {
    let dir = tempfile::tempdir().expect("scratch");
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\ntime_s,cos,sin\n");
    let mut state = 1u64;
    for k in 0..8000 {
        let t = f64::from(k) * 2e-5;
        let alpha = 90.0 * (30.0 * t).sin() + 200.0 * t;
        // A line at 150 Hz in the cosine channel; and noise.
        let mut dither = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 40) as f64 / f64::from(1 << 24) - 0.5) * 1e-3
        };
        let cos = 0.8 * alpha.cos() + 0.004 * (942.477_796 * t).cos() + dither();
        let sin = 0.7 * alpha.sin() + dither();
        let code = |v: f64| (v * 8192.0).round() / 8192.0;
        text += &format!("{t:.6},{},{}\n", code(cos), code(sin));
    }
    fs::write(dir.path().join("r.csv"), text).expect("recording");
    let output = nonius(dir.path(), &["diagnose", "r.csv", "-o", "out", "--json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(json["schema"], "nonius.findings/1");
    assert_eq!(json["recording"]["samples"], 8000);
    assert_eq!(json["recording"]["has_reference"], false);
    let first = &json["findings"][0];
    assert_eq!(first["cause"], "interference", "{json:#}");
    let frequency = first["parameters"][0]["value"].as_f64().expect("a number");
    assert!((frequency - 150.0).abs() < 0.5, "{frequency}");
    for key in ["confounded_with", "p_value", "gain", "evidence", "chip"] {
        assert!(!first[key].is_null(), "{key}");
    }
    assert!(json["unexplained"]["significant"].is_boolean());
    assert!(json["simulation"]["position_error_rms_rad"].is_null());
    let positions = fs::read_to_string(dir.path().join("out/positions.csv")).expect("positions");
    assert_eq!(positions.lines().count(), 8001);
    assert_eq!(positions.lines().next(), Some("time_s,position_periods"));
    for file in [
        "findings.json",
        "sensor.toml",
        "motion.csv",
        "design.toml",
        "report.html",
    ] {
        assert!(dir.path().join("out").join(file).is_file(), "{file}");
    }
    let built = nonius(dir.path(), &["build", "out/design.toml", "-o", "chip"]);
    assert!(
        built.status.success(),
        "{}",
        String::from_utf8_lossy(&built.stderr)
    );
    // The extended simulation runs, and goes into the Verilog's vectors.
    let sensor = ["--sensor", "out/sensor.toml", "-o"];
    for call in [
        [
            &["simulate", "out/design.toml"],
            &sensor[..],
            &["sensor.csv"],
        ]
        .concat(),
        [&["build", "out/design.toml"], &sensor[..], &["played"]].concat(),
    ] {
        let output = nonius(dir.path(), &call);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
    }
    let simulated = fs::read_to_string(dir.path().join("sensor.csv")).expect("simulated");
    assert_eq!(simulated.lines().count(), 8001);
    assert!(dir.path().join("played/vectors/sensor.vec").is_file());
    assert!(dir.path().join("played/waves/sensor.vcd").is_file());
    fs::write(dir.path().join("bad.toml"), "[signals]\na_c = true\n").expect("a file");
    refused(
        &nonius(
            dir.path(),
            &[
                "simulate",
                "out/design.toml",
                "--sensor",
                "bad.toml",
                "-o",
                "x.csv",
            ],
        ),
        &["bad.toml:2:7"],
    );
    refused(
        &nonius(dir.path(), &["diagnose", "none.csv", "-o", "out"]),
        &["none.csv"],
    );
}

/// A harmonic whose order the axis hides: the design corrects neither order, and says why; the sensor that is written is read back.
#[test]
fn a_harmonic_of_either_order_is_not_corrected() {
    let dir = tempfile::tempdir().expect("scratch");
    let mut noise = noise();
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\ntime_s,cos,sin\n");
    for k in 0..20_000 {
        let t = f64::from(k) * 2e-5;
        // Shaken at each sample.
        let alpha = 90.0 * (30.0 * t).sin() + 200.0 * t + 0.03 * noise();
        let third = 3.0 * alpha + 1.2;
        let cos = 0.8 * (alpha.cos() + 4e-4 * third.cos() + 1e-3 * noise());
        let sin = 0.8 * (alpha.sin() - 4e-4 * third.sin() + 1e-3 * noise());
        let code = |v: f64| (v * 8192.0).round() / 8192.0;
        text += &format!("{t:.6},{},{}\n", code(cos), code(sin));
    }
    fs::write(dir.path().join("r.csv"), text).expect("recording");
    let said = done(dir.path(), &["diagnose", "r.csv", "-o", "out"]);
    let read = |file: &str| fs::read_to_string(dir.path().join(file)).expect("written");
    assert!(read("out/findings.json").contains("other_order"), "{said}");
    let design = read("out/design.toml");
    let table = |line: &str| line.starts_with("amplitude_cos");
    assert!(!design.lines().any(table), "{said}");
    assert!(
        said.contains("harmonic as well, which errs the other way"),
        "{said}"
    );
    let report = read("out/report.html");
    assert!(!report.contains("300 %") && !report.contains("500 %"));
    done(
        dir.path(),
        &[
            "simulate",
            "out/design.toml",
            "--sensor",
            "out/sensor.toml",
            "-o",
            "chip",
        ],
    );
}

/// Where the axis is, radians.
fn to_and_fro(t: f64) -> f64 {
    90.0 * (30.0 * t).sin() + 200.0 * t
}

/// A recording of an axis to and fro whose channels are what is said of time and angle, in amplitudes.
fn recorded(channels: impl Fn(f64, f64) -> (f64, f64)) -> String {
    let mut noise = noise();
    let mut text = String::from("# adc_bits: 14\n# full_scale: 1\ntime_s,cos,sin\n");
    for k in 0..20_000 {
        let t = f64::from(k) * 2e-5;
        let (cos, sin) = channels(t, to_and_fro(t));
        let mut code = |v: f64| (0.8 * (v + 1e-3 * noise()) * 8192.0).round() / 8192.0;
        text += &format!("{t:.6},{},{}\n", code(cos), code(sin));
    }
    text
}

/// What the design cannot hold is not said to be corrected, neither in findings.json nor in the report, which has the reason.
#[test]
fn what_does_not_fit_the_design_is_said() {
    let dir = tempfile::tempdir().expect("scratch");
    let read = |file: &str| fs::read_to_string(dir.path().join(file)).expect("written");
    let first = |out: &str| {
        let json = read(&format!("{out}/findings.json"));
        let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
        json["findings"][0].clone()
    };
    // A loop would lose half its bandwidth along a period by the table of so large a harmonic.
    let steep = |_: f64, a: f64| {
        let of = |phase: f64| 0.09 * (7.0 * a + phase).cos();
        (a.cos() + of(0.4), a.sin() + of(-1.2))
    };
    fs::write(dir.path().join("r.csv"), recorded(steep)).expect("recording");
    let said = done(dir.path(), &["diagnose", "r.csv", "-o", "steep"]);
    let reason = "(order 7), but a table of them does not fit the design";
    assert!(said.contains(reason), "{said}");
    let found = first("steep");
    assert_eq!(found["cause"], "spatial_harmonic");
    assert_eq!(found["chip"], "cannot correct");
    let design = found["design"][0].as_str().expect("a sentence");
    assert!(design.contains(reason), "{design}");
    assert!(read("steep/report.html").contains(reason));
    // The chip of the given design follows nothing.
    let drifting = |t: f64, a: f64| (a.cos() + 0.05 * t, a.sin());
    fs::write(dir.path().join("r.csv"), recorded(drifting)).expect("recording");
    done(dir.path(), &["diagnose", "r.csv", "-o", "fitted"]);
    let found = first("fitted");
    assert_eq!(found["cause"], "offset_drift");
    assert_eq!(found["chip"], "corrects");
    let design = read("fitted/design.toml").replace("parameters = 5", "parameters = 0");
    fs::write(dir.path().join("off.toml"), design).expect("a design");
    let call = ["diagnose", "r.csv", "-o", "off", "--design", "off.toml"];
    done(dir.path(), &call);
    assert_eq!(first("off")["chip"], "cannot correct");
    let reason = "the calibration of design.toml is off, so nothing follows the drift";
    assert!(read("off/report.html").contains(&reason[1..]));
}

/// Bends of third order that make up for each other in the radius, on an axis that accelerates too much for a loop behind which nine
/// parameters would learn them within thousands of periods: a table holds them, and the chip is right.
#[test]
fn bends_that_the_loop_would_hide_go_into_the_table() {
    let dir = tempfile::tempdir().expect("scratch");
    let read = |file: &str| fs::read_to_string(dir.path().join(file)).expect("written");
    let bent = |_: f64, a: f64| {
        let bend = |y: f64, k: f64| y + k * y.powi(3);
        (bend(a.cos(), 0.04), bend(a.sin(), -0.04))
    };
    fs::write(dir.path().join("r.csv"), recorded(bent)).expect("recording");
    let said = done(dir.path(), &["diagnose", "r.csv", "-o", "out"]);
    assert!(
        said.contains("needs, where the axis accelerates as here,"),
        "{said}"
    );
    let design = read("out/design.toml");
    assert!(design.contains("parameters = 5"), "{said}");
    assert!(design.contains("amplitude_cos"), "{said}");
    let call = ["simulate", "out/design.toml", "r.csv", "-o", "chip"];
    done(dir.path(), &call);
    let chip = read("chip");
    let rows = chip.lines().skip(1).skip(13_000).map(|row| {
        let mut cells = row.split(',').map(|cell| cell.parse::<f64>());
        let mut next = || cells.next().expect("a cell").expect("a number");
        let t = next();
        TAU * next() - to_and_fro(t)
    });
    let errors: Vec<f64> = rows.collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let square = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>();
    let rms = (square / errors.len() as f64).sqrt();
    // Nine parameters leave 15 mrad, and the noise of the recording alone makes 0.7.
    assert!(rms < 1.5e-3, "{rms}");
}

/// At standstill nothing can be told from offset and gain: no names, but what to record.
#[test]
fn a_standstill_is_refused() {
    let dir = tempfile::tempdir().expect("scratch");
    let mut noise = noise();
    let mut text = String::from("# sample_rate_hz: 1000\ncos,sin\n");
    for _ in 0..4000 {
        let (cos, sin) = (0.5 + 0.001 * noise(), 0.3 + 0.001 * noise());
        text += &format!("{cos:.6},{sin:.6}\n");
    }
    fs::write(dir.path().join("r.csv"), text).expect("recording");
    let output = nonius(dir.path(), &["diagnose", "r.csv", "-o", "out"]);
    refused(
        &output,
        &["r.csv", "standstill", "move the scale by a whole period"],
    );
    assert!(!dir.path().join("out").exists(), "half-written");
}

/// A design with another converter runs on these signals only in another unit, or not at all, and that is said.
#[test]
fn a_design_of_another_converter_is_told() {
    let dir = tempfile::tempdir().expect("scratch");
    done(dir.path(), &["new", "d"]);
    let mut noise = noise();
    for (scale, said) in [
        (
            8000.0,
            "4000 of 4000 samples lie outside the design's ADC range -1 … 1",
        ),
        (
            0.004,
            "the signals take 0.4 % of the design's ADC range -1 … 1",
        ),
        (0.8, ""),
    ] {
        let mut text = String::from("time_s,cos,sin\n");
        for k in 0..4000 {
            let t = f64::from(k) * 1e-6;
            let alpha = 3e4 * t;
            let [c, s] = [alpha.cos(), alpha.sin()].map(|v| scale * (v + 0.001 * noise()));
            text += &format!("{t:.6},{c:.7},{s:.7}\n");
        }
        fs::write(dir.path().join("r.csv"), text).expect("recording");
        let call = ["diagnose", "r.csv", "-o", "o", "--design", "d.toml"];
        let output = nonius(dir.path(), &call);
        assert!(output.status.success());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(stderr.contains(said), "{stderr}");
        assert_eq!(stderr.contains("ADC range"), !said.is_empty(), "{stderr}");
    }
}
