//! `nonius calibrate` through the binary: what it finds, exit codes, and words where the data cannot tell.

use std::fmt::Write as _;
use std::path::Path;

use crate::support;
use crate::support::calibration::{METHODS, TRUTH, calibrate, json, noise, recording, sentences};
use serde_json::Value;

fn refused(text: &str, arguments: &[&str], words: &[&str]) {
    let output = calibrate(text, arguments);
    support::refused(&output, words);
    assert!(output.stdout.is_empty());
}

fn parameter<'a>(json: &'a Value, name: &str) -> &'a Value {
    let all = json["parameters"].as_array().expect("parameters");
    all.iter()
        .find(|p| p["name"] == name)
        .expect("the parameter")
}

/// What the arc cannot tell has no error bar by any method but the one that says how large it is.
#[test]
fn a_short_arc_has_no_error_bar_that_is_none() {
    let text = recording(4000, 0.25, [0.03; 2]);
    for method in ["extremes", "sumsq5", "heydemann", "sumsq4"] {
        let json = json(&text, &["--method", method]);
        let said = sentences(&json).join(" ");
        for name in ["a_s", "b_s"] {
            assert!(
                parameter(&json, name)["std_error"].is_null(),
                "{method} {name}"
            );
            assert!(said.contains(&format!("{name} cannot be told")), "{said}");
        }
        if method.starts_with("sumsq") {
            // The search is one place of the circle there, and its Theta withheld.
            let all = json["parameters"].as_array().expect("parameters");
            assert!(all.len() == 5 && said.contains("collapsed"), "{said}");
        } else {
            for name in ["theta_3", "theta_4"] {
                let theta = &parameter(&json, name)["std_error"];
                assert!(theta.is_null(), "{method} {name}");
            }
        }
        if method == "extremes" {
            assert!(
                said.contains("the arc does not reach both ends of cos"),
                "{said}"
            );
            assert!(parameter(&json, "a_c")["std_error"].is_null());
        }
    }
    // A long arc with little noise is told, but by its extremes.
    let text = recording(4000, 0.6, [0.002; 2]);
    for (method, told) in [("sumsq5", true), ("extremes", false)] {
        let json = json(&text, &["--method", method]);
        assert_eq!(
            parameter(&json, "a_s")["std_error"].is_null(),
            !told,
            "{method}"
        );
    }
}

#[test]
fn the_default_finds_the_truth_within_its_error_bars_and_has_nothing_to_add() {
    let json = json(&recording(4000, 7.3, [0.002; 2]), &[]);
    assert_eq!(json["method"], "unbiased");
    assert_eq!(sentences(&json), [""; 0]);
    for (name, truth) in TRUTH {
        let p = parameter(&json, name);
        let error = p["std_error"].as_f64().expect("an error");
        assert!(
            (p["value"].as_f64().expect("a value") - truth).abs() < 4.0 * error,
            "{p}"
        );
        assert!(error < 3e-4, "{p}");
    }
}

#[test]
fn an_ellipse_without_noise_is_found_by_all_that_can() {
    let text = recording(4096, 61.3, [0.0; 2]);
    for method in ["unbiased", "heydemann", "sumsq5", "poly9"] {
        let json = json(&text, &["--method", method]);
        for (name, truth) in TRUTH {
            let found = parameter(&json, name)["value"].as_f64().expect("a value");
            assert!((found - truth).abs() < 1e-5, "{method}: {name} {found}");
        }
    }
}

#[test]
fn the_text_gives_parameters_with_their_errors() {
    let output = calibrate(&recording(4000, 7.3, [0.002; 2]), &[]);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    for word in ["[[Statistics]]", "[[Parameters]]", "a_c", "+/-", "bound"] {
        assert!(said.contains(word), "{said}");
    }
}

