//! Titles, what the chip can do, how likely chance is.

use crate::finding::{Cause, Chip, Finding, OTHER_ORDER};

/// The title of a finding: its name and what tells it from others of that name.
pub(super) fn title(finding: &Finding) -> String {
    let name = finding.plain_name();
    let own = |name: &str| finding.parameters.iter().find(|p| p.name == name);
    let hertz = own("frequency_hz").map(|f| format!("{name}, {}", f.brief()));
    let number = |what: &str| own(what).map(|n| format!("{name}, {what} {}", n.value));
    let order = || number("order").or_else(|| number("bit"));
    capital(&hertz.or_else(order).unwrap_or_else(|| name.clone()))
}

/// A sentence with a capital letter at its beginning.
pub(super) fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// What the chip can do about it, and what `design.toml` does.
pub(super) fn chip(finding: &Finding) -> String {
    let mut said = able(finding).to_owned();
    for sentence in &finding.design {
        // A file's name stays as it is.
        let begins = sentence.split(' ').next().unwrap_or_default();
        let sentence = if begins.contains('.') {
            sentence.clone()
        } else {
            capital(sentence)
        };
        let end = if sentence.ends_with('.') { "" } else { "." };
        said += &format!(" {sentence}{end}");
    }
    said
}

/// What the chip can do about it.
fn able(finding: &Finding) -> &'static str {
    let order = finding.parameter("order");
    match (finding.chip, finding.cause) {
        (Chip::Corrects, Cause::EvenNonlinearity | Cause::OddNonlinearity) => {
            "The chip corrects it with nine parameters on line, or from its table of harmonics where a scale period is a revolution."
        }
        (Chip::Corrects, Cause::SpatialHarmonic) if finding.parameter(OTHER_ORDER).is_some() => {
            "The chip can correct it from its table of harmonics once its order is known; by the wrong one the angle would be twice as wrong. A reference tells, or a speed at which the motion is smoother than this."
        }
        (Chip::Corrects, Cause::SpatialHarmonic) if order == Some(2.0) || order == Some(3.0) => {
            "The chip corrects it: with nine parameters on line where it is a bend of the channels, else from its table of harmonics."
        }
        (Chip::Corrects, Cause::SpatialHarmonic | Cause::GraduationError) => {
            "The chip corrects it from its table of harmonics."
        }
        (Chip::Corrects, Cause::ChannelSkew) => {
            "The chip corrects it: it turns the sine back by the speed times this delay."
        }
        (Chip::Corrects, Cause::OffsetDrift | Cause::GainDrift) => {
            "The chip corrects it: the calibration on line follows it."
        }
        (Chip::Corrects, _) => "The chip corrects it.",
        (Chip::CannotCorrect, Cause::Latency) => {
            "The chip cannot correct it. Behind the chip: add the speed times this delay to the position."
        }
        (Chip::CannotCorrect, _) if !finding.design.is_empty() => {
            "The chip of this design does not correct it."
        }
        (Chip::CannotCorrect, Cause::EvenNonlinearity | Cause::OddNonlinearity) => {
            "The chip corrects bends, but what this one does along the circle the motion hides, and a correction may be the opposite. A reference tells, or a speed at which the motion is smoother than this."
        }
        (Chip::CannotCorrect, _) => "The chip cannot correct it; mend it in front of the ADC.",
        (Chip::NotASensorError, _) if !finding.confounded_with.is_empty() => {
            "If it is real motion, the position shows it, and should; the chip corrects nothing before that is known."
        }
        (Chip::NotASensorError, _) => {
            "It is real motion, not an error of the sensor: the position shows it, and should."
        }
    }
}

/// A probability, as far as it can be told from zero.
pub(super) fn probability(p: f64) -> String {
    const LEAST: i32 = -300;
    let power = p.max(f64::MIN_POSITIVE).log10().floor() as i32;
    match power {
        _ if p >= 0.01 => format!("p = {p:.2}"),
        ..LEAST => format!("p < 10{}", superscript(LEAST)),
        power => format!(
            "p = {:.1} · 10{}",
            p / 10f64.powi(power),
            superscript(power)
        ),
    }
}

/// An exponent.
fn superscript(power: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digit = |c: char| c.to_digit(10).map_or('⁻', |d| DIGITS[d as usize]);
    power.to_string().chars().map(digit).collect()
}

/// A probability after all trials.
pub(super) fn chance(finding: &Finding) -> String {
    match finding.p_value {
        _ if finding.place.is_some() => "ruled out: the data themselves show it".into(),
        p => format!("{} after all trials", probability(p)),
    }
}
