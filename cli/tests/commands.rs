//! The commands as a user types them: what they write, what they refuse, exit codes.

mod support;

use std::fs;

use proptest::prelude::*;
use support::{design, nonius, recording, refused};

#[test]
fn new_writes_a_design_that_builds_and_never_overwrites() {
    let dir = tempfile::tempdir().expect("scratch");
    let read = || fs::read_to_string(dir.path().join("mine.toml")).expect("mine.toml");
    assert!(nonius(dir.path(), &["new", "mine"]).status.success());
    let written = read();
    refused(
        &nonius(dir.path(), &["new", "mine"]),
        &["mine.toml", "exists"],
    );
    assert_eq!(read(), written);
    let built = nonius(dir.path(), &["build", "mine.toml", "-o", "out/mine"]);
    assert!(
        built.status.success(),
        "{}",
        String::from_utf8_lossy(&built.stderr)
    );
    assert!(dir.path().join("out/mine/rtl/mine.v").is_file());
    let said = String::from_utf8_lossy(&built.stdout);
    assert!(said.contains("next: ") && !said.contains("note"), "{said}");
    refused(&nonius(dir.path(), &["new", "2nd"]), &["name", "2nd"]);
    assert!(!dir.path().join("2nd.toml").exists());
}

/// What 8 parameters do not correct is the reason that is told, and the way out holds.
#[test]
fn a_phase_error_that_stays_is_told() {
    let dir = tempfile::tempdir().expect("scratch");
    let text = fs::read_to_string(design()).expect("designs/optical.toml");
    let built = |parameters: &str| {
        let text = text.replace("parameters = 5", parameters);
        fs::write(dir.path().join("d.toml"), text).expect("design");
        let output = nonius(
            dir.path(),
            &["build", "d.toml", "-o", "out", "--rows", "10"],
        );
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        (output.status.code(), said)
    };
    for (parameters, words) in [
        (
            "parameters = 8",
            "the phase error (sensor.phase_error_max_deg = 5), which 8 parameters do not correct: take \
             calibration.parameters = 9",
        ),
        (
            "parameters = 4",
            "which 4 parameters do not correct: take calibration.parameters = 5",
        ),
        (
            "parameters = 0",
            "stay without calibration: take calibration.parameters = 5",
        ),
    ] {
        let (code, said) = built(parameters);
        assert_eq!(code, Some(1), "{said}");
        assert!(
            said.contains("the accuracy is missed: ") && said.contains(words),
            "{said}"
        );
        assert_eq!(said.matches("accuracy is missed").count(), 1, "{said}");
        assert!(!said.contains("misses what was asked"), "{said}");
    }
    let (code, said) = built("parameters = 9");
    assert_eq!(code, Some(0), "{said}");
}

