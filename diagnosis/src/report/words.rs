//! Titles, and which experiment would tell two causes apart.

use crate::finding::{Chip, Finding};

/// Where a cause lives, for the choice of an experiment.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Home {
    Period,
    Code,
    Speed,
    Time,
    Line,
    Revolution,
    Motion,
    Noise,
}

fn home(cause: &str) -> Home {
    match cause {
        "adc_nonlinearity" | "stuck_bit" | "coarse_quantisation" => Home::Code,
        "channel_skew" | "bandwidth_mismatch" | "common_bandwidth" | "latency"
        | "delayed_crosstalk" | "hysteresis" | "ac_coupling" => Home::Speed,
        "offset_drift" | "gain_drift" => Home::Time,
        "interference" | "amplitude_ripple" => Home::Line,
        "runout" | "contamination" | "graduation_error" => Home::Revolution,
        "vibration" | "cogging" => Home::Motion,
        "clock_jitter" | "flicker_noise" | "amplitude_noise" | "glitches" | "dropped_samples"
        | "repeated_samples" => Home::Noise,
        _ => Home::Period,
    }
}

/// A name as a person writes it.
pub(super) fn plain(cause: &str) -> String {
    match cause {
        "adc_nonlinearity" => "ADC nonlinearity".into(),
        "ac_coupling" => "AC coupling".into(),
        _ => cause.replace('_', " "),
    }
}

/// The title of a finding: its name and what tells it from others of that name.
pub(super) fn title(finding: &Finding) -> String {
    let name = plain(&finding.cause);
    let hertz = finding
        .parameter("frequency_hz")
        .map(|f| format!("{name}, {f:.2} Hz"));
    let order = || {
        finding
            .parameter("order")
            .map(|o| format!("{name}, order {o}"))
    };
    capital(&hertz.or_else(order).unwrap_or(name))
}

/// A sentence with a capital letter at its beginning.
pub(super) fn capital(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// What the chip can do about it.
pub(super) fn chip(finding: &Finding) -> &'static str {
    let order = finding.parameter("order");
    match (finding.chip, finding.cause.as_str()) {
        (Chip::Corrects, "even_nonlinearity" | "odd_nonlinearity") => {
            "The chip corrects it with nine parameters on line, or from its table of harmonics where a scale period is a revolution; design.toml switches them on where it can."
        }
        (Chip::Corrects, "spatial_harmonic") if order == Some(2.0) || order == Some(3.0) => {
            "The chip corrects it: with nine parameters on line where it is a bend of the channels, else from its table of harmonics; design.toml switches either on."
        }
        (Chip::Corrects, "spatial_harmonic" | "graduation_error") => {
            "The chip corrects it from its table of harmonics, which design.toml holds."
        }
        (Chip::Corrects, "channel_skew") => {
            "The chip corrects it: it turns the sine back by the speed times this delay, which design.toml tells it."
        }
        (Chip::Corrects, "offset_drift" | "gain_drift") => {
            "The chip corrects it: the calibration on line follows it."
        }
        (Chip::Corrects, _) => "The chip corrects it.",
        (Chip::CannotCorrect, "latency") => {
            "The chip cannot correct it. Behind the chip: add the speed times this delay to the position."
        }
        (Chip::CannotCorrect, _) => "The chip cannot correct it; mend it in front of the ADC.",
        (Chip::NotASensorError, _) => {
            "It is real motion, not an error of the sensor: the position shows it, and should."
        }
    }
}

/// A probability after all trials.
pub(super) fn chance(finding: &Finding) -> String {
    match finding.p_value {
        _ if finding.place.is_some() => "no: the data themselves show it".into(),
        p if p < 1e-300 => "p below 1e-300 after all trials".into(),
        p => format!("p = {p:.1e} after all trials"),
    }
}

/// What takes the place of a gain where a finding leaves the residual as it is.
pub(super) fn without_gain(finding: &Finding) -> &'static str {
    match finding.place {
        Some(_) => "found in the data: what is known to be wrong is not fitted",
        None => "describes the noise, and makes it no smaller",
    }
}

/// The experiment that tells a cause from another.
pub(super) fn experiment(cause: &str, other: &str) -> &'static str {
    use Home::{Code, Line, Motion, Noise, Period, Revolution, Speed, Time};
    let (a, b) = (home(cause), home(other));
    let either = |x: Home, y: Home| (a, b) == (x, y) || (a, b) == (y, x);
    let names = |x: &str, y: &str| (cause == x && other == y) || (cause == y && other == x);
    if names("channel_skew", "bandwidth_mismatch") {
        return "Move ten times as fast: a delay keeps the amplitude, a low pass does not.";
    }
    if names("interference", "amplitude_ripple") {
        return "Let the scale stand still at several angles: an added line stays as it is, a modulation goes with the signal.";
    }
    if names("runout", "contamination") {
        return "Record more revolutions, or clean the scale: a dirty place goes away, run-out stays.";
    }
    if a == Motion || b == Motion {
        return "Compare with a second sensor on the same axis, or a reference: real motion is in both.";
    }
    if either(Period, Revolution) {
        return "Turn the sensor's housing against the scale by a part of a revolution: what belongs to the electronics stays with the angle, what belongs to the scale moves along.";
    }
    if either(Period, Code) || (a, b) == (Code, Code) {
        return "Change the amplitude or the offset in front of the ADC: an error of the code stays at its codes, one of the sensor moves with the signal.";
    }
    if either(Period, Speed) || (a, b) == (Speed, Speed) {
        return "Record two more speeds, and both directions: what depends on speed changes, what depends on the angle alone does not.";
    }
    if a == Time || b == Time {
        return "Record the same motion again after a while, longer and with the temperature: a drift goes on, the rest comes again.";
    }
    if a == Line || b == Line {
        return "Record the same at another speed: a line keeps its hertz, what belongs to the scale changes them with the speed.";
    }
    if a == Noise || b == Noise {
        return "Record at standstill and at two speeds, at places of large and of small signal: each kind of noise follows one of them.";
    }
    if (a, b) == (Period, Period) {
        return "Record with a larger and with a smaller amplitude: a bend of the signal grows with its power, a harmonic of the scale with the amplitude itself.";
    }
    "Record several speeds, both directions and more revolutions, with a reference if there is one."
}