#[test]
fn a_noise_ratio_is_estimated_or_given() {
    let text = recording(4000, 7.3, [0.03, 0.051]);
    let ratio = |arguments: &[&str]| -> String {
        let output = calibrate(&text, arguments);
        let said = String::from_utf8(output.stdout).expect("text");
        let line = said
            .lines()
            .find(|l| l.contains("noise ratio"))
            .expect("the line");
        line.split_once("= ").expect("a value").1.to_owned()
    };
    let estimated = ratio(&[]);
    assert!(
        estimated.ends_with("(sin to cos, estimated)"),
        "{estimated}"
    );
    let found: f64 = estimated
        .split(' ')
        .next()
        .expect("a number")
        .parse()
        .expect("a number");
    assert!((found - 1.7).abs() < 0.2, "{estimated}");
    assert_eq!(
        ratio(&["--noise-ratio", "1.7"]),
        "1.700 (sin to cos, given)"
    );
    for wrong in ["-1", "0", "nan", "1e9"] {
        refused(
            &text,
            &[&format!("--noise-ratio={wrong}")],
            &["--noise-ratio", "0.01 to 100"],
        );
        refused(&text, &["--noise-ratio", wrong], &["0.01 to 100"]);
    }
}

#[test]
fn a_short_arc_says_which_parameters_it_does_not_tell() {
    // A quarter of a period from 0.4 rad on, where sine is small: its size and centre go together.
    let json = json(&recording(4000, 0.25, [0.03; 2]), &[]);
    let all = sentences(&json);
    assert!(
        all[0].contains("of the scale period holds no sample"),
        "{all:?}"
    );
    assert!(
        all[0].contains("less well known than from whole periods: b_s"),
        "{all:?}"
    );
    for (name, truth) in TRUTH {
        let p = parameter(&json, name);
        let error = p["std_error"].as_f64().expect("an error");
        assert!(
            (p["value"].as_f64().expect("a value") - truth).abs() < 4.0 * error,
            "{p}"
        );
        let named = all
            .iter()
            .any(|s| s.starts_with(&format!("{name} cannot be told")));
        assert_eq!(named, ["a_s", "b_s"].contains(&name), "{all:?}");
    }
}

#[test]
fn an_arc_that_is_a_line_under_its_noise_is_an_answer_too() {
    for method in METHODS {
        let json = json(&recording(4000, 0.05, [0.01; 2]), &["--method", method]);
        let said = sentences(&json).join(" ");
        assert!(
            said.contains("on a line") && said.contains("a_c, b_c, a_s, b_s, beta"),
            "{said}"
        );
        assert!(parameter(&json, "a_c")["std_error"].is_null());
    }
}

#[test]
fn a_standstill_is_an_answer() {
    let mut noise = noise();
    let mut text = String::from("# sample_rate_hz: 1000\ncos,sin\n");
    for _ in 0..2000 {
        writeln!(
            text,
            "{:.6},{:.6}",
            0.7 + 0.01 * noise(),
            0.2 + 0.01 * noise()
        )
        .expect("text");
    }
    for method in METHODS {
        let json = json(&text, &["--method", method]);
        for p in json["parameters"].as_array().expect("parameters") {
            assert!(p["std_error"].is_null(), "{method}: {p}");
        }
        let said = sentences(&json).join(" ");
        assert!(
            said.contains("a_c, b_c, a_s, b_s, beta") && said.contains("stands still"),
            "{said}"
        );
    }
}

/// Codes of a 12-bit ADC, also constant ones: an answer and no error, with the cause and the way out, and no other cause.
#[test]
fn a_standstill_of_codes_is_an_answer() {
    for sigma in [0.0, 0.15, 0.35, 0.7] {
        let mut noise = noise();
        let mut text =
            String::from("# sample_rate_hz: 1000\n# adc_bits: 12\n# full_scale: 2048\ncos,sin\n");
        for _ in 0..3000 {
            let (c, s) = (1200.3 + sigma * noise(), -500.4 + sigma * noise());
            writeln!(text, "{:.0},{:.0}", c.round(), s.round()).expect("text");
        }
        for method in METHODS {
            let json = json(&text, &["--method", method]);
            let said = sentences(&json).join(" ");
            assert!(
                said.contains("the scale stands still") && said.contains("a whole period"),
                "{sigma} {said}"
            );
            let all = json["parameters"].as_array().expect("parameters");
            assert!(all.iter().all(|p| p["std_error"].is_null()));
        }
    }
}

