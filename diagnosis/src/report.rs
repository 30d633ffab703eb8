//! `report.html`: one file that opens offline, the finding and the gain first.

use std::fmt::Write;

use askama::Template;

use crate::diagnose::Diagnosis;
use crate::finding::{Chip, Finding};

/// Points of a plot at most.
const POINTS: usize = 3000;

#[derive(Template)]
#[template(path = "diagnosis.html")]
struct Page<'a> {
    headline: String,
    gain: String,
    hash: &'a str,
    version: &'a str,
    found: &'a Diagnosis,
    sections: Vec<Section<'a>>,
    lissajous: String,
    before: String,
    after: String,
    spectrum: String,
}

struct Section<'a> {
    finding: &'a Finding,
    title: String,
    chip: &'static str,
}

/// The page.
///
/// # Errors
/// Only a defect of the template.
pub fn report(found: &Diagnosis, hash: &str, version: &str) -> Result<String, askama::Error> {
    let mut named: Vec<String> = vec![];
    for finding in &found.findings {
        let name = finding.cause.replace('_', " ");
        if !named.contains(&name) {
            named.push(name);
        }
    }
    let headline = match named.as_slice() {
        [] => "Nothing but the five parameters and white noise".to_owned(),
        [one] => format!("Found: {one}"),
        many => format!("Found: {}", many.join(", ")),
    };
    let (simulated, extended) = (&found.simulation, &found.extended);
    let gain = match (
        simulated.position_error_rms_rad,
        extended.position_error_rms_rad,
    ) {
        (Some(before), Some(after)) => format!(
            "angle error against the reference {:.4}° → {:.4}° rms",
            before.to_degrees(),
            after.to_degrees()
        ),
        _ => format!(
            "residual on held-out data {:.3} % → {:.3} % of the amplitude",
            simulated.held_out_residual_rms * 100.0,
            extended.held_out_residual_rms * 100.0
        ),
    };
    let sections = found
        .findings
        .iter()
        .map(|finding| Section {
            finding,
            title: finding.cause.replace('_', " "),
            chip: match finding.chip {
                Chip::Corrects => "The chip corrects it.",
                Chip::CannotCorrect => "The chip cannot correct it.",
                Chip::NotASensorError => "It is real motion, not an error of the sensor.",
            },
        })
        .collect();
    let angle: Vec<f64> = found
        .context
        .alpha
        .iter()
        .map(|a| a.rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU)
        .collect();
    let [before, after] = &found.residuals;
    let limit = before
        .0
        .iter()
        .chain(&before.1)
        .fold(1e-9f64, |m, v| m.max(v.abs()));
    Page {
        headline,
        gain,
        hash,
        version,
        lissajous: lissajous(found),
        before: scatter(
            &angle,
            before,
            limit,
            "Residual of the simulation against the angle",
        ),
        after: scatter(
            &angle,
            after,
            limit,
            "Residual of the extended model against the angle",
        ),
        spectrum: spectra(found),
        found,
        sections,
    }
    .render()
}

/// Raw figure about its centre, the radial error ten times as large.
fn lissajous(found: &Diagnosis) -> String {
    let context = &found.context;
    let every = context.samples().div_ceil(POINTS);
    let mut svg = String::from(
        r#"<svg viewBox="0 0 360 360" role="img" aria-label="Corrected signals, radial error ten times as large"><circle class="round" cx="180" cy="180" r="130"/>"#,
    );
    let left = &found.residuals[0].0;
    for (k, radial) in left.iter().enumerate().step_by(every) {
        let r = 130.0 * (1.0 + 10.0 * radial).clamp(0.0, 1.38);
        let (x, y) = (180.0 + r * context.cos[k], 180.0 - r * context.sin[k]);
        let _ = write!(
            svg,
            r#"<circle class="r" cx="{x:.1}" cy="{y:.1}" r="1.1"/>"#
        );
    }
    svg + r#"<text x="180" y="350" text-anchor="middle">radial error × 10</text></svg>"#
}

