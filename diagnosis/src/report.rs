//! `report.html`: one file that opens offline. First the finding and the gain; then, for each finding, what shows it, its
//! numbers, what it is confused with and what the chip can do; last what is left.

mod binned;
mod noisy;
mod overview;
mod pictures;
mod raw;
mod residue;
mod spectra;
mod words;

use askama::Template;
use nonius_plot::Plot;
use nonius_recording::Recording;

use crate::diagnose::Diagnosis;
use crate::finding::{Finding, Parameter};
use crate::unseen::unseen;
use residue::Residue;

#[derive(Template)]
#[template(path = "diagnosis.html")]
struct Page<'a> {
    headline: String,
    others: String,
    gain: Gain,
    hash: &'a str,
    version: &'a str,
    found: &'a Diagnosis,
    sections: Vec<Section>,
    figures: Vec<String>,
    residuals: Vec<String>,
    residue: &'a Residue,
    signature: String,
    left: Vec<String>,
    unseen: Vec<String>,
    style: &'static str,
    script: String,
}

/// A number before and after.
struct Gain {
    what: &'static str,
    before: String,
    after: String,
    change: String,
}

struct Section {
    number: usize,
    title: String,
    evidence: String,
    rows: Vec<[String; 3]>,
    gain: Option<Gain>,
    without_gain: &'static str,
    chance: String,
    confused: Vec<(String, &'static str)>,
    chip: &'static str,
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
        None if found.unexplained.significant => {
            format!("No cause can be named: {}", found.unexplained.signature)
        }
        None => "Nothing but the five parameters and white noise".to_owned(),
        Some(first) => {
            let sentence = first.evidence.split("; it raises").next();
            sentence.unwrap_or_default().to_owned()
        }
    };
    let others = match sections.len() {
        0 | 1 => String::new(),
        2 => "One more finding is below.".to_owned(),
        n => format!("{} more findings are below.", n - 1),
    };
    let (simulated, extended) = (&found.simulation, &found.extended);
    let gain = match (
        simulated.position_error_rms_rad,
        extended.position_error_rms_rad,
    ) {
        (Some(before), Some(after)) => angle(before, after),
        _ => residual(
            simulated.held_out_residual_rms,
            extended.held_out_residual_rms,
        ),
    };
    let residue = Residue::of(found);
    Page {
        headline,
        others,
        gain,
        hash,
        version,
        found,
        sections,
        figures: html(overview::figures(found)),
        residuals: html(overview::residuals(found)),
        left: [vec![residue.plot().html()], html(overview::left(found))].concat(),
        residue: &residue,
        signature: words::capital(&found.unexplained.signature),
        unseen: unseen(&found.context),
        style: nonius_plot::STYLE,
        script: nonius_plot::script(),
    }
    .render()
}

fn section(number: usize, finding: &Finding, found: &Diagnosis, recording: &Recording) -> Section {
    let g = &finding.gain;
    let gain = match (
        g.position_error_rms_before_rad,
        g.position_error_rms_after_rad,
    ) {
        (Some(before), Some(after)) => angle(before, after),
        _ => residual(
            g.held_out_residual_rms_before,
            g.held_out_residual_rms_after,
        ),
    };
    let gain = finding.effect.is_some().then_some(gain);
    let confused = finding.confounded_with.iter();
    let plots = pictures::of(finding, found, recording);
    Section {
        number,
        title: words::title(finding),
        evidence: words::capital(&finding.evidence),
        rows: finding.parameters.iter().map(row).collect(),
        gain,
        without_gain: words::without_gain(finding),
        chance: words::chance(finding),
        confused: confused
            .map(|other| {
                let test = words::experiment(&finding.cause, other);
                (words::plain(other), test)
            })
            .collect(),
        chip: words::chip(finding),
        plots: plots.iter().map(Plot::html).collect(),
    }
}

fn angle(before: f64, after: f64) -> Gain {
    Gain {
        what: "Angle error against the reference",
        before: format!("{:.4}°", before.to_degrees()),
        after: format!("{:.4}° rms", after.to_degrees()),
        change: change(before, after),
    }
}

fn residual(before: f64, after: f64) -> Gain {
    Gain {
        what: "Residual on data that was not fitted",
        before: format!("{:.4} %", before * 100.0),
        after: format!("{:.4} % of the amplitude, rms", after * 100.0),
        change: change(before, after),
    }
}

fn change(before: f64, after: f64) -> String {
    let change = 100.0 * (after / before.max(f64::MIN_POSITIVE) - 1.0);
    // Not −0.
    if change.abs() < 0.05 {
        "unchanged".into()
    } else {
        format!(
            "{} {:.1} %",
            if change < 0.0 { '−' } else { '+' },
            change.abs()
        )
    }
}

/// Name, value ± error with two digits of the error, unit.
fn row(p: &Parameter) -> [String; 3] {
    let value = if p.std_error > 0.0 && p.std_error.is_finite() {
        let power = p.value.abs().max(p.std_error).log10().floor();
        let digits = (power - p.std_error.log10().floor() + 1.0).clamp(0.0, 12.0) as usize;
        if (-3.0..6.0).contains(&power) {
            let decimals = (digits as f64 - power).clamp(0.0, 15.0) as usize;
            format!("{:.decimals$} ± {:.decimals$}", p.value, p.std_error)
        } else {
            let scale = 10f64.powf(power);
            let (value, error) = (p.value / scale, p.std_error / scale);
            format!("({value:.digits$} ± {error:.digits$})·10^{power}")
        }
    } else {
        format!("{}", p.value)
    };
    let unit = match p.unit.as_str() {
        "1" => String::new(),
        "amplitude" => "of the amplitude".into(),
        "column" => "as recorded".into(),
        other => other.into(),
    };
    [p.name.replace('_', " "), value, unit]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_their_error_allows() {
        let of = |value: f64, error: f64| {
            row(&Parameter::measured("tau_s", value, error, "s"))[1].clone()
        };
        assert_eq!(of(254.837_12, 0.012_3), "254.837 ± 0.012");
        assert_eq!(of(0.004_012_3, 0.000_031), "0.004012 ± 0.000031");
        assert_eq!(of(-4.012e-7, 3.1e-9), "(-4.012 ± 0.031)·10^-7");
        assert_eq!(of(1.0e-9, 3.1e-7), "(0.0 ± 3.1)·10^-7");
        assert_eq!(of(3.0, 0.0), "3");
    }
}
