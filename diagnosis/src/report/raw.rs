//! Pictures of what is wrong in the data themselves: codes that are missing, samples that are lost, doubled or far off.

use std::collections::BTreeMap;

use nonius_plot::{Axis, Look, Mark, Plot, Series};
use nonius_recording::Recording;

use super::jump;
use crate::diagnose::Diagnosis;
use crate::finding::{Finding, Place};
use crate::numerics::solve::Normal;

/// Samples on either side of a place that is shown.
const AROUND: usize = 14;
/// Codes that are counted, at least.
const CODES: i64 = 32;

/// The pictures of a finding; none where it is of another kind.
pub(super) fn of(finding: &Finding, found: &Diagnosis, recording: &Recording) -> Vec<Plot> {
    match finding.place {
        Some(Place::Gap { .. } | Place::Repeat { .. }) => jump::of(finding, found, recording),
        Some(Place::Sample(k)) => vec![trace(recording, k)],
        Some(Place::Code { channel, step }) => codes(recording, channel, step, None),
        Some(Place::Missing { channel, code } | Place::Rail { channel, code }) => {
            codes(recording, channel, 1, Some(code))
        }
        None => vec![],
    }
}

/// Both signals around a sample.
fn trace(recording: &Recording, k: usize) -> Plot {
    let last = recording.samples().saturating_sub(1);
    let range = k.saturating_sub(AROUND)..(k + AROUND).min(last) + 1;
    let points = |values: &[f64]| -> Vec<[f64; 2]> {
        range.clone().map(|k| [k as f64, values[k]]).collect()
    };
    let (cos, sin) = (points(&recording.cos), points(&recording.sin));
    let curve = curve(&[&cos, &sin], k - range.start);
    let heights = cos.iter().chain(&sin).chain(&curve).map(|p| p[1]);
    Plot {
        title: "The recording around the first glitch".into(),
        x: Axis::fitted("sample", cos.iter().map(|p| p[0])),
        y: Axis::fitted("signals, as recorded", heights),
        series: vec![
            Series::new("curve through the neighbours", Look::Model, curve.clone()),
            Series::new("cos", Look::Before, cos),
            Series::new("sin", Look::After, sin),
        ],
        marks: vec![Mark {
            x: k as f64,
            text: format!("sample {k}"),
        }],
        round: false,
    }
}

/// The curve through a channel but for a sample and those beside it: of the channel that is farther off it there.
fn curve(channels: &[&[[f64; 2]]; 2], at: usize) -> Vec<[f64; 2]> {
    const ORDER: i32 = 4;
    let one = |points: &[[f64; 2]]| {
        let place = |i: usize| (i as f64 - at as f64) / AROUND as f64;
        let kept: Vec<usize> = (0..points.len()).filter(|i| i.abs_diff(at) > 1).collect();
        let column = |order: i32| kept.iter().map(|i| place(*i).powi(order)).collect();
        let columns: Vec<Vec<f64>> = (0..=ORDER).map(column).collect();
        let values: Vec<f64> = kept.iter().map(|i| points[*i][1]).collect();
        let x = Normal::of_columns(&values, &columns).solve().x;
        let value = |i: usize| -> f64 {
            let terms = (0..=ORDER).zip(&x);
            terms.map(|(order, x)| x * place(i).powi(order)).sum()
        };
        let curve: Vec<[f64; 2]> = (0..points.len())
            .map(|i| [points[i][0], value(i)])
            .collect();
        ((points[at][1] - curve[at][1]).abs(), curve)
    };
    let [a, b] = channels.map(one);
    if a.0 > b.0 { a.1 } else { b.1 }
}

/// How often codes come, over a range of them that holds what repeats every `step` codes, about the code of that number or
/// the middle one.
fn codes(recording: &Recording, channel: usize, step: i64, about: Option<i64>) -> Vec<Plot> {
    let all: Vec<i64> = recording
        .codes()
        .map(|(cos, sin)| if channel == 0 { cos } else { sin })
        .collect();
    let mut sorted = all.clone();
    sorted.sort_unstable();
    let Some(middle) = about.or(sorted.get(sorted.len() / 2).copied()) else {
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
