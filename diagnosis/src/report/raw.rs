//! Pictures of what is wrong in the data themselves: codes that are missing, samples that are lost, doubled or far off.

use std::collections::BTreeMap;

use nonius_plot::{Axis, Look, Mark, Plot, Series};
use nonius_recording::Recording;

use crate::finding::{Finding, Place};

/// Samples on either side of a place that is shown.
const AROUND: usize = 14;
/// Codes that are counted, at least.
const CODES: i64 = 32;

/// The pictures of a finding; none where it is of another kind.
pub(super) fn of(finding: &Finding, recording: &Recording) -> Vec<Plot> {
    match finding.place {
        Some(Place::Sample(k)) => vec![trace(recording, k)],
        Some(Place::Code { channel, step }) => codes(recording, channel, step),
        None => vec![],
    }
}

/// Both signals around a sample.
fn trace(recording: &Recording, k: usize) -> Plot {
    let last = recording.samples().saturating_sub(1);
    let range = k.saturating_sub(AROUND)..(k + AROUND).min(last) + 1;
    let time = |k: usize| 1e3 * (recording.time_s[k] - recording.time_s[0]);
    let points =
        |values: &[f64]| -> Vec<[f64; 2]> { range.clone().map(|k| [time(k), values[k]]).collect() };
    let (cos, sin) = (points(&recording.cos), points(&recording.sin));
    let heights = cos.iter().chain(&sin).map(|p| p[1]);
    Plot {
        title: "The recording there".into(),
        x: Axis::fitted("time, ms", range.clone().map(time)),
        y: Axis::fitted("signals, as recorded", heights),
        series: vec![
            Series::new("cos", Look::Before, cos),
            Series::new("sin", Look::After, sin),
        ],
        marks: vec![Mark {
            x: time(k),
            text: format!("sample {k}"),
        }],
        round: false,
    }
}

/// How often codes come, over a range of them, and over the places of what repeats every `step` codes.
fn codes(recording: &Recording, channel: usize, step: i64) -> Vec<Plot> {
    let all: Vec<i64> = recording
        .codes()
        .map(|(cos, sin)| if channel == 0 { cos } else { sin })
        .collect();
    let mut sorted = all.clone();
    sorted.sort_unstable();
    let Some(middle) = sorted.get(sorted.len() / 2).copied() else {
        return vec![];
    };
    let reach = (2 * step).max(CODES);
    let first = middle - reach;
    let mut counts: BTreeMap<i64, u32> = (first..first + 2 * reach).map(|c| (c, 0)).collect();
    for code in &all {
        counts.entry(*code).and_modify(|n| *n += 1);
    }
    let folded = |counts: &BTreeMap<i64, u32>| -> Vec<[f64; 2]> {
        counts
            .iter()
            .map(|(c, n)| [*c as f64, f64::from(*n)])
            .collect()
    };
    let points = folded(&counts);
    vec![Plot {
        title: "How often each code comes".into(),
        x: Axis::linear("code", [first as f64, (first + 2 * reach) as f64]),
        y: Axis::fitted("samples", points.iter().map(|p| p[1]).chain([0.0])),
        series: vec![Series::new(
            if channel == 0 { "cos" } else { "sin" },
            Look::After,
            points,
        )],
        marks: vec![],
        round: false,
    }]
}
