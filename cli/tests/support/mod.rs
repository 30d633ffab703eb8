//! The program as a user runs it.

pub(crate) mod calibration;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program in a folder.
pub(crate) fn nonius(dir: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nonius"))
        .current_dir(dir)
        .args(arguments)
        .output()
        .expect("nonius runs")
}

/// The same, successfully; what it says on standard error.
pub(crate) fn done(dir: &Path, arguments: &[&str]) -> String {
    let output = nonius(dir, arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {said}");
    said
}

/// A shipped design's path.
pub(crate) fn design() -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../designs/optical.toml");
    path.display().to_string()
}

/// A recording of an imperfect encoder, `per_period` samples a period, in volts.
pub(crate) fn recording(rows: usize, per_period: f64) -> String {
    let head = "# sample_rate_hz: 1000000\n# adc_bits: 12\n# full_scale: 1\ntime_s,cos,sin\n";
    let mut text = String::from(head);
    for k in 0..rows {
        let alpha = std::f64::consts::TAU * k as f64 / per_period;
        let code = |v: f64| (v * 2048.0).round() / 2048.0;
        let (cos, sin) = (
            0.75 * alpha.cos() + 0.04,
            0.85 * (alpha - 0.03).sin() - 0.03,
        );
        text += &format!("{:.7},{},{}\n", k as f64 * 1e-6, code(cos), code(sin));
    }
    text
}

/// It ended with 2 and said these words.
pub(crate) fn refused(output: &Output, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    for word in words {
        assert!(said.contains(word), "{word:?} is not in: {said}");
    }
}
