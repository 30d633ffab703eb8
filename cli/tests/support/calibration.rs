//! Recordings of a known ellipse, and `nonius calibrate` over them.

use std::fmt::Write as _;
use std::fs;
use std::process::Output;

use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};
use serde_json::Value;

/// Every method.
pub(crate) const METHODS: [&str; 7] = [
    "unbiased",
    "heydemann",
    "extremes",
    "sumsq4",
    "sumsq5",
    "poly8",
    "poly9",
];

/// Numbers of unit variance, the same in every run.
pub(crate) fn noise() -> impl FnMut() -> f64 {
    let mut random = StdRng::seed_from_u64(1);
    move || StandardNormal.sample(&mut random)
}

/// What the recordings are made with.
pub(crate) const TRUTH: [(&str, f64); 5] = [
    ("a_c", 0.75),
    ("b_c", 0.04),
    ("a_s", 0.85),
    ("b_s", -0.03),
    ("beta", 0.03),
];

/// A recording of [`TRUTH`] over `periods`, with noise of cosine and sine.
pub(crate) fn recording(samples: u32, periods: f64, sigma: [f64; 2]) -> String {
    let mut noise = noise();
    let mut text = String::from("# sample_rate_hz: 10000\ncos,sin\n");
    for k in 0..samples {
        let alpha = 0.4 + std::f64::consts::TAU * periods * f64::from(k) / f64::from(samples);
        let c = 0.75 * alpha.cos() + 0.04 + sigma[0] * noise();
        let s = 0.85 * (alpha - 0.03).sin() - 0.03 + sigma[1] * noise();
        writeln!(text, "{c:.7},{s:.7}").expect("text");
    }
    text
}

/// The command over a recording of this text.
pub(crate) fn calibrate(text: &str, arguments: &[&str]) -> Output {
    let dir = tempfile::tempdir().expect("scratch");
    fs::write(dir.path().join("r.csv"), text).expect("recording");
    super::nonius(dir.path(), &[&["calibrate", "r.csv"], arguments].concat())
}

/// What it says as JSON.
pub(crate) fn json(text: &str, arguments: &[&str]) -> Value {
    let output = calibrate(text, &[&["--json"], arguments].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    serde_json::from_slice(&output.stdout).expect("JSON and nothing else")
}

/// What the data cannot tell.
pub(crate) fn sentences(json: &Value) -> Vec<&str> {
    let all = json["cannot_tell"].as_array().expect("sentences");
    all.iter()
        .map(|s| s.as_str().expect("a sentence"))
        .collect()
}
