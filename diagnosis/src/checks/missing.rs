//! Codes that an ADC never gives: where one is missing, its samples have the code beside it, which comes twice as often.

use nonius_quantity::{agree, counted};

use crate::finding::{Cause, Finding, Parameter, Place};
use crate::numerics::lines::median;

/// Codes on either side that tell how often one is expected.
const BESIDE: usize = 4;
/// Probability, over all codes looked at, below which a code does not stay away by chance.
const BY_CHANCE: f64 = 1e-4;
/// Share of what a code and the two beside it are expected to have together that they have at least: else no signal was there.
const TOGETHER: f64 = 0.8;
/// Share of the codes above which it is no single codes that are missing.
const MOST: f64 = 0.2;
/// Fewest codes whose counts tell how evenly samples fall.
const FEWEST: usize = 24;
/// Median of the square of a normal number.
const MEDIAN: f64 = 0.4549;

/// How often each code comes, from the lowest on.
fn counts(codes: &[i64]) -> Option<(i64, Vec<f64>)> {
    let (low, high) = (*codes.iter().min()?, *codes.iter().max()?);
    let span = usize::try_from(high - low).ok()? + 1;
    // Of more codes than samples most are missing.
    if span > codes.len() {
        return None;
    }
    let mut counts = vec![0.0; span];
    for code in codes {
        counts[(code - low) as usize] += 1.0;
    }
    Some((low, counts))
}

/// Codes that are missing between the lowest and the highest, for samples that count. The turning points of a channel, where
/// codes come more often the nearer they are, are left out.
pub(crate) fn codes(codes: &[i64]) -> Vec<i64> {
    let Some((low, counts)) = counts(codes) else {
        return vec![];
    };
    let n = counts.len();
    // A sine is within 0.9 of its amplitude there.
    let inside = (n / 20).max(BESIDE)..n.saturating_sub((n / 20).max(BESIDE));
    if inside.len() < FEWEST {
        return vec![];
    }
    // The middle of the counts nearby: one of them that has twice as many, or none, changes nothing.
    let expected = |i: usize| {
        let near = (i - BESIDE..=i + BESIDE).filter(|j| *j != i);
        let near: Vec<f64> = near.map(|j| counts[j]).collect();
        median(&near)
    };
    let expected: Vec<f64> = inside.clone().map(expected).collect();
    // Samples of slow motion come in groups, so that counts scatter more than those of single samples.
    let pairs = inside.clone().zip(&expected).filter(|(_, e)| **e > 0.0);
    let off: Vec<f64> = pairs.map(|(i, e)| (counts[i] - e).powi(2) / e).collect();
    let scatter = (median(&off) / MEDIAN).max(1.0);
    let limit = scatter * (n as f64 / BY_CHANCE).ln();
    let missing: Vec<i64> = inside
        .zip(&expected)
        .filter(|(i, e)| {
            let together = counts[i - 1] + counts[*i] + counts[i + 1];
            counts[*i] == 0.0 && **e > limit && together > TOGETHER * 3.0 * **e
        })
        .map(|(i, _)| low + i as i64)
        .collect();
    if missing.len() as f64 > MOST * n as f64 {
        vec![]
    } else {
        missing
    }
}

/// What is said of codes that are missing in a channel (0 is cos).
pub(crate) fn finding(name: &str, channel: usize, missing: &[i64]) -> Finding {
    let count = missing.len();
    let evidence = format!(
        "{} of the {name} channel never {} while the codes beside {} come more often than others: {} {}",
        counted(count, "code"),
        agree(count, "comes", "come"),
        agree(count, "it", "them"),
        agree(count, "it is", "the first is"),
        missing[0]
    );
    let parameters = vec![
        Parameter::exact("missing_codes", count as f64, "codes"),
        Parameter::exact("first_code", missing[0] as f64, "LSB"),
    ];
    Finding::digital(Cause::AdcNonlinearity, parameters, evidence).at(Place::Missing {
        channel,
        code: missing[0],
    })
}
