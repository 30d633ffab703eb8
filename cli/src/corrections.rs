//! What a diagnosis switches on in a design: the corrections that the chip can make.

mod harmonics;
mod outcome;

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use nonius_diagnosis::{Cause, Chip, Diagnosis};
use nonius_model::design::{Design, DesignError};
use nonius_model::spec::{Calibration, Spec};
use nonius_quantity::{Quantity, Unit, agree, digits};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

pub(crate) use outcome::Outcome;

/// Room above the largest bend that was found.
const ROOM: f64 = 1.5;

/// Scale periods of travel that show what calibration on line would find.
const FEWEST: f64 = 2.0;

/// The findings that are bends, and the largest coefficient of T2 or T3 in either channel, as a fraction of the amplitude.
fn bends(found: &Diagnosis) -> (Vec<usize>, f64) {
    let beta = found.context.ellipse.beta;
    let all = found.findings.iter().enumerate();
    let (which, amounts): (Vec<usize>, Vec<f64>) = all
        .filter_map(|(k, f)| Some((k, harmonics::bend(f, beta)?)))
        .unzip();
    (which, amounts.into_iter().fold(0.0, f64::max))
}

/// Whether the axis of the recording is ever so slow that the chip learns bends.
fn learns_bends(spec: &Spec, found: &Diagnosis) -> bool {
    /// Share of the samples.
    const SOME: f64 = 0.02;
    let limit = TAU * Calibration::BEND_RATE * spec.adc.sample_rate_hz;
    let speeds = &found.context.speed;
    let slow = speeds.iter().filter(|speed| speed.abs() < limit).count();
    slow as f64 > SOME * speeds.len() as f64
}

/// What the completion, which learns the bends of third order, sees of the motion of a recording behind a loop.
struct Behind {
    /// Median signal frequency, Hz.
    usual: f64,
    /// Bandwidth of the loop that the acceleration of the axis needs, or signals of that frequency, Hz.
    needed: f64,
    /// The loop is narrowed to that: it is too wide, and the motion allows it.
    narrows: bool,
    /// Bandwidth of the loop as it was designed, Hz.
    designed: f64,
}

impl Behind {
    /// So many times the usual signal frequency, behind a wider loop the completion would take more than a thousand periods, or rest.
    const WIDEST: f64 = 4.0;
    /// So many times that is narrow enough.
    const ENOUGH: f64 = 2.0;

    fn of(spec: &Spec, found: &Diagnosis) -> Self {
        let mut speeds: Vec<f64> = found.context.speed.iter().map(|v| v.abs()).collect();
        speeds.sort_by(f64::total_cmp);
        let usual = speeds.get(speeds.len() / 2).map_or(0.0, |v| v / TAU);
        let acceleration = found.context.acceleration.iter();
        let most = acceleration.fold(0.0f64, |m, a| m.max(a.abs()));
        // A type 2 loop lags by the acceleration over the square of its bandwidth.
        let lag = TAU * spec.accuracy.rms_periods;
        let needed = (most / lag).sqrt() / TAU;
        let needed = digits(needed.max(Self::ENOUGH * usual), 3);
        let designed = spec.tracking.bandwidth_hz;
        let too_wide = designed > Self::WIDEST * usual;
        Self {
            usual,
            needed,
            narrows: spec.tracking.filter_type == 2 && too_wide && needed < designed,
            designed,
        }
    }

    fn sees(&self) -> bool {
        let bandwidth = if self.narrows {
            self.needed
        } else {
            self.designed
        };
        bandwidth <= Self::WIDEST * self.usual
    }
}

/// A design, or why there cannot be one.
type Designed = std::result::Result<String, DesignError>;

/// The text of a changed design, if a chip can be made of it.
fn designed(document: &DocumentMut) -> Result<Designed> {
    let text = document.to_string();
    let spec = Spec::from_toml(&text, "design.toml")?;
    Ok(Design::new(&spec).map(|_| text))
}

/// The design with the corrections for what was found; what was switched on, or could not be.
///
/// # Errors
/// The text is no TOML: it was read before, so a defect.
pub(crate) fn switch_on(text: &str, found: &Diagnosis) -> Result<(String, Vec<Outcome>)> {
    let mut outcomes = followed(text, found)?;
    let mut text = text.to_owned();
    for correct in [correct_skew, correct_bends, correct_harmonics] {
        let (changed, more) = correct(&text, found)?;
        text = changed;
        outcomes.extend(more);
    }
    Ok((text, outcomes))
}