#[test]
fn only_a_known_adc_has_its_rounding_in_the_report() {
    let text = recording(2000, 7.3, [0.002; 2]);
    let known = text.replacen("cos,sin", "# adc_bits: 12\n# full_scale: 1\ncos,sin", 1);
    for (text, there) in [(text, false), (known, true)] {
        let output = calibrate(&text, &[]);
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(said.contains("ADC rounding"), there, "{said}");
    }
}

#[test]
fn distortion_drift_and_glitches_are_said() {
    let mut noise = noise();
    let (mut bent, mut drifting, mut glitched) = ["# sample_rate_hz: 1000\ncos,sin\n"; 3]
        .map(String::from)
        .into();
    for k in 0..6000u32 {
        let alpha = 0.0123 * f64::from(k);
        let (s, c) = alpha.sin_cos();
        let (n, m) = (0.003 * noise(), 0.003 * noise());
        writeln!(bent, "{:.6},{:.6}", c + 0.03 * c * c * c + n, s + m).expect("text");
        let slow = 0.02 * (f64::from(k) / 1500.0).sin();
        writeln!(drifting, "{:.6},{:.6}", c + slow + n, s + m).expect("text");
        let (c, s) = if k < 3 {
            (0.0, 0.0)
        } else {
            (c + n + 0.2, s + m)
        };
        writeln!(glitched, "{c:.6},{s:.6}").expect("text");
    }
    let said = |text: &str| sentences(&json(text, &[])).join(" ");
    assert!(said(&bent).contains("no exact ellipse"), "{}", said(&bent));
    assert!(
        said(&drifting).contains("consecutive parts of the recording differ"),
        "{}",
        said(&drifting)
    );
    assert_eq!(said(&glitched), "");
    let output = calibrate(&glitched, &[]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(
        text.contains("samples          = 6000, 3 of them left out"),
        "{text}"
    );
}

#[test]
fn what_is_wrong_is_refused_with_place_and_way_out() {
    let text = recording(200, 3.0, [0.0; 2]);
    refused(&text, &["--method", "magic"], &["magic", "unbiased"]);
    refused("cos,sin\n1,2\n1,2\n", &[], &["r.csv"]);
    refused(&text.replacen("sin", "other", 1), &[], &["r.csv:2", "sin"]);
    let mut lines: Vec<&str> = text.lines().collect();
    lines[50] = "0.1,oops";
    refused(&lines.join("\n"), &[], &["r.csv:51", "oops"]);
    lines[50] = "0.1,NaN";
    refused(&lines.join("\n"), &[], &["r.csv:51"]);
    let dead = |line: &str| match line.split_once(',') {
        Some((_, sin)) if sin != "sin" => format!("0.1,{sin}\n"),
        _ => format!("{line}\n"),
    };
    let dead: String = text.lines().map(dead).collect();
    refused(&dead, &[], &["'cos' is dead", "wiring"]);
    let dir = tempfile::tempdir().expect("scratch");
    let nowhere = support::nonius(dir.path(), &["calibrate", "nowhere.csv"]);
    support::refused(&nowhere, &["nowhere.csv"]);
}

/// Sixteen encoders in one file: time starts again, and the file is refused whole with the place.
#[test]
fn several_records_in_one_file_are_refused() {
    let check = "several records in one file";
    let Some(file) = nonius_kept::recording(check, "optical_servo_tables.csv") else {
        return;
    };
    let output = support::nonius(Path::new("."), &["calibrate", &file.display().to_string()]);
    support::refused(&output, &["optical_servo_tables.csv:514", "unit"]);
}