fn scatter(angle: &[f64], residual: &(Vec<f64>, Vec<f64>), limit: f64, label: &str) -> String {
    let (left, right, top, bottom) = (58.0, 630.0, 10.0, 190.0);
    let y = |v: f64| top + (0.5 - 0.5 * v / limit) * (bottom - top);
    let mut svg = format!(r#"<svg viewBox="0 0 640 230" role="img" aria-label="{label}">"#);
    for share in [-1.0, 0.0, 1.0] {
        let at = y(share * limit);
        let _ = write!(
            svg,
            r#"<line class="grid" x1="{left}" x2="{right}" y1="{at:.1}" y2="{at:.1}"/><text x="{}" y="{:.1}" text-anchor="end">{:.2} %</text>"#,
            left - 6.0,
            at + 4.0,
            share * limit * 100.0
        );
    }
    for turn in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let at = left + turn * (right - left);
        let _ = write!(
            svg,
            r#"<line class="grid" x1="{at:.1}" x2="{at:.1}" y1="{top}" y2="{bottom}"/><text x="{at:.1}" y="{}" text-anchor="middle">{turn}</text>"#,
            bottom + 18.0
        );
    }
    let every = angle.len().div_ceil(POINTS / 2);
    for (class, values) in [("r", &residual.0), ("t", &residual.1)] {
        for k in (0..angle.len()).step_by(every) {
            let x = left + angle[k] * (right - left);
            let _ = write!(
                svg,
                r#"<circle class="{class}" cx="{x:.1}" cy="{:.1}" r="1.2"/>"#,
                y(values[k].clamp(-limit, limit))
            );
        }
    }
    svg + r#"<text x="344" y="226" text-anchor="middle">angle in scale periods</text></svg>"#
}

/// Spectra of the residual before and after, radial and tangential together.
fn spectra(found: &Diagnosis) -> String {
    let (left, right, top, bottom) = (58.0, 630.0, 10.0, 190.0);
    let [before, after] = &found.residuals;
    let rate = found.context.rate;
    let levels = |r: &(Vec<f64>, Vec<f64>)| -> Vec<f64> {
        let (power, _) = crate::lines::pair_spectrum(&r.0, &r.1);
        let bins = 560;
        let per = power.len().div_ceil(bins).max(1);
        power
            .chunks(per)
            .map(|c| 5.0 * c.iter().copied().fold(1e-300, f64::max).log10() * 2.0)
            .collect()
    };
    let (a, b) = (levels(before), levels(after));
    let high = a.iter().chain(&b).copied().fold(f64::MIN, f64::max);
    let y = |v: f64| top + (high - v).clamp(0.0, 70.0) / 70.0 * (bottom - top);
    let line = |v: &[f64], class: &str| {
        let points: Vec<String> = v
            .iter()
            .enumerate()
            .map(|(i, v)| {
                let x = left + (right - left) * i as f64 / v_len(a.len());
                format!("{x:.1},{:.1}", y(*v))
            })
            .collect();
        format!(
            r#"<polyline class="{class}" points="{}"/>"#,
            points.join(" ")
        )
    };
    let mut svg = String::from(
        r#"<svg viewBox="0 0 640 230" role="img" aria-label="Spectrum of the residual before and after">"#,
    );
    for db in [0.0, -20.0, -40.0, -60.0] {
        let at = y(high + db);
        let _ = write!(
            svg,
            r#"<line class="grid" x1="{left}" x2="{right}" y1="{at:.1}" y2="{at:.1}"/><text x="{}" y="{:.1}" text-anchor="end">{db} dB</text>"#,
            left - 6.0,
            at + 4.0
        );
    }
    for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let at = left + share * (right - left);
        let _ = write!(
            svg,
            r#"<text x="{at:.1}" y="{}" text-anchor="middle">{:.4}</text>"#,
            bottom + 18.0,
            share * rate / 2.0
        );
    }
    svg += &line(&a, "was");
    svg += &line(&b, "is");
    svg + r#"<text x="344" y="226" text-anchor="middle">frequency, Hz</text></svg>"#
}

fn v_len(n: usize) -> f64 {
    n.max(2) as f64 - 1.0
}