/// What says that there is no design, of all findings that one could correct.
pub(crate) fn without_design(found: &Diagnosis, why: &anyhow::Error) -> Outcome {
    let all = found.findings.iter().enumerate();
    let could = all.filter(|(_, f)| f.chip == Chip::Corrects);
    Outcome::said(
        format!("no design.toml: {why:#}"),
        could.map(|(k, _)| k).collect(),
    )
}

/// The findings of these causes.
fn of(found: &Diagnosis, causes: &[Cause]) -> Vec<usize> {
    let all = found.findings.iter().enumerate();
    let named = all.filter(|(_, f)| causes.contains(&f.cause));
    named.map(|(k, _)| k).collect()
}

/// A drift is followed by the calibration on line, where there is one.
fn followed(text: &str, found: &Diagnosis) -> Result<Vec<Outcome>> {
    let drifts = of(found, &[Cause::OffsetDrift, Cause::GainDrift]);
    let calibration = Spec::from_toml(text, "design.toml")?.calibration;
    if drifts.is_empty() || calibration.is_on() {
        return Ok(vec![]);
    }
    let sentence = "the calibration of design.toml is off, so nothing follows the drift";
    Ok(vec![Outcome::impossible(sentence.into(), drifts)])
}

/// The delay of the sine as it was measured: that of the raw signals, so it takes the place of one that the design had.
fn correct_skew(text: &str, found: &Diagnosis) -> Result<(String, Vec<Outcome>)> {
    let skews = of(found, &[Cause::ChannelSkew]);
    let delay = |&k: &usize| found.findings[k].parameter("delay_s");
    let delays: Vec<f64> = skews.iter().filter_map(delay).collect();
    if delays.is_empty() {
        return Ok((text.to_owned(), vec![]));
    }
    let delay = digits(delays.iter().sum(), 5);
    let mut document: DocumentMut = text.parse().context("the design is no TOML")?;
    let section = document.entry("correction").or_insert(toml_edit::table());
    section["channel_skew_s"] = value(delay);
    Ok(match designed(&document)? {
        Ok(changed) => {
            let note = format!("design.toml corrects that {}", late(delay));
            (changed, vec![Outcome::said(note, skews)])
        }
        Err(error) => {
            let note = format!(
                "{}, but the correction of that does not fit the design: {error}",
                late(delay)
            );
            (text.to_owned(), vec![Outcome::impossible(note, skews)])
        }
    })
}

/// Which channel is sampled later, by how much.
fn late(delay: f64) -> String {
    let [first, second] = if delay < 0.0 {
        ["sin", "cos"]
    } else {
        ["cos", "sin"]
    };
    let delay = Quantity::new(delay.abs(), 0.0, Unit::Small("s")).brief();
    format!("{second} is sampled {delay} after {first}")
}

/// The table of harmonics, for what no parameter on line mends. Those that were measured are of the raw signals, so they take
/// the place of what the design had.
fn correct_harmonics(text: &str, found: &Diagnosis) -> Result<(String, Vec<Outcome>)> {
    let spec = Spec::from_toml(text, "design.toml")?;
    let harmonics::Harmonics {
        entries,
        findings,
        left_out: mut outcomes,
    } = harmonics::table(found, spec.calibration.has_bend());
    if entries.is_empty() {
        return Ok((text.to_owned(), outcomes));
    }
    let mut tables = ArrayOfTables::new();
    for h in &entries {
        let mut entry = Table::new();
        entry["order"] = value(i64::from(h.order));
        entry["amplitude_cos"] = value(h.amplitude_cos);
        entry["phase_cos"] = value(h.phase_cos);
        entry["amplitude_sin"] = value(h.amplitude_sin);
        entry["phase_sin"] = value(h.phase_sin);
        tables.push(entry);
    }
    let mut document: DocumentMut = text.parse().context("the design is no TOML")?;
    let section = document.entry("correction").or_insert_with(|| {
        let mut section = Table::new();
        section.set_implicit(true);
        Item::Table(section)
    });
    if let Some(inline) = section.as_inline_table().cloned() {
        *section = Item::Table(inline.into_table());
    }
    if let Some(table) = section.as_table_mut() {
        table.set_dotted(false);
    }
    section["harmonics"] = Item::ArrayOfTables(tables);
    let orders: Vec<String> = entries.iter().map(|h| h.order.to_string()).collect();
    let orders = format!(
        "{} {}",
        agree(entries.len(), "order", "orders"),
        orders.join(", ")
    );
    Ok(match designed(&document)? {
        Ok(changed) => {
            let note =
                format!("design.toml corrects harmonics of the scale period by a table: {orders}");
            outcomes.push(Outcome::said(note, findings));
            (changed, outcomes)
        }
        Err(error) => {
            let note = format!(
                "harmonics were found ({orders}), but a table of them does not fit the design: {error}"
            );
            outcomes.push(Outcome::impossible(note, findings));
            (text.to_owned(), outcomes)
        }
    })
}

