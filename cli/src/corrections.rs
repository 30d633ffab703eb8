//! What a diagnosis switches on in a design: the corrections that the chip can make.

mod harmonics;

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use nonius_diagnosis::Diagnosis;
use nonius_model::design::{Design, DesignError};
use nonius_model::spec::Spec;
use nonius_quantity::{Quantity, Unit, agree};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, value};

/// Room above the largest bend that was found.
const ROOM: f64 = 1.5;

/// Scale periods of travel that show what calibration on line would find.
const FEWEST: f64 = 2.0;

/// Largest coefficient of T2 or T3 in either channel, as a fraction of the amplitude; `None` if no bend was found.
fn bend(found: &Diagnosis) -> Option<f64> {
    let beta = found.context.ellipse.beta;
    let amounts = found
        .findings
        .iter()
        .filter_map(|f| harmonics::bend(f, beta));
    amounts.reduce(f64::max)
}

/// A bandwidth behind which the completion sees the bend, where the loop of the design is too wide for that and the
/// motion of the recording allows a narrower one.
fn narrower(spec: &Spec, found: &Diagnosis) -> Option<f64> {
    let mut speeds: Vec<f64> = found.context.speed.iter().map(|v| v.abs()).collect();
    speeds.sort_by(f64::total_cmp);
    let usual = speeds.get(speeds.len() / 2)? / TAU;
    let acceleration = found.context.acceleration.iter();
    let most = acceleration.fold(0.0f64, |m, a| m.max(a.abs()));
    // A type 2 loop lags by the acceleration over the square of its bandwidth.
    let lag = TAU * spec.accuracy.rms_periods;
    let needed = (most / lag).sqrt() / TAU;
    let narrow: f64 = format!("{:.2e}", needed.max(2.0 * usual)).parse().ok()?;
    let now = spec.tracking.bandwidth_hz;
    (spec.tracking.filter_type == 2 && now > 4.0 * usual && narrow < now).then_some(narrow)
}

/// A design, or why there cannot be one.
type Designed = std::result::Result<String, DesignError>;

/// The text of a changed design, if a chip can be made of it.
fn designed(document: &DocumentMut) -> Result<Designed> {
    let text = document.to_string();
    let spec = Spec::from_toml(&text, "design.toml")?;
    Ok(Design::new(&spec).map(|_| text))
}

/// The design with the corrections for what was found; a sentence for each that was switched on, or could not be.
///
/// # Errors
/// The text is no TOML: it was read before, so a defect.
pub(crate) fn switch_on(text: &str, found: &Diagnosis) -> Result<(String, Vec<String>)> {
    let (text, mut notes) = correct_skew(text, found)?;
    let (text, more) = correct_bends(&text, found)?;
    notes.extend(more);
    let (text, more) = correct_harmonics(&text, found)?;
    notes.extend(more);
    Ok((text, notes))
}

/// The delay of the sine as it was measured: that of the raw signals, so it takes the place of one that the design had.
fn correct_skew(text: &str, found: &Diagnosis) -> Result<(String, Vec<String>)> {
    let skews = found.findings.iter().filter(|f| f.cause == "channel_skew");
    let delays: Vec<f64> = skews.filter_map(|f| f.parameter("delay_s")).collect();
    if delays.is_empty() {
        return Ok((text.to_owned(), vec![]));
    }
    let delay: f64 = format!("{:.4e}", delays.iter().sum::<f64>()).parse()?;
    let mut document: DocumentMut = text.parse().context("the design is no TOML")?;
    let section = document.entry("correction").or_insert(toml_edit::table());
    section["channel_skew_s"] = value(delay);
    Ok(match designed(&document)? {
        Ok(changed) => {
            let note = format!("design.toml corrects that {}", late(delay));
            (changed, vec![note])
        }
        Err(error) => {
            let note = format!(
                "{}, but the correction of that does not fit the design: {error}",
                late(delay)
            );
            (text.to_owned(), vec![note])
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
fn correct_harmonics(text: &str, found: &Diagnosis) -> Result<(String, Vec<String>)> {
    let spec = Spec::from_toml(text, "design.toml")?;
    let (list, mut notes) = harmonics::table(found, spec.calibration.has_bend());
    if list.is_empty() {
        return Ok((text.to_owned(), notes));
    }
    let mut entries = ArrayOfTables::new();
    for h in &list {
        let mut entry = Table::new();
        entry["order"] = value(i64::from(h.order));
        entry["amplitude_cos"] = value(h.amplitude_cos);
        entry["phase_cos"] = value(h.phase_cos);
        entry["amplitude_sin"] = value(h.amplitude_sin);
        entry["phase_sin"] = value(h.phase_sin);
        entries.push(entry);
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
    section["harmonics"] = Item::ArrayOfTables(entries);
    let orders: Vec<String> = list.iter().map(|h| h.order.to_string()).collect();
    let orders = format!(
        "{} {}",
        agree(list.len(), "order", "orders"),
        orders.join(", ")
    );
    Ok(match designed(&document)? {
        Ok(changed) => {
            notes.push(format!(
                "design.toml corrects harmonics of the scale period by a table: {orders}"
            ));
            (changed, notes)
        }
        Err(error) => {
            notes.push(format!(
                "harmonics were found ({orders}), but a table of them does not fit the design: {error}"
            ));
            (text.to_owned(), notes)
        }
    })
}

/// Nine parameters for channels that bend.
fn correct_bends(text: &str, found: &Diagnosis) -> Result<(String, Vec<String>)> {
    let unchanged = |notes| Ok((text.to_owned(), notes));
    let Some(bend) = bend(found) else {
        return unchanged(vec![]);
    };
    let spec = Spec::from_toml(text, "design.toml")?;
    if spec.calibration.has_bend() || !spec.calibration.is_on() {
        return unchanged(vec![]);
    }
    if spec.sensor.periods_per_revolution == Some(1.0) {
        return unchanged(vec![
            "the channels bend, but a scale period is a revolution: motion at two cycles per revolution would be learnt \
             as a bend, so the design keeps its parameters, and the bend goes into the table of harmonics"
                .into(),
        ]);
    }
    if found.context.periods_travelled() < FEWEST {
        return unchanged(vec![
            "the channels bend, but hardly a scale period was travelled: whether they do elsewhere, and whether a scale \
             period is a revolution, cannot be seen, so the design keeps its parameters, and the bend goes into the table \
             of harmonics"
                .into(),
        ]);
    }
    let mut document: DocumentMut = text.parse().context("the design is no TOML")?;
    document["calibration"]["parameters"] = value(9);
    let bend_max = (ROOM * bend).clamp(0.02, 0.2);
    document["sensor"]["bend_max"] = value(format!("{bend_max:.2e}").parse::<f64>()?);
    let mut notes = vec![];
    if let Some(bandwidth) = narrower(&spec, found) {
        document["loop"]["bandwidth_hz"] = value(bandwidth);
        notes.push(format!(
            "its loop is narrowed to {bandwidth} Hz, twice the usual signal frequency: what a wider loop follows it \
             cannot tell from motion"
        ));
    }
    match designed(&document)? {
        Ok(changed) => {
            notes.push(format!(
                "design.toml calibrates nine parameters now, for the bend of the channels (up to {:.2} %)",
                100.0 * bend
            ));
            Ok((changed, notes))
        }
        Err(error) => unchanged(vec![format!(
            "the channels bend, but nine parameters do not fit the design: {error}"
        )]),
    }
}
