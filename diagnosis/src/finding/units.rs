//! How the units of findings.json are shown to people.

use nonius_quantity::Unit;

use crate::finding::OTHER_ORDER;

/// What a value in the amplitude's unit is a part of.
const OF_THE_AMPLITUDE: &str = "% of the amplitude";

/// How a parameter of this name and unit is shown.
pub(crate) fn shown<'a>(name: &str, unit: &'a str) -> Unit<'a> {
    match unit {
        "s" => Unit::Small("s"),
        "Hz" => Unit::Prefixed("Hz"),
        // A place on a circle is of the order of one.
        "rad" if ["phase", "place"].iter().any(|n| name.starts_with(n)) => Unit::Plain("rad"),
        "rad" => Unit::Small("rad"),
        "amplitude" | "amplitude/sqrt(Hz)" => Unit::Percent,
        "1" if ["order", OTHER_ORDER, "bit", "level"].contains(&name) => Unit::Plain(""),
        "1" => Unit::Percent,
        other => Unit::Plain(other),
    }
}

/// The unit as a table has it: what the per cent are of.
pub(crate) fn of_what(shown: &str, name: &str, unit: &str) -> String {
    match unit {
        "amplitude" => OF_THE_AMPLITUDE.into(),
        "amplitude/sqrt(Hz)" => format!("{OF_THE_AMPLITUDE} per √Hz"),
        "1" if name == "depth" => OF_THE_AMPLITUDE.into(),
        _ => shown.into(),
    }
}

/// Whether the values are the codes of an ADC, whole numbers.
pub(crate) fn are_counts(recording: &nonius_recording::Recording) -> bool {
    let whole = |values: &[f64]| values.iter().all(|v| v.fract() == 0.0);
    whole(&recording.cos) && whole(&recording.sin)
}

/// The unit of a recording's columns, as far as it is known: codes are counts, and volts would be a guess.
pub(crate) fn of_columns(recording: &nonius_recording::Recording) -> &'static str {
    let adc = recording.metadata.adc;
    if adc.cos.lsb == 1.0 && are_counts(recording) {
        "counts"
    } else {
        "unit of the columns"
    }
}
