//! `nonius calibrate --json`: its keys, and what stands beside the parameters.

use crate::support::calibration::{METHODS, json, recording, sentences};
use serde_json::Value;

#[test]
fn the_json_has_its_keys() {
    let text = recording(4000, 7.3, [0.002; 2]);
    for method in METHODS {
        let json = json(&text, &["--method", method]);
        let mut keys: Vec<&String> = json.as_object().expect("an object").keys().collect();
        keys.sort();
        let expected = [
            "arc",
            "bound",
            "cannot_tell",
            "correlations",
            "distortion",
            "left_out",
            "method",
            "noise",
            "parameters",
            "remarks",
            "residual_rms",
            "samples",
            "schema",
        ];
        assert_eq!(keys, expected);
        assert_eq!(json["schema"], "nonius.calibration/1");
        assert_eq!(json["method"], method);
        assert_eq!(json["samples"], 4000);
        assert!(
            json["residual_rms"]
                .as_f64()
                .is_some_and(|r| r > 0.002 && r < 0.05)
        );
        let all = json["parameters"].as_array().expect("parameters");
        let names: Vec<&str> = all.iter().filter_map(|p| p["name"].as_str()).collect();
        let thetas = match method {
            "sumsq4" => 4,
            "poly8" => 8,
            "poly9" => 9,
            _ => 5,
        };
        let theta = (1..=thetas).map(|i| format!("theta_{i}"));
        let expected: Vec<String> = ["a_c", "b_c", "a_s", "b_s", "beta"]
            .map(String::from)
            .into_iter()
            .chain(theta)
            .collect();
        assert_eq!(names, expected);
        for p in all {
            let mut keys: Vec<&String> = p.as_object().expect("an object").keys().collect();
            keys.sort();
            assert_eq!(keys, ["bound", "name", "std_error", "unit", "value"]);
            let name = p["name"].as_str().expect("a name");
            let held = ["extremes", "sumsq4", "poly8"].contains(&method) && name == "beta"
                || method == "extremes" && name == "theta_5";
            assert_eq!(p["std_error"].is_null(), held, "{method} {p}");
            let unit = p["unit"].as_str().expect("a unit");
            assert_eq!(unit == "rad", name == "beta");
            assert_eq!(unit == "column", name.len() == 3, "{p}");
        }
        let held = sentences(&json).iter().any(|s| s.starts_with("beta: "));
        assert_eq!(held, ["extremes", "sumsq4", "poly8"].contains(&method));
        let blind = sentences(&json)
            .iter()
            .any(|s| s.contains("changes no radius"));
        assert_eq!(blind, method.starts_with("poly"));
    }
}

/// What the text says stands in the JSON: what was left out, the arc, where the noise ratio is from, remarks.
#[test]
fn the_json_says_what_the_text_says() {
    let mut rows = recording(4000, 7.3, [0.002; 2]);
    rows += &"0,0\n".repeat(200);
    let found = json(&rows, &[]);
    assert_eq!(
        (&found["samples"], &found["left_out"]),
        (&4200.into(), &200.into())
    );
    assert!(
        found["arc"].as_f64().is_some_and(|arc| arc > 0.98),
        "{found}"
    );
    assert_eq!(found["noise"]["ratio_source"], "estimated");
    assert!(found["distortion"].is_null() && found["noise"]["correlation"].is_null());
    let remarks = found["remarks"].as_array().expect("remarks");
    assert_eq!(
        remarks,
        &["200 samples lie far off the ellipse and are left out"]
    );
    let given = json(&rows, &["--noise-ratio", "1"]);
    assert_eq!(given["noise"]["ratio_source"], "given");
    let bent = json(&bent(4000), &[]);
    assert!(
        bent["distortion"]["rms"]
            .as_f64()
            .is_some_and(|rms| rms > 1e-3),
        "{bent}"
    );
    assert!(bent["distortion"]["order"].is_u64());
}

