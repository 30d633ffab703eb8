//! What a diagnosis switches on in a design: the corrections that the chip can make.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use anyhow::{Context, Result};
use nonius_diagnosis::Diagnosis;
use nonius_model::design::{Design, DesignError};
use nonius_model::spec::Spec;
use toml_edit::{DocumentMut, value};

/// Room above the largest bend that was found.
const ROOM: f64 = 1.5;

/// Phase by which a harmonic may miss that of a bend, radians.
const PHASE: f64 = 0.3;

/// Largest coefficient of T2 or T3 in either channel, as a fraction of the amplitude; `None` if no bend was found. A
/// harmonic of order 2 or 3 is a bend where its phase is that of the channel's power: the chip mends both alike.
fn bend(found: &Diagnosis) -> Option<f64> {
    let amounts = found.findings.iter().filter_map(|f| {
        let of = |name: &str| {
            f.parameters
                .iter()
                .find(|p| p.name == name)
                .map(|p| p.value)
        };
        let largest = |a: Option<f64>, b: Option<f64>| Some(a?.abs().max(b?.abs()));
        match f.cause.as_str() {
            // u² = (1 + T2)/2 and u³ = (3 u + T3)/4.
            "even_nonlinearity" => Some(largest(of("k_cos"), of("k_sin"))? / 2.0),
            "odd_nonlinearity" => Some(largest(of("k_cos"), of("k_sin"))? / 4.0),
            "spatial_harmonic" => {
                let order = of("order")?;
                let beta = found.context.ellipse.beta;
                // T2(sin) and T3(sin) are -cos 2 and -sin 3 of the angle less the phase error.
                let sine = if order == 3.0 { FRAC_PI_2 } else { 0.0 } - order * beta;
                let fits = |amplitude: f64, phase: f64, of_bend: f64| {
                    let off = phase - of_bend;
                    let off = off - PI * (off / PI).round();
                    (off.abs() < PHASE).then_some(amplitude)
                };
                if order != 2.0 && order != 3.0 {
                    return None;
                }
                let cos = fits(of("amplitude_cos")?, of("phase_cos")?, 0.0);
                let sin = fits(of("amplitude_sin")?, of("phase_sin")?, sine);
                largest(cos, sin)
            }
            _ => None,
        }
    });
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
            let note = format!(
                "design.toml corrects a sine that is sampled {delay:e} s later than the cosine"
            );
            (changed, vec![note])
        }
        Err(error) => {
            let note = format!(
                "the sine is sampled {delay:e} s later, but its correction does not fit the design: {error}"
            );
            (text.to_owned(), vec![note])
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
    if spec.calibration.parameters >= 8 || spec.calibration.parameters == 0 {
        return unchanged(vec![]);
    }
    if spec.sensor.periods_per_revolution == Some(1.0) {
        return unchanged(vec![
            "the channels bend, but a scale period is a revolution: motion at two cycles per revolution would be learnt \
             as a bend, so the design keeps its parameters"
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
