//! Which searches of `[calibration]` there are.

use super::DesignError;
use super::formats::{TRAVEL_SAMPLES_MAX, slowest_completed_hz, travel_samples};
use super::refuse::{at_least, between, number, refuse};
use crate::spec::{Calibration, CalibrationMethod, Spec};

/// Refuses what no search can be, and keys that say nothing to the one that is there.
pub(super) fn check(spec: &Spec) -> Result<(), DesignError> {
    let c = &spec.calibration;
    if !matches!(c.parameters, 0 | 4 | 5 | 8 | 9) {
        return refuse(
            "calibration.parameters",
            c.parameters,
            "0, 4, 5, 8 or 9",
            "offsets and gains are 4, with the phase 5, with the bends of both channels 8 and 9",
        );
    }
    if !c.is_on() {
        return without(c);
    }
    if c.has_bend() && c.method == CalibrationMethod::Exact {
        return refuse(
            "calibration.method",
            "exact",
            "\"final\", which completes itself with one sensitivity, or 4 or 5 parameters",
            "recursion (11) for each of 8 or 9 parameters costs 16 or 18 products a sample for what one scalar shows",
        );
    }
    if c.squares() && c.starts() {
        return refuse(
            "calibration.start",
            "least_squares",
            "\"gears\", or the method \"final\" or \"exact\"",
            "the start is a batch of the radial residual; the sum of squares gathers another one",
        );
    }
    if c.recall == Some(true) && !c.settles() {
        return refuse(
            "calibration.recall",
            true,
            format!("false, or {}", settling(c)),
            "parameters are held only once gamma has settled: before there is nothing to recall",
        );
    }
    if c.completed().is_some() && spec.sensor.periods_per_revolution == Some(1.0) {
        return refuse(
            "calibration.completion",
            true,
            "false, or 5 parameters",
            "where a scale period is a revolution, motion at two cycles per revolution looks like a bend and would be learnt",
        );
    }
    if c.completed().is_some() && travel_samples(spec) > TRAVEL_SAMPLES_MAX {
        return refuse(
            "loop.bandwidth_hz",
            number(spec.tracking.bandwidth_hz),
            at_least(slowest_completed_hz(spec)),
            "calibration.completion counts the samples of a period of travel at a fifth of it, so many at most",
        );
    }
    between(
        "calibration.forgetting",
        c.forgetting.into(),
        0.0,
        4.0,
        "longer memory than a quarter of a period makes the search swing",
    )?;
    between(
        "calibration.completion_gamma",
        c.completion_gamma.into(),
        6.0,
        18.0,
        "a period of travel gathers 64 sectors: 2^-5 swings, and 2^-18 takes ten thousand periods",
    )?;
    idle(c)
}

/// With what γ settles.
fn settling(c: &Calibration) -> String {
    let gear = c.gamma_first.saturating_add(c.settled_gears());
    format!("gamma_last at least {gear}")
}

/// Keys of another search or set of parameters say nothing here: one that does not stand at its default was meant for it.
fn idle(c: &Calibration) -> Result<(), DesignError> {
    let default = Calibration::default();
    if c.method != CalibrationMethod::SumOfSquares && c.forgetting != default.forgetting {
        return refuse(
            "calibration.forgetting",
            c.forgetting,
            "leave it out, or take the method \"sum_of_squares\"",
            "no other search forgets: this key has no effect",
        );
    }
    if let (true, Some(lag)) = (c.squares(), c.lag) {
        return refuse(
            "calibration.lag",
            lag,
            "leave it out, or take the method \"final\" or \"exact\"",
            "the sum of squares knows no estimate that could lag: this key has no effect",
        );
    }
    if let (false, Some(hold_periods)) = (c.settles(), c.hold_periods) {
        return refuse(
            "calibration.hold_periods",
            hold_periods,
            format!("leave it out, or {}", settling(c)),
            "parameters are held only once gamma has settled, which it never does: this key has no effect",
        );
    }
    if c.completed().is_none() && c.completion_gamma != default.completion_gamma {
        return refuse(
            "calibration.completion_gamma",
            c.completion_gamma,
            "leave it out, or take 8 or 9 parameters with their completion",
            "nothing is completed: this key has no effect",
        );
    }
    Ok(())
}

/// Without calibration no key of its says anything: one that does was meant for a chip with it.
fn without(c: &Calibration) -> Result<(), DesignError> {
    let keys = |c: &Calibration| {
        let worked_out = Calibration {
            parameters: 0,
            gamma_last: Some(c.gamma_last()),
            gear_periods: Some(c.gear_periods()),
            hold_periods: Some(c.hold_periods.unwrap_or(Calibration::HELD_KNOWN)),
            recall: Some(c.recall.unwrap_or(true)),
            lag: Some(c.lag.unwrap_or(true)),
            ..c.clone()
        };
        toml::Table::try_from(worked_out).unwrap_or_default()
    };
    let nothing = keys(&Calibration {
        parameters: 0,
        ..Calibration::default()
    });
    match keys(c)
        .into_iter()
        .find(|(key, value)| nothing.get(key) != Some(value))
    {
        None => Ok(()),
        Some((key, value)) => refuse(
            format!("calibration.{key}"),
            match value {
                toml::Value::Float(value) => number(value),
                value => value.to_string(),
            },
            "leave it out, or take 4, 5, 8 or 9 parameters",
            "calibration.parameters = 0 calibrates nothing: this key has no effect",
        ),
    }
}