/// A channel with an even bend.
fn bent(samples: u32) -> String {
    let alpha = |k: u32| 7.3 * std::f64::consts::TAU * f64::from(k) / f64::from(samples);
    let row = |k: u32| {
        let (sin, cos) = alpha(k).sin_cos();
        // So that there is noise, and none is drawn.
        let wobble = 1e-3 * (f64::from(k) * 2.399).sin();
        format!("{},{}\n", cos + 0.02 * cos * cos + wobble, sin - wobble)
    };
    let rows: String = (0..samples).map(row).collect();
    format!("# sample_rate_hz: 10000\ncos,sin\n{rows}")
}

/// A disk that is full is a failure: the result is not there.
#[test]
#[cfg(target_os = "linux")]
fn what_does_not_arrive_is_a_failure() {
    let dir = tempfile::tempdir().expect("scratch");
    std::fs::write(dir.path().join("r.csv"), recording(400, 3.3, [0.002; 2])).expect("recording");
    for arguments in [&["r.csv"][..], &["r.csv", "--json"]] {
        let full = std::fs::File::options().write(true).open("/dev/full");
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_nonius"))
            .arg("calibrate")
            .args(arguments)
            .current_dir(dir.path())
            .stdout(full.expect("a device that is always full"))
            .output()
            .expect("the command");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("error: standard output: "), "{said}");
    }
}

/// Beside the parameters: how they hang together, the noise, and what no estimator can beat.
#[test]
fn the_json_has_correlations_noise_and_bound() {
    let text = recording(4000, 7.3, [0.002, 0.003]);
    for method in METHODS {
        let json = json(&text, &["--method", method]);
        let near = |value: &Value, truth: f64| {
            let value = value.as_f64().expect("a number");
            assert!(
                (value / truth - 1.0).abs() < 0.15,
                "{method}: {value} {truth}"
            );
        };
        near(&json["noise"]["cos_rms"], 0.002);
        near(&json["noise"]["sin_rms"], 0.003);
        near(&json["noise"]["ratio"], 1.5);
        assert!(
            json["noise"]["ratio_std_error"]
                .as_f64()
                .is_some_and(|e| e < 0.1)
        );
        // σ/a, rms over the angle.
        near(&json["bound"]["by_noise_of_a_sample_rad"], 0.0031);
        assert!(
            json["bound"]["by_parameters_rad"]
                .as_f64()
                .is_some_and(|e| e > 1e-5 && e < 1e-3)
        );
        let all = json["parameters"].as_array().expect("parameters");
        for p in all {
            let error = p["std_error"].as_f64();
            // Of the method's own set: none for a phase that it holds.
            assert_eq!(
                p["bound"].is_null(),
                p["name"] == "beta" && ["sumsq4", "poly8"].contains(&method)
            );
            if let (Some(error), Some(bound), "unbiased") = (error, p["bound"].as_f64(), method) {
                assert!((0.9..1.5).contains(&(error / bound)), "{p}");
            }
        }
        let blocks = json["correlations"].as_array().expect("two of them");
        let mut names = vec![];
        for block in blocks {
            let own: Vec<&str> = block["names"]
                .as_array()
                .expect("names")
                .iter()
                .filter_map(Value::as_str)
                .collect();
            let at = |i: usize, j: usize| &block["matrix"][i][j];
            for i in 0..own.len() {
                let held = all
                    .iter()
                    .any(|p| p["name"] == own[i] && p["std_error"].is_null());
                assert_eq!(at(i, i).is_null(), held, "{method} {}", own[i]);
                for j in 0..own.len() {
                    assert_eq!(at(i, j), at(j, i));
                    let size = at(i, j).as_f64().map_or(0.0, f64::abs);
                    assert!(size < 1.0 + 1e-9 && (i != j || held || size == 1.0));
                }
            }
            names.extend(own);
        }
        let listed: Vec<&str> = all.iter().filter_map(|p| p["name"].as_str()).collect();
        assert_eq!(names, listed, "{method}");
    }
}
