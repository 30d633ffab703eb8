//! `nonius simulate --reference` beside `nonius simulate`, over measured recordings: the paper in floating point and the
//! bit-true chip, each left to its own decisions, say the same.

use std::f64::consts::TAU;
use std::path::Path;

use crate::support::done;

/// For what a recording that is not there leaves out.
const CHECK: &str = "paper and chip over recordings";

fn column(path: &Path, name: &str) -> Vec<f64> {
    let text = std::fs::read_to_string(path).expect("a file");
    let mut lines = text.lines();
    let header = lines.next().expect("a header");
    let index = header.split(',').position(|h| h == name).expect("a column");
    let cell = |l: &str| l.split(',').nth(index).and_then(|c| c.parse().ok());
    lines.map(|l| cell(l).expect("a number")).collect()
}

/// Positions of the chip and of the paper, with a design made for the recording.
fn both(recording: &Path, repeat: &str) -> [Vec<f64>; 2] {
    let dir = tempfile::tempdir().expect("scratch folder");
    let file = recording.display().to_string();
    done(dir.path(), &["new", "it", "--from", &file]);
    [&[][..], &["--reference"][..]].map(|flag| {
        let common = [
            "simulate", "it.toml", &file, "-o", "o.csv", "--repeat", repeat,
        ];
        done(dir.path(), &[&common, flag].concat());
        let out = dir.path().join("o.csv");
        let locked = column(&out, "locked");
        assert!(
            locked[300..].iter().all(|l| *l == 1.0),
            "{flag:?} lost lock"
        );
        column(&out, "position_periods")
    })
}

/// Rms in degrees against the recording's reference, which counts the other way; the best constant removed.
fn error_degrees(turns: &[f64], reference: &[f64]) -> f64 {
    let differences: Vec<f64> = turns
        .iter()
        .zip(reference)
        .map(|(t, r)| t + r / TAU)
        .collect();
    let first = differences[0];
    let near: Vec<f64> = differences
        .iter()
        .map(|d| d - first - (d - first).round())
        .collect();
    let n = near.len() as f64;
    let mean = near.iter().sum::<f64>() / n;
    (near.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt() * 360.0
}

/// RM44, one turn played sixty times: the angle errors of the last turn differ by less than 2 %.
#[test]
fn the_magnetic_encoder_is_calibrated_alike() {
    let mut measured = vec![];
    for name in ["rm44_center", "rm44_static_x500um", "rm44_gap_z500um"] {
        let Some(path) = nonius_kept::recording(CHECK, &format!("{name}.csv")) else {
            return;
        };
        let reference = column(&path, "reference_rad");
        let [chip, paper] =
            both(&path, "60").map(|p| error_degrees(&p[p.len() - reference.len()..], &reference));
        measured.push(format!("{name}: chip {chip:.3}, paper {paper:.3}"));
        assert!((paper / chip - 1.0).abs() < 0.02, "{name}: {chip} {paper}");
        assert!(paper < 0.27, "{name}: {paper}");
    }
    let what =
        "chip and paper, each with its own decisions, over the RM44: angle error, degrees rms";
    figure(what, &measured.join("; "));
}

fn figure(what: &str, measured: &str) {
    nonius_kept::figure(
        what,
        measured,
        "cli/tests/paper_and_chip_over_recordings.rs",
    );
}

/// Homodyne interferometers with stops, ringing and reversals: 8-bit codes, thousands of periods, never a hundredth of
/// a period apart once both have locked.
#[test]
fn the_interferometers_are_followed_alike() {
    let mut measured = vec![];
    for name in ["homodyne_settle", "homodyne_stop"] {
        let Some(path) = nonius_kept::recording(CHECK, &format!("{name}.csv")) else {
            return;
        };
        let [chip, paper] = both(&path, "1");
        let whole = (paper[300] - chip[300]).round();
        let apart = |k: usize| (paper[k] - chip[k] - whole).abs();
        let largest = (300..chip.len()).map(apart).fold(0.0, f64::max);
        measured.push(format!("{name}: {largest:.4}"));
        assert!(largest < 0.01, "{name}: {largest}");
    }
    let what = "chip and paper, each with its own decisions, over the homodyne interferometers: furthest apart, periods";
    figure(what, &measured.join("; "));
}
