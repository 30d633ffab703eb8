//! A recording, its diagnosis, and what the chip before it and after it err by.

use std::f64::consts::TAU;
use std::ffi::OsString;
use std::fs;
use std::path::Path;

use nonius_hdl::progress::silent;
use nonius_hdl::verify::{Options, verify};
use nonius_model::spec::Spec;
use nonius_recording::{Overrides, Recording};

use super::encoders::ROWS;

/// Rows of the recording that become vectors.
const PLAYED: usize = 1_000;

/// The command, successfully.
fn done(arguments: &[&dyn AsRef<Path>]) {
    let named = arguments.iter().map(|a| a.as_ref().as_os_str().to_owned());
    let code = nonius::run(std::iter::once(OsString::from("nonius")).chain(named));
    assert_eq!(code, 0);
}

/// Rms over the last third of the chip's position against the truth, mrad of a scale period.
fn error(dir: &Path, design: &str) -> f64 {
    let out = dir.join("out.csv");
    done(&[
        &"simulate",
        &dir.join(design),
        &dir.join("r.csv"),
        &"-o",
        &out,
    ]);
    let said = fs::read_to_string(out).expect("what simulate wrote");
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

pub(super) struct Closed {
    /// The design that the diagnosis writes.
    pub(super) design: Spec,
    /// What the diagnosis finds, what explains most first.
    pub(super) findings: Vec<serde_json::Value>,
    /// Angle error of the chip that knows nothing, and of that of the diagnosis.
    pub(super) before: f64,
    pub(super) after: f64,
}

impl Closed {
    /// Share of the angle error that the chip of the diagnosis leaves.
    pub(super) fn left(&self) -> f64 {
        self.after / self.before
    }

    /// What was found of this name, which the chip corrects.
    pub(super) fn found(&self, cause: &str) -> &serde_json::Value {
        let found = self.findings.iter().find(|f| f["cause"] == cause);
        let found = found.unwrap_or_else(|| panic!("no {cause} in {:#?}", self.findings));
        assert_eq!(found["chip"], "corrects");
        found
    }

    /// Names of all that was found, of which there are no others than these.
    pub(super) fn names(&self, known: &[&str]) -> String {
        let name = |found: &serde_json::Value| {
            let name = found["cause"].as_str().expect("a name");
            assert!(known.contains(&name), "{found:#}");
            format!("`{name}`")
        };
        let names: Vec<String> = self.findings.iter().map(name).collect();
        names.join(", ")
    }

    pub(super) fn errors(&self) -> String {
        format!("{:.3} -> {:.3} mrad", self.before, self.after)
    }
}

/// From the recording to the chip, in the simulators too where that is asked for.
pub(super) fn closed(recording: &str, simulated: bool) -> Closed {
    let dir = tempfile::tempdir().expect("scratch folder");
    let dir = dir.path();
    let (file, found) = (dir.join("r.csv"), dir.join("found"));
    fs::write(&file, recording).expect("a recording");
    let read = Recording::read(&file, &Overrides::default()).expect("a recording");
    let (plain, _) =
        nonius::new::fitted_text("plain", &file, &read).expect("a design can follow it");
    fs::write(dir.join("plain.toml"), plain).expect("a design");
    done(&[&"diagnose", &file, &"-o", &found]);
    let json = fs::read_to_string(dir.join("found/findings.json")).expect("findings");
    let design = "found/design.toml";
    if simulated {
        let rows = recording.split_inclusive('\n').take(5 + PLAYED);
        let head = dir.join("head.csv");
        fs::write(&head, rows.collect::<String>()).expect("its beginning");
        // The named stimuli have tests of their own.
        let (from, to) = (dir.join(design), dir.join("chip"));
        done(&[
            &"build", &from, &"-o", &to, &"--play", &head, &"--rows", &"20",
        ]);
        let report = verify(dir.join("chip"), &Options::PATIENT, &silent);
        let report = report.unwrap_or_else(|e| panic!("{e}"));
        assert!(report.passed && report.runs.len() == 2, "{report:#?}");
        let played = fs::read_to_string(dir.join("chip/vectors/recording.vec"));
        assert_eq!(
            played.expect("the recording's vectors").lines().count(),
            PLAYED
        );
    }
    let text = fs::read_to_string(dir.join(design)).expect("a design");
    let findings: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    Closed {
        design: Spec::from_toml(&text, design).expect("a design"),
        findings: findings["findings"].as_array().expect("a list").clone(),
        before: error(dir, "plain.toml"),
        after: error(dir, design),
    }
}
