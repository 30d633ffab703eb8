//! `report.html`: one file that opens offline. First the finding and the gain; then, for each finding, what shows it, its
//! numbers, what it is confused with and what the chip can do; last what is left.

mod binned;
mod experiments;
mod gain;
mod jump;
mod noisy;
mod overview;
mod pictures;
mod raw;
mod residue;
mod spectra;
mod words;

use askama::Template;
use nonius_plot::Plot;
use nonius_quantity::{Quantity, Unit, counted, digits};
use nonius_recording::Recording;

use crate::diagnose::Diagnosis;
use crate::finding::names::label;
use crate::finding::{Cause, Finding, Parameter};
use crate::unnamed::unseen::unseen;
use experiments::experiment;
use gain::{Gain, Removed};
use residue::Residue;

#[derive(Template)]
#[template(path = "diagnosis.html")]
struct Page<'a> {
    headline: String,
    /// The other findings, a sentence each.
    others: Vec<String>,
    /// What the gain is of.
    of_what: String,
    gain: Gain,
    about: String,
    hash: &'a str,
    version: &'a str,
    found: &'a Diagnosis,
    sections: Vec<Section>,
    figures: Vec<String>,
    residuals: Vec<String>,
    residue: &'a Residue,
    /// What is not explained, and how likely chance is.
    parts: Vec<String>,
    nothing: String,
    chance: String,
    left: Vec<String>,
    unseen: Vec<String>,
    style: &'static str,
    script: String,
}

struct Section {
    number: usize,
    title: String,
    evidence: String,
    rows: Vec<[String; 3]>,
    gain: Gain,
    snr: Option<f64>,
    chance: String,
    confused: Vec<(String, String)>,
    chip: String,
    plots: Vec<String>,
}

/// Pictures of a diagnosis, as they stand in the report: a name for each, and the plot.
#[must_use]
pub fn plots(found: &Diagnosis, recording: &Recording) -> Vec<(String, Plot)> {
    let mut all: Vec<(String, Plot)> = vec![];
    let mut add = |name: String, plots: Vec<Plot>| {
        let numbered = plots.into_iter().enumerate();
        all.extend(numbered.map(|(i, p)| (format!("{name}-{}", i + 1), p)));
    };
    for (i, finding) in found.findings.iter().enumerate() {
        let name = format!("{}-{}", i + 1, finding.cause);
        add(name, pictures::of(finding, found, recording));
    }
    add("figure".into(), overview::figures(found));
    add("residual".into(), overview::residuals(found));
    add("left".into(), overview::left(found));
    add("residue".into(), vec![Residue::of(found).plot().clone()]);
    all
}

/// The page; `recording` is the one that was diagnosed, `hash` that of its file.
///
/// # Errors
/// Only a defect of the template.
pub fn report(
    found: &Diagnosis,
    recording: &Recording,
    hash: &str,
    version: &str,
) -> Result<String, askama::Error> {
    let html = |plots: Vec<Plot>| plots.iter().map(Plot::html).collect::<Vec<_>>();
    let sections: Vec<Section> = found
        .findings
        .iter()
        .enumerate()
        .map(|(i, finding)| section(i + 1, finding, found, recording))
        .collect();
    let headline = match sections.first() {
        None => words::capital(found.nothing_named()),
        Some(first) => first.evidence.clone(),
    };
    let others = sections.iter().skip(1).map(|s| s.evidence.clone());
    let (of_what, gain) = gain_of_all(found);
    let of_what = if of_what.is_empty() {
        words::capital(gain.what)
    } else {
        format!("{of_what}: {}", gain.what)
    };
    let residue = Residue::of(found);
    Page {
        headline,
        others: others.collect(),
        of_what,
        gain,
        about: about(found, recording),
        hash,
        version,
        found,
        sections,
        figures: html(overview::figures(found)),
        residuals: html(overview::residuals(found)),
        left: [vec![residue.plot().html()], html(overview::left(found))].concat(),
        residue: &residue,
        parts: found
            .unexplained
            .parts
            .iter()
            .map(|p| words::capital(p))
            .collect(),
        nothing: words::capital(&found.unexplained.signature),
        chance: words::probability(found.unexplained.p_value),
        unseen: unseen(found),
        style: nonius_plot::STYLE,
        script: nonius_plot::script(),
    }
    .render()
}

/// What the number at the top is of, and the number: of one finding its own; of several, that of all together, or where
/// they take nothing off the signals that of the first.
fn gain_of_all(found: &Diagnosis) -> (String, Gain) {
    let all = Removed::by_all(found);
    match found.findings.as_slice() {
        [] => (String::new(), all.of_nothing()),
        [one] => (String::new(), Gain::of(one)),
        [first, ..] if !all.changes() => (words::title(first), Gain::of(first)),
        several => (format!("{} findings together", several.len()), all.told()),
    }
}

/// What was recorded.
fn about(found: &Diagnosis, recording: &Recording) -> String {
    let rate = Quantity::new(found.context.rate, 0.0, Unit::Prefixed("Hz")).brief();
    let periods = digits(found.periods_travelled, 3);
    format!(
        "{} at {rate}, {periods} scale {} travelled",
        counted(recording.samples(), "sample"),
        if periods == 1.0 { "period" } else { "periods" }
    )
}

fn section(number: usize, finding: &Finding, found: &Diagnosis, recording: &Recording) -> Section {
    let confused = finding.confounded_with.iter();
    let told = |other: &Cause| (other.plain(), experiment(finding.cause, *other));
    let plots = pictures::of(finding, found, recording);
    let snr = finding.gain.detection_snr;
    Section {
        number,
        title: words::title(finding),
        evidence: words::capital(&finding.evidence),
        rows: finding.parameters.iter().map(row).collect(),
        gain: Gain::of(finding),
        snr: snr.map(|snr| digits(snr, 3)),
        chance: words::chance(finding),
        confused: confused.map(told).collect(),
        chip: words::chip(finding),
        plots: plots.iter().map(Plot::html).collect(),
    }
}

/// Label, value ± error, unit.
fn row(p: &Parameter) -> [String; 3] {
    let (value, unit) = p.apart();
    [label(&p.name), value, unit]
}
