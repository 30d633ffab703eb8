//! Every field of a design checked for sense, before anything is derived from it.

use super::DesignError;
use super::budget::{RMS_MOST, SHARE_LEAST};
use super::naming;
use super::refuse::{between, refuse};
use super::search;
use crate::graph::Graph;
use crate::spec::{Multipliers, Spec};

/// Checks every field for sense.
pub(super) fn check(spec: &Spec) -> Result<(), DesignError> {
    naming::check(spec)?;
    adc(spec)?;
    sensor(spec)?;
    accuracy(spec)?;
    search::check(spec)?;
    calibration(spec)?;
    chip(spec)?;
    top_speed(spec)
}

/// Fastest clock, hertz: beyond it no process makes a product of the chip's words and its sum in one period.
const CLOCK_MOST_HZ: f64 = 2e9;

/// A field with its value, the least and the most that it may be, and why.
type Row = (&'static str, f64, f64, f64, &'static str);

fn all_between<const N: usize>(rows: [Row; N]) -> Result<(), DesignError> {
    for (field, value, least, most, reason) in rows {
        between(field, value, least, most, reason)?;
    }
    Ok(())
}

/// `field` is there or not; what is there is a number above zero.
fn positive(
    field: &'static str,
    value: Option<f64>,
    reason: &'static str,
) -> Result<(), DesignError> {
    value.map_or(Ok(()), |value| between(field, value, 1e-12, 1e15, reason))
}

/// The converter.
fn adc(spec: &Spec) -> Result<(), DesignError> {
    all_between([
        (
            "adc.bits",
            spec.adc.bits.into(),
            8.0,
            18.0,
            "the chip is built for ADCs of 8 to 18 bits",
        ),
        (
            "adc.full_scale",
            spec.adc.full_scale,
            1e-9,
            1e12,
            "the ADC needs a range",
        ),
        (
            "adc.middle",
            spec.adc.middle,
            -1e12,
            1e12,
            "the middle of the range must be a number",
        ),
        (
            "adc.sample_rate_hz",
            spec.adc.sample_rate_hz,
            1e-3,
            1e10,
            "samples per second",
        ),
    ])
}

/// The sensor, beside its top speed.
fn sensor(spec: &Spec) -> Result<(), DesignError> {
    let (low, high) = (spec.adc.full_scale / 64.0, spec.adc.full_scale);
    all_between([
        (
            "sensor.amplitude",
            spec.sensor.amplitude,
            low,
            high,
            "the signal must fit the ADC's range and use some of it",
        ),
        (
            "sensor.amplitude_tolerance",
            spec.sensor.amplitude_tolerance,
            0.0,
            0.6,
            "a part of the amplitude, without sign; calibration is bounded to it",
        ),
        (
            "sensor.offset_max",
            spec.sensor.offset_max,
            0.0,
            0.6,
            "a part of the amplitude, without sign; a larger one moves the origin out of the ellipse",
        ),
        (
            "sensor.amplitude",
            spec.sensor.amplitude,
            low,
            1.25 * spec.adc.full_scale / spec.sensor.reach(),
            "with its tolerance and its offset the signal goes too far beyond the ADC's range",
        ),
        (
            "sensor.phase_error_max_deg",
            spec.sensor.phase_error_max_deg,
            0.0,
            45.0,
            "degrees without sign; with more the two channels are nearly one",
        ),
        (
            "sensor.noise_rms",
            spec.sensor.noise_rms,
            0.0,
            0.25,
            "rms as a part of the amplitude; no loop locks on more noise than that",
        ),
        (
            "sensor.bend_max",
            spec.sensor.bend_max,
            0.0,
            0.2,
            "a part of the amplitude, without sign; polynomials of third order mend no more",
        ),
    ])?;
    positive(
        "sensor.scale_period_m",
        spec.sensor.scale_period_m,
        "a scale period has a length",
    )?;
    positive(
        "sensor.periods_per_revolution",
        spec.sensor.periods_per_revolution,
        "a revolution has scale periods",
    )?;
    positive(
        "sensor.speed_max_periods_per_s",
        Some(spec.sensor.speed_max_periods_per_s),
        "the scale moves",
    )
}

/// How good the chip is to be.
fn accuracy(spec: &Spec) -> Result<(), DesignError> {
    all_between([
        (
            "accuracy.rms_periods",
            spec.accuracy.rms_periods,
            1e-9,
            RMS_MOST,
            "accuracy in scale periods",
        ),
        (
            "accuracy.arithmetic_share",
            spec.accuracy.arithmetic_share,
            SHARE_LEAST,
            1.0,
            "a part of the accuracy",
        ),
    ])
}

/// Limits of the search; what it searches is [`search`]'s.
fn calibration(spec: &Spec) -> Result<(), DesignError> {
    let (first, last) = (spec.calibration.gamma_first, spec.calibration.gamma_last());
    all_between([
        (
            "calibration.gamma_first",
            spec.calibration.gamma_first.into(),
            3.0,
            12.0,
            "the sum of gamma over the 64 sectors of a period must be at most 8",
        ),
        (
            "calibration.gamma_last",
            last.into(),
            first.into(),
            18.0,
            "the last gamma is not larger than the first, and 2^-18 averages over half a million sectors",
        ),
        (
            "calibration.gear_periods",
            spec.calibration.gear_periods().into(),
            1.0,
            255.0,
            "periods between gears",
        ),
        (
            "calibration.restart_residual",
            spec.calibration.restart_residual,
            0.01,
            1.5,
            "residual as a fraction of the radius",
        ),
        (
            "calibration.hold_residual",
            spec.calibration.hold_residual,
            0.01,
            1.5,
            "residual as a fraction of the radius",
        ),
        (
            "calibration.hold_periods",
            spec.calibration.hold_periods().into(),
            1.0,
            4096.0,
            "periods held",
        ),
    ])
}

/// The chip's own numbers.
fn chip(spec: &Spec) -> Result<(), DesignError> {
    all_between([(
        "chip.count_bits",
        spec.chip.count_bits.into(),
        32.0,
        44.0,
        "counted periods",
    )])?;
    if let Multipliers::Count(0) = spec.chip.multipliers {
        return refuse(
            "chip.multipliers",
            0,
            "1, 2, … or \"all\"",
            "products need a multiplier",
        );
    }
    match spec.chip.clock_hz {
        None => Ok(()),
        Some(clock) => between(
            "chip.clock_hz",
            clock,
            1e-12,
            CLOCK_MOST_HZ,
            "Hz; a product takes one clock: an FPGA makes some 100 million a second, and no process more than this",
        ),
    }
}

/// The loop follows the top speed.
fn top_speed(spec: &Spec) -> Result<(), DesignError> {
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
