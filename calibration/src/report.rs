//! A calibration to be read: statistics, parameters ± error, correlations of both kinds, remarks.

use std::fmt::Write;

use crate::result::{Calibration, Correlations, Parameter, RatioSource};

/// Correlations below this are not worth a line.
const CORRELATED: f64 = 0.1;
/// Width of a line of prose.
const WIDTH: usize = 110;

/// The report. `lsb` is one step of each channel's ADC in the unit of the columns, where it is known.
#[must_use]
pub fn report(found: &Calibration, lsb: Option<[f64; 2]>) -> String {
    let mut out = String::new();
    statistics(&mut out, found, lsb);
    let _ = writeln!(out, "[[Parameters]]");
    for p in &found.parameters {
        parameter(&mut out, p);
    }
    correlations(&mut out, found, "Correlations", (&found.correlations, 0));
    let first = found.parameters.len() - found.theta.len();
    let of_theta = (&found.theta_correlations, first);
    correlations(&mut out, found, "Correlations of Theta", of_theta);
    sentences(&mut out, "What the data cannot tell", &found.cannot_tell);
    sentences(&mut out, "Remarks", &found.remarks);
    out
}

fn statistics(out: &mut String, found: &Calibration, lsb: Option<[f64; 2]>) {
    let _ = writeln!(out, "[[Statistics]]");
    let mut line = |name: &str, value: String| {
        let _ = writeln!(out, "    {name:<16} = {value}");
    };
    line("method", found.method.name().into());
    line(
        "samples",
        match found.outliers {
            0 => found.samples.to_string(),
            n => format!("{}, {n} of them left out", found.samples),
        },
    );
    line("arc", format!("{:.2} of the scale period", found.arc));
    line(
        "residual rms",
        format!("{:.4e} of the amplitude", found.residual_rms),
    );
    if let Some([c, s]) = found.noise {
        line(
            "noise",
            format!("{c:.4e} (cos), {s:.4e} (sin), rms in the unit of the columns"),
        );
        let ratio = s / c;
        let error = match found.noise_ratio_error {
            Some(e) => format!("{ratio:.3} +/- {e:.3} (sin to cos, estimated)"),
            None if found.noise_ratio_extreme => {
                format!("{ratio:.3} (sin to cos, estimated, too far from 1 to be measured)")
            }
            None if found.noise_ratio_source == RatioSource::Given => {
                format!("{ratio:.3} (sin to cos, given)")
            }
            None => format!("{ratio:.3} (sin to cos, assumed)"),
        };
        line("noise ratio", error);
        if let Some(lsb) = lsb {
            let [c, s] = lsb.map(|l| l / 12f64.sqrt());
            line(
                "ADC rounding",
                format!("{c:.4e} (cos), {s:.4e} (sin), part of the noise"),
            );
        }
    }
    if let Some(shape) = &found.shape {
        let text = format!(
            "{:.4e} of the amplitude rms, most at order {}",
            shape.rms, shape.order
        );
        line("distortion", text);
    }
    if let Some(bound) = &found.bound {
        line(
            "angle, bound",
            format!(
                "{:.2e} rad rms by the parameters, {:.2e} rad rms by the noise of one sample",
                bound.angle_by_parameters, bound.angle_by_noise
            ),
        );
    }
}

fn parameter(out: &mut String, p: &Parameter) {
    let error = match p.std_error {
        Some(e) if p.value != 0.0 => format!("+/- {e:.3e} ({:.3} %)", (e / p.value).abs() * 100.0),
        Some(e) => format!("+/- {e:.3e}"),
        None => "+/- not known".into(),
    };
    let bound = p.bound.map_or_else(String::new, |bound| match p.std_error {
        Some(e) => format!("bound {bound:.3e} (x {:.2})", e / bound),
        None => format!("bound {bound:.3e}"),
    });
    let unit = match p.unit.as_str() {
        "column" | "1" => "",
        "rad" => &format!("rad ({:.4} deg)", p.value.to_degrees()),
        other => other,
    };
    let value = number(p.value);
    let text = format!(
        "    {:<8} {value:>14} {error:<28} {bound:<27} {unit}",
        p.name
    );
    let _ = writeln!(out, "{}", text.trim_end());
}

/// Nine figures, whatever the size.
fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-3..1e5).contains(&size) {
        format!("{value:.6e}")
    } else {
        format!("{value:.8}")
    }
}

/// Those of the parameters from `first` on.
fn correlations(
    out: &mut String,
    found: &Calibration,
    title: &str,
    (all, first): (&Option<Correlations>, usize),
) {
    let Some(all) = all else {
        return;
    };
    if all.iter().flatten().all(Option::is_none) {
        return;
    }
    let mut pairs = vec![];
    for (i, row) in all.iter().enumerate() {
        pairs.extend(
            row.iter()
                .take(i)
                .enumerate()
                .filter_map(|(j, value)| Some(((*value)?, j, i))),
        );
    }
    pairs.retain(|(value, ..)| value.abs() > CORRELATED);
    pairs.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let _ = writeln!(out, "[[{title}]] (beyond {CORRELATED})");
    for (value, j, i) in pairs {
        let [first, second] = [j, i].map(|k| &found.parameters[first + k].name);
        let _ = writeln!(out, "    C({first}, {second}) = {value:+.3}");
    }
}

fn sentences(out: &mut String, title: &str, all: &[String]) {
    if all.is_empty() {
        return;
    }
    let _ = writeln!(out, "[[{title}]]");
    for sentence in all {
        let mut line = String::from("    -");
        for word in sentence.split(' ') {
            if line.chars().count() + 1 + word.chars().count() > WIDTH {
                let _ = writeln!(out, "{line}");
                line = "     ".into();
            }
            line.push(' ');
            line.push_str(word);
        }
        let _ = writeln!(out, "{line}");
    }
}
