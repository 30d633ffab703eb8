//! Several causes in one recording: which, and what a campaign of such recordings says.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use rand::{Rng, rngs::StdRng, seq::IndexedRandom};

use crate::effects::{CATALOGUE, Entry};
use crate::score::{Outcome, Score};
use crate::summary::{Share, Summary, median};

/// So many causes, at least and at most.
const COUNT: std::ops::RangeInclusive<usize> = 3..=5;
/// Each cause by itself has an SNR from the first to the second, evenly in the logarithm.
const SNR: [f64; 2] = [10.0, 300.0];
/// Edges of the bins of SNR.
const BINS: [f64; 5] = [10.0, 20.0, 50.0, 100.0, 301.0];
/// Where one of a row is there, no recording shows how much of another one is.
const ALIKE: [&[&str]; 5] = [
    &[
        "even_nonlinearity",
        "odd_nonlinearity",
        "spatial_harmonic",
        "saturation",
    ],
    &["channel_skew", "bandwidth_mismatch"],
    &["latency", "common_bandwidth"],
    &["stuck_bit", "coarse_quantisation", "adc_nonlinearity"],
    &["offset_drift", "gain_drift", "flicker_noise"],
];
/// Positions have become worse where their error is so many times that of the five parameters alone.
const WORSE: f64 = 1.1;

/// Three to five causes of the catalogue with the SNR of each, the first one by turns; whether each is as the world draws it.
pub(crate) fn plan(turn: u64, random: &mut StdRng) -> Vec<(&'static Entry, bool, f64)> {
    let count = random.random_range(COUNT);
    let mut chosen = vec![&CATALOGUE[(turn % CATALOGUE.len() as u64) as usize]];
    while chosen.len() < count {
        let next = CATALOGUE.choose(random).expect("a catalogue");
        if chosen.iter().all(|other| !alike(other.name, next.name)) {
            chosen.push(next);
        }
    }
    let each = chosen.into_iter().map(|entry| {
        let wild = entry.wild && random.random_bool(0.5);
        let snr = SNR[0] * (SNR[1] / SNR[0]).powf(random.random());
        (entry, wild, snr)
    });
    each.collect()
}

fn alike(one: &str, other: &str) -> bool {
    let both = |row: &&[&str]| row.contains(&one) && row.contains(&other);
    one == other || ALIKE.iter().any(both)
}

/// One hidden cause, and whether it has its name.
struct Cause<'a> {
    name: &'a str,
    snr: f64,
    named: bool,
}

fn causes<'a>(scores: &'a [&Score]) -> Vec<Cause<'a>> {
    let of = |score: &'a &Score| {
        let pairs = score.truth.hidden.iter().zip(&score.outcomes);
        pairs.map(|(hidden, outcome)| Cause {
            name: &hidden.name,
            snr: hidden.snr,
            named: *outcome <= Outcome::Later,
        })
    };
    scores.iter().flat_map(of).collect()
}

fn share<'a>(causes: impl Iterator<Item = &'a Cause<'a>>) -> Share {
    causes.fold(Share::default(), |share, cause| Share {
        hits: share.hits + usize::from(cause.named),
        of: share.of + 1,
    })
}

