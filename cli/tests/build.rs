//! `nonius build` through the binary: what it says of a design that misses something, and what it refuses.

use std::fs;

use crate::support::{design, nonius, refused};

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

/// What the calibration does not see at top speed is noted, and nothing of it elsewhere.
#[test]
fn what_no_calibration_sees_at_top_speed_is_told() {
    let dir = tempfile::tempdir().expect("scratch");
    let text = fs::read_to_string(design()).expect("designs/optical.toml");
    let rest = "the bends rest";
    for (speed, calibration, told) in [
        ("100e3 ", "parameters = 5", false),
        ("100e3 ", "parameters = 9", false),
        ("200e3 ", "parameters = 5", false),
        ("250e3 ", "parameters = 5", false),
        ("250e3 ", "parameters = 0", false),
        ("250e3 ", "parameters = 5\nmethod = \"exact\"", false),
        ("125e3 ", "parameters = 9", false),
        ("200e3 ", "parameters = 8", true),
        ("250e3 ", "parameters = 9", true),
    ] {
        let text = text
            .replacen("100e3 ", speed, 1)
            .replacen("parameters = 5", calibration, 1);
        fs::write(dir.path().join("d.toml"), text).expect("design");
        let output = nonius(
            dir.path(),
            &["build", "d.toml", "-o", "out", "--rows", "10"],
        );
        let said = String::from_utf8_lossy(&output.stdout);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(
            said.contains("written"),
            "{speed} {calibration}: {said} {errors}"
        );
        assert_eq!(said.contains(rest), told, "{speed} {calibration}: {said}");
    }
}

/// A promise beyond the range of the ADC is noted whatever makes it so; one that just fills it is not.
#[test]
fn a_promise_that_clips_is_told() {
    let dir = tempfile::tempdir().expect("scratch");
    let text = fs::read_to_string(design()).expect("designs/optical.toml");
    let second = "\n[[correction.harmonics]]\norder = 2\namplitude_cos = 0.02\nphase_cos = 0.3\namplitude_sin = 0.02\nphase_sin = 1.1\n";
    for (from, to, more, reaches) in [
        ("", "", "", None),
        ("amplitude = 0.8 ", "amplitude = 0.82 ", "", Some("1.025")),
        ("parameters = 5", "parameters = 9", "", Some("1.046")),
        ("", "", second, Some("1.018")),
    ] {
        assert!(text.contains(from));
        let text = text.replacen(from, to, 1) + more;
        fs::write(dir.path().join("d.toml"), text).expect("design");
        let output = nonius(
            dir.path(),
            &["build", "d.toml", "-o", "out", "--rows", "10"],
        );
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(said.contains("written"), "{said}");
        assert_eq!(said.contains("it clips"), reaches.is_some(), "{said}");
        let words = reaches.map(|peak| format!("reaches {peak} of the ADC's range"));
        assert!(words.is_none_or(|words| said.contains(&words)), "{said}");
    }
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
        (
            "bandwidth_hz = 10e3",
            "bandwidth_hz = 1e300",
            &["loop.bandwidth_hz = 1e300:"],
        ),
        ("method = 3", "method = 2", &["Method 2", "type 2"]),
        // A register of the chip that is no value of its graph.
        (
            "name = \"optical\"",
            "name = \"product_0\"",
            &["d.toml:2:1: name = \"product_0\"", "no signal of the chip"],
        ),
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
        // Of Icarus alone.
        (
            "name = \"optical\"",
            "name = \"bool\"",
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
            ["d.toml:33:1: chip.clock_hz", "20000000"],
        ),
        (
            "multipliers = 1",
            "multipliers = 1\nclock_hz = nan",
            ["d.toml:33:1: chip.clock_hz", "NaN"],
        ),
        // No chip is as fast, and constraints in thousandths of a nanosecond would be of none.
        (
            "multipliers = 1",
            "multipliers = 1\nclock_hz = 1e12",
            ["d.toml:33:1: chip.clock_hz", "2e9"],
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
            "parameters = 9\nmethod = \"sum_of_squares\"\n[formats]\ngathered_fraction = 44\n",
            [
                "d.toml:28:1: formats.gathered_fraction = 44: ",
                "limit: 8 … 43",
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
