//! What a campaign of recordings with several causes says, as a page of Markdown.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::many::COUNT;
use crate::score::{Outcome, Score};
use crate::summary::{Share, Summary, median};
use crate::table::wrong_names;

/// Edges of the bins of SNR.
const BINS: [f64; 5] = [10.0, 20.0, 50.0, 100.0, 301.0];
/// Positions have become worse where their error is so many times that of the five parameters alone.
const WORSE: f64 = 1.1;

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

/// Questions asked of recordings of several causes, a line of a table each.
fn answers(scores: &[&Score]) -> Vec<(String, String)> {
    let all = causes(scores);
    let count = |so: &dyn Fn(&Score) -> bool| Share::count(scores.iter().copied(), so).to_string();
    let mut rows = vec![("recordings".to_owned(), scores.len().to_string())];
    for bin in BINS.windows(2) {
        let within = all.iter().filter(|c| (bin[0]..bin[1]).contains(&c.snr));
        let ask = format!("causes named, of an SNR of {:.0} to {:.0}", bin[0], bin[1]);
        rows.push((ask, Share::count(within, |c| c.named).to_string()));
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
    let worse = Share::count(&ratios, |ratio| *ratio > WORSE);
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
        let _ = writeln!(text, "| {name} | {} |", Share::count(causes, |c| c.named));
    }
    text + &wrong_names(scores)
}