/// It is built, says what does not lock and what to change, and ends as where the accuracy is missed.
#[test]
fn a_promise_that_would_not_lock_is_told() {
    let dir = tempfile::tempdir().expect("scratch");
    let text = fs::read_to_string(design()).expect("designs/optical.toml");
    let more = [
        ("offset_max = 0.1 ", "offset_max = 0.4 "),
        ("amplitude = 0.8 ", "amplitude = 0.6 "),
    ];
    let text = more.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from));
        text.replacen(from, to, 1)
    });
    fs::write(dir.path().join("d.toml"), text).expect("design");
    let output = nonius(dir.path(), &["build", "d.toml", "-o", "out"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    for words in [
        "do not lock",
        "worst: ",
        "offsets of ",
        "to change: ",
        "sensor.offset_max = ",
    ] {
        assert!(said.contains(words), "{said}");
    }
    assert!(dir.path().join("out/design.json").is_file());
}

#[test]
fn build_refuses_before_anything_is_written() {
    let dir = tempfile::tempdir().expect("scratch");
    let text = fs::read_to_string(design()).expect("designs/optical.toml");
    for (from, to, words) in [
        (
            "bandwidth_hz = 10e3",
            "bandwidth_hz = 900e3",
            &[
                "d.toml:22:1: loop.bandwidth_hz",
                "limit: 79.578 … 159150 Hz",
            ][..],
        ),
        ("method = 3", "method = 2", &["Method 2", "type 2"]),
        (
            "bits = 12",
            "bitz = 12",
            &["d.toml:15:1: unknown key `adc.bitz`", "`bits`"],
        ),
        (
            "sample_rate_hz = 1e6",
            "sample_rate_hz = 1e5",
            &["sample_rate_hz"],
        ),
    ] {
        assert!(text.contains(from));
        fs::write(dir.path().join("d.toml"), text.replacen(from, to, 1)).expect("design");
        refused(
            &nonius(dir.path(), &["build", "d.toml", "-o", "out"]),
            words,
        );
        assert!(!dir.path().join("out").exists());
    }
    // A folder that is not ours is left alone.
    fs::create_dir(dir.path().join("mine")).expect("folder");
    fs::write(dir.path().join("mine/letter.txt"), "dear").expect("file");
    refused(
        &nonius(dir.path(), &["build", &design(), "-o", "mine"]),
        &["mine"],
    );
    assert!(dir.path().join("mine/letter.txt").is_file());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn damaged_recordings_never_panic(cut in 0usize..4000, byte in any::<u8>(), at in 0usize..4000) {
        let dir = tempfile::tempdir().expect("scratch");
        let mut bytes = recording(120, 40.0).into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(cut.max(10));
        fs::write(dir.path().join("r.csv"), bytes).expect("recording");
        for arguments in [
            vec!["new", "n", "--from", "r.csv"],
            vec!["simulate", &design(), "r.csv", "-o", "o.csv"],
        ] {
            let output = nonius(dir.path(), &arguments);
            let said = String::from_utf8_lossy(&output.stderr);
            prop_assert!(matches!(output.status.code(), Some(0 | 2)), "{}", said);
            prop_assert!(!said.contains("panicked"), "{}", said);
        }
    }
}

#[test]
fn diagnose_writes_the_contract() {
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
    for file in ["findings.json", "sensor.toml", "design.toml", "report.html"] {
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
    assert!(simulated.lines().count() > 2000);
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

#[test]
fn verify_refuses_what_it_cannot_run() {
    let dir = tempfile::tempdir().expect("scratch folder");
    refused(
        &nonius(dir.path(), &["verify", "chip", "--simulator", "modelsim"]),
        &["modelsim", "icarus", "verilator"],
    );
    refused(&nonius(dir.path(), &["verify", "nowhere"]), &["nowhere"]);
}

/// Writing destroys nothing: no device, no input, no file of the user's in an output folder.
#[test]
fn nothing_of_the_users_is_written_over() {
    let dir = tempfile::tempdir().expect("scratch folder");
    let at = |name: &str| dir.path().join(name);
    fs::write(at("r.csv"), recording(4000, 50.0)).expect("a recording");
    let before = fs::read(at("r.csv")).expect("a recording");
    let design = design();
    let simulate = |more: &[&str]| {
        nonius(
            dir.path(),
            &[&["simulate", &design, "r.csv"], more].concat(),
        )
    };
    refused(&simulate(&["-o", "r.csv"]), &["r.csv", "another file"]);
    refused(&simulate(&["-o", "o.csv", "--vcd", "./o.csv"]), &["o.csv"]);
    assert_eq!(fs::read(at("r.csv")).expect("a recording"), before);
    #[cfg(unix)]
    {
        let socket = std::os::unix::net::UnixListener::bind(at("socket")).expect("a socket");
        refused(&simulate(&["-o", "socket"]), &["no ordinary file"]);
        drop(socket);
    }
    assert!(
        nonius(dir.path(), &["build", &design, "-o", "chip"])
            .status
            .success()
    );
    fs::write(at("chip/notes.txt"), "mine").expect("the user's own");
    assert!(
        nonius(dir.path(), &["build", &design, "-o", "chip"])
            .status
            .success()
    );
    assert_eq!(
        fs::read_to_string(at("chip/notes.txt")).expect("kept"),
        "mine"
    );
    fs::create_dir(at("other")).expect("a folder");
    fs::write(at("other/design.json"), "{}").expect("somebody's");
    refused(
        &nonius(dir.path(), &["build", &design, "-o", "other"]),
        &["other"],
    );
}

#[test]
fn a_design_without_end_is_refused() {
    let dir = tempfile::tempdir().expect("scratch");
    let output = nonius(dir.path(), &["build", "/dev/zero", "-o", "out"]);
    refused(&output, &["/dev/zero", "it is no design"]);
}

#[test]
fn designs_that_no_chip_can_have_are_refused() {
    let dir = tempfile::tempdir().expect("scratch folder");
    let text = fs::read_to_string(design()).expect("a design");
    for (from, to, words) in [
        (
            "name = \"optical\"",
            "name = \"module\"",
            ["d.toml:2:1: name", "keyword"],
        ),
        (
            "name = \"optical\"",
            "name = \"chip_tb\"",
            ["name", "testbench"],
        ),
        (
            "multipliers = 1",
            "multipliers = 1\nclock_hz = 1e6",
            ["d.toml:33:1: chip.clock_hz", "19000000"],
        ),
        (
            "multipliers = 1",
            "multipliers = 1\nclock_hz = nan",
            ["d.toml:33:1: chip.clock_hz", "NaN"],
        ),
        (
            "scale_period_m = 20e-6",
            "scale_period_m = -1",
            ["d.toml:12:1: sensor.scale_period_m", "-1"],
        ),
        (
            "scale_period_m = 20e-6",
            "periods_per_revolution = 0",
            ["d.toml:12:1: sensor.periods_per_revolution", "0"],
        ),
        (
            "= 100e3",
            "= -5",
            ["d.toml:11:1: sensor.speed_max_periods_per_s", "-5"],
        ),
        (
            "noise_rms = 0.001",
            "noise_rms = -1",
            ["d.toml:10:1: sensor.noise_rms = -1: rms", "0 … 0.25"],
        ),
        (
            "[chip]\nmultipliers = 1",
            "[chip]\nmultipliers = 0",
            ["d.toml:32:1: chip.multipliers = 0", "need a multiplier"],
        ),
        (
            "[chip]",
            "[formats]\nsignal_fraction = 24\nphase_bits = 44\nresidual_fraction = 3\n[chip]",
            [
                "d.toml:34:1: formats.residual_fraction = 3",
                "limit: 4 … 24",
            ],
        ),
        (
            "[chip]",
            "[formats]\n gain_range_log2 = -4\n[chip]",
            [
                "d.toml:32:2: formats.gain_range_log2 = -4",
                "theta_1_deviation",
            ],
        ),
        (
            "[chip]",
            "[formats]\nharmonic_fraction = 12\n[chip]",
            [
                "d.toml:32:1: formats.harmonic_fraction = 12",
                "leave it out",
            ],
        ),
        (
            "parameters = 5",
            "parameters = 9\nmethod = \"sum_of_squares\"\n[formats]\nsignal_fraction = 24\naccumulator_fraction = 44\n",
            [
                "d.toml:29:1: formats.accumulator_fraction = 44: the formats cannot hold the design: ",
                "does not fit s63.48",
            ],
        ),
        (
            "[calibration]\nparameters = 5",
            "[calibration]\n  parameters = 7",
            ["d.toml:25:3: calibration.parameters = 7", "limit"],
        ),
    ] {
        assert!(text.contains(from), "{from}");
        fs::write(dir.path().join("d.toml"), text.replacen(from, to, 1)).expect("a file");
        refused(
            &nonius(dir.path(), &["build", "d.toml", "-o", "out"]),
            &words,
        );
        assert!(!dir.path().join("out").exists(), "{to}");
    }
}
