//! Rows of zeros that hold no signal: a logger that shows them before its ADC has begun, after it has ended, or while its link
//! is down. They are data that say nothing about the sensor: they are left out, and the notes say so.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use nonius_quantity::{agree, counted};
use nonius_recording::{Ellipse, Recording};

use crate::checks::first;
use crate::numerics::continuous::{continuous, nearest};

/// A signal has a radius between these, in amplitudes. Where zero lies there, zeros may be a signal.
const SIGNAL: Range<f64> = 0.5..1.5;

/// A recording whose rows without signal are filled along the ellipse, and which samples count.
pub(crate) struct Heard {
    pub(crate) recording: Recording,
    /// 1 or 0 per sample.
    pub(crate) weight: Vec<f64>,
}

/// Runs of rows of zeros. A single one within the recording is a glitch.
fn runs(recording: &Recording) -> Vec<Range<usize>> {
    let n = recording.samples();
    let zero = |k: usize| recording.cos[k] == 0.0 && recording.sin[k] == 0.0;
    let mut runs: Vec<Range<usize>> = vec![];
    for k in (0..n).filter(|k| zero(*k)) {
        match runs.last_mut().filter(|run| run.end == k) {
            Some(run) => run.end = k + 1,
            None => runs.push(k..k + 1),
        }
    }
    runs.retain(|run| run.len() > 1 || run.start == 0 || run.end == n);
    runs
}

/// Leaves rows of zeros out; nothing where there are none, or where zeros may be a signal.
pub(crate) fn left_out(recording: &Recording) -> Option<Heard> {
    let n = recording.samples();
    let runs = runs(recording);
    let mut weight = vec![1.0; n];
    for run in &runs {
        weight[run.clone()].fill(0.0);
    }
    if runs.is_empty() {
        return None;
    }
    let ellipse = first::ellipse(recording, &weight).ok()?;
    if SIGNAL.contains(&(1.0 + ellipse.radial_residual(0.0, 0.0))) {
        return None;
    }
    let mut recording = recording.clone();
    fill(&mut recording, &ellipse, &runs, &weight);
    recording.notes.push(said(&runs));
    Some(Heard { recording, weight })
}

fn said(runs: &[Range<usize>]) -> String {
    let rows: usize = runs.iter().map(|r| r.len()).sum();
    let (count, first) = (runs.len(), &runs[0]);
    let places = match (count, first.len()) {
        (1, 1) => format!("(row {})", first.start),
        (1, _) => format!("(rows {} to {})", first.start, first.end - 1),
        _ => format!("at {count} places, the first from row {} on,", first.start),
    };
    format!(
        "{} of zeros {places} {} no signal and {} left out",
        counted(rows, "row"),
        agree(rows, "holds", "hold"),
        agree(rows, "is", "are"),
    )
}

/// Fills runs along the ellipse, in codes of the ADC, and a reference that is zero there, too.
fn fill(recording: &mut Recording, ellipse: &Ellipse, runs: &[Range<usize>], weight: &[f64]) {
    let pairs = recording.cos.iter().zip(&recording.sin);
    let angle = pairs.map(|(c, s)| TAU * ellipse.angle(*c, *s)).collect();
    let angle = continuous(angle, weight);
    let adc = recording.metadata.adc;
    for k in runs.iter().cloned().flatten() {
        let alpha = angle[k];
        let cos = ellipse.a_c * alpha.cos() + ellipse.b_c;
        let sin = ellipse.a_s * (alpha - ellipse.beta).sin() + ellipse.b_s;
        recording.cos[k] = adc.cos.value(adc.cos.code(cos));
        recording.sin[k] = adc.sin.value(adc.sin.code(sin));
    }
    if let Some(reference) = &mut recording.reference_rad {
        follow(reference, &angle, runs);
    }
}

/// Fills a reference where it is zero as well, along the angle of the sensor.
fn follow(reference: &mut [f64], angle: &[f64], runs: &[Range<usize>]) {
    let change = |values: &[f64], k: usize| nearest(values[k] - values[k - 1], 0.0);
    let silent = |k: usize| runs.iter().any(|run| run.contains(&k));
    let alike: f64 = (1..angle.len())
        .filter(|k| !silent(*k) && !silent(k - 1))
        .map(|k| change(angle, k) * change(reference, k))
        .sum();
    let sense = if alike < 0.0 { -1.0 } else { 1.0 };
    for run in runs {
        if reference[run.clone()].iter().any(|r| *r != 0.0) {
            continue;
        }
        let beside = [run.start.checked_sub(1), Some(run.end)];
        let apart = beside.map(|k| Some(reference.get(k?)? - sense * angle[k?]));
        let (from, by) = match apart {
            [Some(a), Some(b)] => (a, nearest(b - a, 0.0)),
            [Some(a), None] | [None, Some(a)] => (a, 0.0),
            [None, None] => continue,
        };
        let steps = (run.len() + 1) as f64;
        for (i, k) in run.clone().enumerate() {
            let value = sense * angle[k] + from + by * (i + 1) as f64 / steps;
            reference[k] = value - TAU * ((value + PI) / TAU).floor();
        }
    }
}