/// Nine parameters for channels that bend.
fn correct_bends(text: &str, found: &Diagnosis) -> Result<(String, Vec<Outcome>)> {
    let (which, bend) = bends(found);
    let said = |note: String| vec![Outcome::said(note, which.clone())];
    let unchanged = |note: String| Ok((text.to_owned(), said(note)));
    let spec = Spec::from_toml(text, "design.toml")?;
    if which.is_empty() || !spec.calibration.is_on() {
        return Ok((text.to_owned(), vec![]));
    }
    if spec.calibration.has_bend() {
        return unchanged("design.toml calibrates bends already".into());
    }
    if spec.sensor.periods_per_revolution == Some(1.0) {
        return unchanged(
            "the channels bend, but a scale period is a revolution: motion at two cycles per revolution would be learnt \
             as a bend, so the design keeps its parameters"
                .into(),
        );
    }
    if found.context.periods_travelled() < FEWEST {
        return unchanged(
            "the channels bend, but hardly a scale period was travelled: whether they do elsewhere, and whether a scale \
             period is a revolution, cannot be seen, so the design keeps its parameters"
                .into(),
        );
    }
    if !learns_bends(&spec, found) {
        let fewest = 1.0 / Calibration::BEND_RATE;
        return unchanged(format!(
            "the channels bend, but hardly ever has a scale period {fewest:.1} samples or more at the sample rate of the design, and with fewer the \
             chip does not learn bends, so the design keeps its parameters"
        ));
    }
    let behind = Behind::of(&spec, found);
    let cubic = which
        .iter()
        .any(|k| harmonics::is_of_third_order(&found.findings[*k]));
    if cubic && !behind.sees() {
        let (has, hertz) = match spec.tracking.filter_type {
            2 => ("needs, where the axis accelerates as here,", behind.needed),
            _ => ("has", digits(behind.designed, 3)),
        };
        return unchanged(format!(
            "the channels bend by the third order, which the chip learns well where the bandwidth of its loop is up to {} times the signal \
             frequency; here the signals have {} Hz, usually, and the loop {has} {hertz} Hz, so the design keeps its parameters",
            Behind::WIDEST,
            digits(behind.usual, 2),
        ));
    }
    let mut document: DocumentMut = text.parse().context("the design is no TOML")?;
    document["calibration"]["parameters"] = value(9);
    let bend_max = (ROOM * bend).clamp(0.02, 0.2);
    document["sensor"]["bend_max"] = value(digits(bend_max, 3));
    let mut narrowed = vec![];
    if behind.narrows {
        document["loop"]["bandwidth_hz"] = value(behind.needed);
        narrowed = said(format!(
            "its loop is narrowed to {} Hz, for signals that have {} Hz, usually: what a wider loop follows it \
             cannot tell from motion",
            behind.needed,
            digits(behind.usual, 2)
        ));
    }
    match designed(&document)? {
        Ok(changed) => {
            let mut outcomes = said(format!(
                "design.toml calibrates nine parameters now, for the bend of the channels (up to {:.2} %)",
                100.0 * bend
            ));
            outcomes.extend(narrowed);
            Ok((changed, outcomes))
        }
        // The table of harmonics may hold it then.
        Err(error) => unchanged(format!(
            "the channels bend, but nine parameters do not fit the design: {error}"
        )),
    }
}
