//! Rows of zeros that hold no signal: a logger that shows them before its ADC has begun, after it has ended, or while its link
//! is down. They are data that say nothing about the sensor: they are left out, and the notes say so.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use nonius_quantity::{agree, counted};
use nonius_recording::{Ellipse, Recording};

use crate::checks::first;

/// A signal has a radius between these, in amplitudes. Where zero lies there, zeros may be a signal.
const SIGNAL: Range<f64> = 0.5..1.5;
/// Samples beside a run that tell how fast the scale moves there.
const BESIDE: usize = 16;

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
    fill(&mut recording, &ellipse, &runs);
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

/// An angle brought to within half a period of zero.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// How the scale moves at one side of a run: angle and angle per sample, radians, of the nearest sample that counts.
#[derive(Clone, Copy)]
struct Side {
    angle: f64,
    speed: f64,
}

impl Side {
    /// From samples beside the run, in order of time; `last`: the nearest is the last of them.
    fn of(angles: &[f64], last: bool) -> Option<Self> {
        let first = *angles.first()?;
        let mut along = vec![first];
        for pair in angles.windows(2) {
            along.push(along[along.len() - 1] + wrapped(pair[1] - pair[0]));
        }
        let middle = (along.len() - 1) as f64 / 2.0;
        let (mut product, mut square) = (0.0, 0.0);
        for (i, angle) in along.iter().enumerate() {
            product += (i as f64 - middle) * angle;
            square += (i as f64 - middle).powi(2);
        }
        let near = if last { along.len() - 1 } else { 0 };
        Some(Self {
            angle: along[near],
            speed: if square > 0.0 { product / square } else { 0.0 },
        })
    }
}

/// The angle within a run of so many samples: what the scale does on either side goes on, with as many whole periods as
/// that takes.
fn within(count: usize, before: Option<Side>, after: Option<Side>) -> Vec<f64> {
    let steps = (count + 1) as f64;
    let place = |i: usize| (i + 1) as f64;
    match (before, after) {
        (Some(a), Some(b)) => {
            let way = steps * (a.speed + b.speed) / 2.0;
            let way = way + wrapped(b.angle - a.angle - way);
            let at = |i: usize| {
                let x = place(i) / steps;
                let (start, end) = (x * (1.0 - x).powi(2), x * x * (x - 1.0));
                let curve = x * x * (3.0 - 2.0 * x) * way;
                a.angle + curve + steps * (start * a.speed + end * b.speed)
            };
            (0..count).map(at).collect()
        }
        (Some(a), None) => (0..count).map(|i| a.angle + place(i) * a.speed).collect(),
        (None, Some(b)) => (0..count)
            .map(|i| b.angle - place(count - 1 - i) * b.speed)
            .collect(),
        (None, None) => vec![0.0; count],
    }
}

/// Fills runs along the ellipse, in codes of the ADC, and a reference that is zero there, too.
fn fill(recording: &mut Recording, ellipse: &Ellipse, runs: &[Range<usize>]) {
    let n = recording.samples();
    let pairs = recording.cos.iter().zip(&recording.sin);
    let mut angle: Vec<f64> = pairs.map(|(c, s)| TAU * ellipse.angle(*c, *s)).collect();
    let adc = recording.metadata.adc;
    let mut from = 0;
    for (i, run) in runs.iter().enumerate() {
        let to = runs.get(i + 1).map_or(n, |next| next.start);
        let before = from.max(run.start.saturating_sub(BESIDE))..run.start;
        let after = run.end..to.min(run.end + BESIDE);
        let sides = [
            Side::of(&angle[before], true),
            Side::of(&angle[after], false),
        ];
        let inside = within(run.len(), sides[0], sides[1]);
        for (k, alpha) in run.clone().zip(&inside) {
            angle[k] = *alpha;
            let cos = ellipse.a_c * alpha.cos() + ellipse.b_c;
            let sin = ellipse.a_s * (alpha - ellipse.beta).sin() + ellipse.b_s;
            recording.cos[k] = adc.cos.value(adc.cos.code(cos));
            recording.sin[k] = adc.sin.value(adc.sin.code(sin));
        }
        from = run.end;
    }
    if let Some(reference) = &mut recording.reference_rad {
        follow(reference, &angle, runs);
    }
}

/// Fills a reference where it is zero as well, along the angle of the sensor.
fn follow(reference: &mut [f64], angle: &[f64], runs: &[Range<usize>]) {
    let change = |values: &[f64], k: usize| wrapped(values[k] - values[k - 1]);
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
            [Some(a), Some(b)] => (a, wrapped(b - a)),
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
