//! Every field of a design checked for sense, before anything is derived from it.

use super::DesignError;
use super::budget::{RMS_MOST, SHARE_LEAST};
use super::keywords::{KEYWORDS, SYSTEM_KEYWORDS};
use super::refuse::{between, refuse};
use super::search;
use crate::graph::Graph;
use crate::spec::{Multipliers, Spec};

/// Checks every field for sense.
pub(super) fn check(spec: &Spec) -> Result<(), DesignError> {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let first = spec.name.chars().next().unwrap_or(' ');
    if !first.is_ascii_alphabetic() || !spec.name.chars().all(word) || spec.name.len() > 64 {
        return refuse(
            "name",
            format!("{:?}", spec.name),
            "letters, digits and _, a letter first",
            "it names Verilog modules",
        );
    }
    if spec.description.chars().any(char::is_control) {
        return refuse(
            "description",
            format!("{:?}", spec.description),
            "one line without control characters",
            "it stands in the Verilog and in the report",
        );
    }
    let name = spec.name.as_str();
    if KEYWORDS.contains(&name) || SYSTEM_KEYWORDS.contains(&name) || name == "chip_tb" {
        return refuse(
            "name",
            format!("{:?}", spec.name),
            "no word of Verilog, and not chip_tb",
            "it names a Verilog module, and this is a keyword or the testbench",
        );
    }
    between(
        "adc.bits",
        spec.adc.bits.into(),
        8.0,
        18.0,
        "the chip is built for ADCs of 8 to 18 bits",
    )?;
    between(
        "adc.full_scale",
        spec.adc.full_scale,
        1e-9,
        1e12,
        "the ADC needs a range",
    )?;
    between(
        "adc.middle",
        spec.adc.middle,
        -1e12,
        1e12,
        "the middle of the range must be a number",
    )?;
    between(
        "adc.sample_rate_hz",
        spec.adc.sample_rate_hz,
        1e-3,
        1e10,
        "samples per second",
    )?;
    let (low, high) = (spec.adc.full_scale / 64.0, spec.adc.full_scale);
    between(
        "sensor.amplitude",
        spec.sensor.amplitude,
        low,
        high,
        "the signal must fit the ADC's range and use some of it",
    )?;
    between(
        "sensor.amplitude_tolerance",
        spec.sensor.amplitude_tolerance,
        0.0,
        0.6,
        "a part of the amplitude, without sign; calibration is bounded to it",
    )?;
    between(
        "sensor.offset_max",
        spec.sensor.offset_max,
        0.0,
        0.6,
        "a part of the amplitude, without sign; a larger one moves the origin out of the ellipse",
    )?;
    between(
        "sensor.amplitude",
        spec.sensor.amplitude,
        low,
        1.25 * spec.adc.full_scale / spec.sensor.reach(),
        "with its tolerance and its offset the signal goes too far beyond the ADC's range",
    )?;
    between(
        "sensor.phase_error_max_deg",
        spec.sensor.phase_error_max_deg,
        0.0,
        45.0,
        "degrees without sign; with more the two channels are nearly one",
    )?;
    between(
        "sensor.noise_rms",
        spec.sensor.noise_rms,
        0.0,
        0.25,
        "rms as a part of the amplitude; no loop locks on more noise than that",
    )?;
    between(
        "accuracy.rms_periods",
        spec.accuracy.rms_periods,
        1e-9,
        RMS_MOST,
        "accuracy in scale periods",
    )?;
    between(
        "accuracy.arithmetic_share",
        spec.accuracy.arithmetic_share,
        SHARE_LEAST,
        1.0,
        "a part of the accuracy",
    )?;
    between(
        "chip.count_bits",
        spec.chip.count_bits.into(),
        32.0,
        44.0,
        "counted periods",
    )?;
    between(
        "sensor.bend_max",
        spec.sensor.bend_max,
        0.0,
        0.2,
        "a part of the amplitude, without sign; polynomials of third order mend no more",
    )?;
    search::check(spec)?;
    between(
        "calibration.gamma_first",
        spec.calibration.gamma_first.into(),
        3.0,
        12.0,
        "the sum of gamma over the 64 sectors of a period must stay below 8",
    )?;
    let (first, last) = (spec.calibration.gamma_first, spec.calibration.gamma_last());
    between(
        "calibration.gamma_last",
        last.into(),
        first.into(),
        18.0,
        "the last gamma is not larger than the first, and 2^-18 averages over half a million sectors",
    )?;
    between(
        "calibration.gear_periods",
        spec.calibration.gear_periods().into(),
        1.0,
        255.0,
        "periods between gears",
    )?;
    between(
        "calibration.restart_residual",
        spec.calibration.restart_residual,
        0.01,
        1.5,
        "residual as a fraction of the radius",
    )?;
    between(
        "calibration.hold_residual",
        spec.calibration.hold_residual,
        0.01,
        1.5,
        "residual as a fraction of the radius",
    )?;
    between(
        "calibration.hold_periods",
        spec.calibration.hold_periods().into(),
        1.0,
        4096.0,
        "periods held",
    )?;
    if let Multipliers::Count(0) = spec.chip.multipliers {
        return refuse(
            "chip.multipliers",
            0,
            "1, 2, … or \"all\"",
            "products need a multiplier",
        );
    }
    for (field, value, reason) in [
        ("chip.clock_hz", spec.chip.clock_hz, "a clock ticks"),
        (
            "sensor.scale_period_m",
            spec.sensor.scale_period_m,
            "a scale period has a length",
        ),
        (
            "sensor.periods_per_revolution",
            spec.sensor.periods_per_revolution,
            "a revolution has scale periods",
        ),
        (
            "sensor.speed_max_periods_per_s",
            Some(spec.sensor.speed_max_periods_per_s),
            "the scale moves",
        ),
    ] {
        if let Some(value) = value {
            between(field, value, 1e-12, 1e15, reason)?;
        }
    }
    let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    if !(top.is_finite() && top > 0.0 && top <= 0.25) {
        let needed = spec.sensor.speed_max_periods_per_s * 4.0;
        return refuse(
            "adc.sample_rate_hz",
            spec.adc.sample_rate_hz,
            format!("at least {needed} Hz"),
            "the loop needs four samples per period at top speed",
        );
    }
    Ok(())
}

/// Signals of the module that are no nodes of the graph.
const PINS: [&str; 8] = [
    "clk",
    "rst_n",
    "sample_valid",
    "valid",
    "position",
    "step",
    "start",
    "last",
];

/// Refuses more multipliers than there are products.
pub(super) fn used(multipliers: Multipliers, graph: &Graph) -> Result<(), DesignError> {
    match multipliers {
        Multipliers::Count(n) if n as usize > graph.products().max(1) => refuse(
            "chip.multipliers",
            n,
            format!("1 … {} or \"all\"", graph.products().max(1)),
            "each sample of this chip has so many products; more multipliers would stand idle",
        ),
        _ => Ok(()),
    }
}

/// The module is called like none of its signals: linters would say that one hides the other.
pub(super) fn apart(name: &str, graph: &Graph) -> Result<(), DesignError> {
    let nodes = graph.nodes.iter().filter_map(|n| n.name.as_deref());
    let tables = graph.roms.iter().map(|rom| rom.name);
    let hides = |signal: &str| {
        let rest = name.strip_prefix(signal);
        matches!(
            rest,
            Some("" | "_now" | "_held" | "_next" | "_address" | "_row")
        )
    };
    if nodes.chain(tables).chain(PINS).any(hides) {
        return Err(DesignError::name_of_a_signal(name));
    }
    Ok(())
}
