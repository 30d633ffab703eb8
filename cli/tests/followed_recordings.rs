//! Designs made by `nonius new --from` follow the recordings they were made from and calibrate on line.
//!
//! The table is kept in docs/followed-recordings.md; NONIUS_BLESS=1 writes it anew.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

use crate::support::done;
use nonius_model::spec::Spec;
use nonius_recording::{Overrides, Recording, Survey};

/// For what a recording that is not there leaves out.
const CHECK: &str = "designs from recordings";

const KEPT: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../docs/followed-recordings.md"
);

/// Column `name` of what `simulate` wrote.
fn column(csv: &str, name: &str) -> Vec<f64> {
    let mut lines = csv.lines();
    let header = lines.next().expect("a header");
    let index = header.split(',').position(|h| h == name).expect("a column");
    let cell = |l: &str| l.split(',').nth(index).and_then(|c| c.parse().ok());
    lines.map(|l| cell(l).expect("a number")).collect()
}

/// Rms in degrees of angles in turns against a reference in radians; the best constant, and the sense of the
/// reference, removed.
fn error_degrees(turns: &[f64], reference: &[f64]) -> f64 {
    let against = |sense: f64| {
        let pairs = turns.iter().zip(reference);
        let differences: Vec<f64> = pairs.map(|(t, r)| t - sense * r / TAU).collect();
        let first = differences[0];
        let near = differences
            .iter()
            .map(|d| d - first - (d - first).round())
            .collect::<Vec<f64>>();
        let n = near.len() as f64;
        let mean = near.iter().sum::<f64>() / n;
        (near.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt() * 360.0
    };
    against(1.0).min(against(-1.0))
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// Net periods that the arctangent of the raw signals counts.
fn travelled(recording: &Recording) -> f64 {
    let angle = |k: usize| recording.sin[k].atan2(recording.cos[k]) / TAU;
    (1..recording.samples())
        .map(|k| angle(k) - angle(k - 1))
        .map(|step| step - step.round())
        .sum()
}

/// Positions that the chip of the diagnosis says over sixty turns, and the orders in its table.
fn diagnosed(dir: &Path, path: &Path, name: &str) -> (Vec<f64>, String) {
    let (file, found) = (path.display().to_string(), format!("{name}_found"));
    done(
        dir,
        &[
            "diagnose",
            &file,
            "-o",
            &found,
            "--periods-per-revolution",
            "1",
        ],
    );
    let (design, out) = (format!("{found}/design.toml"), format!("{found}.csv"));
    done(
        dir,
        &["simulate", &design, &file, "-o", &out, "--repeat", "60"],
    );
    let csv = std::fs::read_to_string(dir.join(out)).expect("what simulate wrote");
    let text = std::fs::read_to_string(dir.join(design)).expect("a design");
    let spec = Spec::from_toml(&text, "design.toml").expect("a design");
    let harmonics = spec.correction.harmonics.iter();
    let orders: Vec<String> = harmonics.map(|h| h.order.to_string()).collect();
    (column(&csv, "position_periods"), orders.join(", "))
}

/// Positions that the chip of a design made for the recording says, and whether it was locked.
fn followed(dir: &Path, path: &Path, name: &str, repeat: &str) -> (Vec<f64>, Vec<f64>) {
    let file = path.display().to_string();
    done(dir, &["new", name, "--from", &file]);
    let (design, out) = (format!("{name}.toml"), format!("{name}.csv"));
    done(
        dir,
        &["simulate", &design, &file, "-o", &out, "--repeat", repeat],
    );
    let csv = std::fs::read_to_string(dir.join(out)).expect("what simulate wrote");
    (column(&csv, "position_periods"), column(&csv, "locked"))
}

/// The same of the design made there, with its calibration switched off.
fn uncalibrated(dir: &Path, path: &Path, name: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(dir.join(format!("{name}.toml"))).expect("a design");
    let fixed = text.replace("\nparameters = 5 ", "\nparameters = 0 ");
    assert_ne!(fixed, text, "{name} calibrates five parameters");
    let (design, out) = (format!("{name}_fixed.toml"), format!("{name}_fixed.csv"));
    std::fs::write(dir.join(&design), fixed).expect("a design");
    let file = path.display().to_string();
    done(dir, &["simulate", &design, &file, "-o", &out]);
    let csv = std::fs::read_to_string(dir.join(out)).expect("what simulate wrote");
    column(&csv, "position_periods")
}

/// Differences of a chip's positions from the angle of the survey, after the first 300 samples, whole periods at the
/// first of them taken off.
fn differences(positions: &[f64], angle: &[f64]) -> Vec<f64> {
    let pairs = positions.iter().zip(angle).skip(300);
    let differences: Vec<f64> = pairs.map(|(p, a)| p - a).collect();
    let anchor = differences[0].round();
    differences.into_iter().map(|d| d - anchor).collect()
}

#[test]
fn designs_from_recordings_follow_them() {
    let dir = tempfile::tempdir().expect("scratch folder");
    let mut table = String::from(
        "# Recordings followed by the chip\n\n\
         Written by `NONIUS_BLESS=1 cargo test -p nonius followed_recordings::`; do not edit. Each design is made by\n\
         `nonius new --from` and simulated bit-true with `nonius simulate`.\n\n\
         ## RM44 magnetic encoder, one turn played sixty times\n\n\
         Rms angle error in degrees against the optical reference over the last turn; the best constant offset is removed. The\n\
         last chip is that of `nonius diagnose --periods-per-revolution 1`, which found its harmonics, with the reference, in the\n\
         turn that is played.\n\n\
         | recording | arctangent, uncorrected | off-line ellipse fit | chip, calibrated on line | chip of the diagnosis | orders in its table |\n\
         |---|---|---|---|---|---|\n",
    );
    let mut complete = true;
    for name in ["rm44_center", "rm44_static_x500um", "rm44_gap_z500um"] {
        let Some(path) = nonius_kept::recording(CHECK, &format!("{name}.csv")) else {
            complete = false;
            continue;
        };
        let recording = Recording::read(&path, &Overrides::default()).expect("a recording");
        let reference = recording.reference_rad.clone().expect("a reference");
        let pairs = recording.cos.iter().zip(&recording.sin);
        let raw: Vec<f64> = pairs.map(|(c, s)| s.atan2(*c) / TAU).collect();
        let offline = error_degrees(&Survey::of(&recording).motion.angle_periods, &reference);
        let (positions, _) = followed(dir.path(), &path, name, "60");
        let online = error_degrees(&positions[positions.len() - reference.len()..], &reference);
        let before = error_degrees(&raw, &reference);
        let (positions, orders) = diagnosed(dir.path(), &path, name);
        let mended = error_degrees(&positions[positions.len() - reference.len()..], &reference);
        writeln!(
            table,
            "| {name} | {before:.3} | {offline:.3} | {online:.3} | {mended:.3} | {orders} |"
        )
        .expect("text");
        println!("{name}: {offline:.3}, {online:.3} -> {mended:.3} degrees, orders {orders}");
        assert!(mended < 0.5 * online, "{name}: {online:.3} -> {mended:.3}");
        assert!(
            online <= 1.1 * offline,
            "{name}: {online:.3} on line, {offline:.3} degrees off line"
        );
    }
    table += "\n## Homodyne interferometers\n\n\
              In periods, against the angle of the off-line ellipse fit, sample by sample, after the first 300 samples. That angle\n\
              is an arctangent and has the noise of single samples, which stands in its own column (radial residual of the fit\n\
              over 2 pi): the chip's difference is mostly that noise, and the largest is its peak in a\n\
              hundred thousand samples. Half a period would be a lost one. Uncorrected, the offsets are larger than the\n\
              amplitude, and the arctangent of the raw signals does not count at all; *not calibrated* is the same design with\n\
              `parameters = 0`, which knows the nominal offsets and amplitudes that `new` wrote into it and nothing more.\n\n\
              | recording | periods travelled | arctangent, uncorrected: net periods lost | noise of a sample, rms | chip, not calibrated, rms | \
              chip, calibrated on line, rms | largest | locked |\n|---|---|---|---|---|---|---|---|\n";
    for name in ["homodyne_settle", "homodyne_stop"] {
        let Some(path) = nonius_kept::recording(CHECK, &format!("{name}.csv")) else {
            complete = false;
            continue;
        };
        let recording = Recording::read(&path, &Overrides::default()).expect("a recording");
        let survey = Survey::of(&recording);
        let motion = survey.motion;
        let (positions, locked) = followed(dir.path(), &path, name, "1");
        let fixed = uncalibrated(dir.path(), &path, name);
        let before = rms(&differences(&fixed, &motion.angle_periods));
        let differences = differences(&positions, &motion.angle_periods);
        let largest = differences.iter().fold(0.0, |most, d| d.abs().max(most));
        let rms = rms(&differences);
        let noise = survey.fit.residual_rms / TAU;
        let lost = motion.periods_net.abs() - travelled(&recording).abs();
        let share = locked.iter().sum::<f64>() / locked.len() as f64;
        writeln!(
            table,
            "| {name} | {:.1} | {lost:.0} of {:.0} | {noise:.4} | {before:.4} | {rms:.4} | {largest:.3} | {:.2} % |",
            motion.periods_travelled,
            motion.periods_net.abs(),
            share * 100.0
        )
        .expect("text");
        assert!(rms < 0.6 * before, "{name}: {before} -> {rms} periods rms");
        assert!(largest < 0.1, "{name}: {largest} periods apart");
        assert!(
            rms < 1.5 * noise,
            "{name}: {rms} periods rms, of which {noise} are noise"
        );
        assert!(locked[300..].iter().all(|l| *l == 1.0), "{name} lost lock");
    }
    if !complete {
        return;
    }
    nonius_kept::same(
        Path::new(KEPT),
        &table,
        "NONIUS_BLESS=1 cargo test -p nonius followed_recordings::",
    );
}

/// Less than a turn of an encoder of one period, which the recording does not say: nothing is learnt on line that could be
/// motion, and the paper in `f64` follows as the chip does.
#[test]
fn a_period_that_may_be_a_revolution_calibrates_no_bends() {
    let Some(path) = nonius_kept::recording(CHECK, "rm44_static_x500um.csv") else {
        return;
    };
    let dir = tempfile::tempdir().expect("scratch folder");
    let file = path.display().to_string();
    let said = done(dir.path(), &["diagnose", &file, "-o", "found"]);
    assert!(said.contains("keeps its parameters"), "{said}");
    let reference = Recording::read(&path, &Overrides::default())
        .expect("a recording")
        .reference_rad
        .expect("a reference");
    for reading in [&[][..], &["--reference"]] {
        let run = [
            "simulate",
            "found/design.toml",
            &file,
            "-o",
            "out.csv",
            "--repeat",
            "60",
        ];
        done(dir.path(), &[&run, reading].concat());
        let csv = std::fs::read_to_string(dir.path().join("out.csv")).expect("positions");
        let positions = column(&csv, "position_periods");
        let error = error_degrees(&positions[positions.len() - reference.len()..], &reference);
        assert!(error < 0.15, "{reading:?}: {error} degrees");
    }
}