/// Questions asked of recordings of several causes, a line of a table each.
fn answers(scores: &[&Score]) -> Vec<(String, String)> {
    let all = causes(scores);
    let count = |so: &dyn Fn(&Score) -> bool| Share::count(scores.iter().copied(), so).to_string();
    let mut rows = vec![("recordings".to_owned(), scores.len().to_string())];
    for bin in BINS.windows(2) {
        let within = all.iter().filter(|c| (bin[0]..bin[1]).contains(&c.snr));
        let ask = format!(
            "causes named, of an SNR of {:.0} to {:.0}",
            bin[0],
            bin[1].floor()
        );
        rows.push((ask, share(within).to_string()));
    }
    rows.push((
        "recordings of which every cause is named".into(),
        count(&|s| s.outcomes.iter().all(|o| *o <= Outcome::Later)),
    ));
    rows.push((
        "recordings with a sensor cause named that is not there".into(),
        count(&|s| !s.wrong.is_empty()),
    ));
    rows.push((
        "still axes of which a motion is named".into(),
        Share::count(
            scores
                .iter()
                .copied()
                .filter(|s| s.truth.vibration_rad.is_none()),
            |s| !s.motions.is_empty(),
        )
        .to_string(),
    ));
    let mut ratios: Vec<f64> = scores
        .iter()
        .filter_map(|s| s.position.map(|[before, after]| after / before))
        .collect();
    let worse = Share {
        hits: ratios.iter().filter(|ratio| **ratio > WORSE).count(),
        of: ratios.len(),
    };
    rows.push((
        "systematic position error removed, median".into(),
        format!("{:.1} %", 100.0 * (1.0 - median(&mut ratios))),
    ));
    rows.push((
        "positions a tenth worse than by the five parameters, and more".into(),
        worse.to_string(),
    ));
    let summary = Summary::new(scores.iter().copied());
    rows.push((
        "95 % intervals that hold the parameter".into(),
        summary.intervals().to_string(),
    ));
    rows.push((
        "median time of a diagnosis, s".into(),
        format!("{:.2}", summary.seconds()),
    ));
    rows
}

/// The page of a campaign of several causes: on all drives, on reversing ones; each cause; each wrong name with its seed.
#[must_use]
pub fn page_of_many(scores: &[Score]) -> String {
    let all: Vec<&Score> = scores.iter().collect();
    let reversing = all.iter().copied();
    let reversing: Vec<&Score> = reversing.filter(|s| s.truth.drive == "reversing").collect();
    let mut text = format!(
        "Each recording hides {} to {} causes, half of those that have one with another waveform than the textbook's. The SNR is that of \
         a cause alone, beside white noise and motion: what the others hide of it is not in it.\n\n",
        COUNT.start(),
        COUNT.end()
    );
    text += "| | all drives | reversing |\n|---|---|---|\n";
    for ((ask, all), (_, reversing)) in answers(&all).into_iter().zip(answers(&reversing)) {
        let _ = writeln!(text, "| {ask} | {all} | {reversing} |");
    }
    text += "\n## Each cause\n\n| hidden | named |\n|---|---|\n";
    let mut each = BTreeMap::<&str, Vec<Cause>>::new();
    for cause in causes(&all) {
        each.entry(cause.name).or_default().push(cause);
    }
    for (name, causes) in &each {
        let _ = writeln!(text, "| {name} | {} |", share(causes.iter()));
    }
    text += "\n## Sensor causes named that are not there\n\n| seed | hidden (SNR) | named |\n|---|---|---|\n";
    for score in all.iter().filter(|s| !s.wrong.is_empty()) {
        let _ = writeln!(
            text,
            "| {} | {} | {} |",
            score.truth.seed,
            score.truth.listed(),
            score.wrong.join(", ")
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn no_two_of_a_plan_are_alike() {
        let mut random = StdRng::seed_from_u64(1);
        for turn in 0..500 {
            let plan = plan(turn, &mut random);
            assert!(COUNT.contains(&plan.len()));
            for (k, (entry, wild, snr)) in plan.iter().enumerate() {
                assert!(!wild || entry.wild);
                assert!((SNR[0]..=SNR[1]).contains(snr));
                let others = plan[..k].iter().map(|p| p.0.name);
                assert!(others.into_iter().all(|other| !alike(other, entry.name)));
            }
        }
    }

    #[test]
    fn names_of_the_rows_are_of_the_catalogue() {
        for name in ALIKE.iter().flat_map(|row| row.iter()) {
            assert!(CATALOGUE.iter().any(|e| e.name == *name), "{name}");
        }
    }
}
