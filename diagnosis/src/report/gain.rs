//! What naming a cause gains, in words: less residual or position error, a likelier noise, samples that are repaired.

use nonius_quantity::{Unit, agree, before_after, counted, digits};

use crate::diagnose::Diagnosis;
use crate::finding::{Chip, Finding, Place};

/// What is better, by how much.
pub(super) struct Gain {
    pub(super) what: &'static str,
    /// From what to what.
    pub(super) value: String,
    /// The change in per cent, or what else there is to say.
    pub(super) change: String,
}

const ANGLE: &str = "angle error against the reference on held-out data, rms";
const RESIDUAL: &str = "residual on held-out data, rms";
const UNCHANGED: &str = "unchanged";

impl Gain {
    /// Of a finding.
    pub(super) fn of(finding: &Finding) -> Self {
        let g = &finding.gain;
        if finding.place.is_some() {
            return repaired(finding);
        }
        if let Some(gain) = g.held_out_log_likelihood_gain {
            return likelihood(gain);
        }
        let position = (
            g.position_error_rms_before_rad,
            g.position_error_rms_after_rad,
        );
        let residual = (
            g.held_out_residual_rms_before,
            g.held_out_residual_rms_after,
        );
        let mut gain = removed(position, residual);
        // What changes the radius alone moves no position.
        if !gain.changes() {
            gain = removed((None, None), residual);
        }
        if finding.chip == Chip::NotASensorError && !gain.changes() {
            return Self {
                what: "gain",
                value: "none".into(),
                change: "the position shows real motion, and should".into(),
            };
        }
        gain
    }

    /// Of the extended model over the five parameters.
    pub(super) fn of_all(found: &Diagnosis) -> Self {
        let (before, after) = (&found.simulation, &found.extended);
        removed(
            (before.position_error_rms_rad, after.position_error_rms_rad),
            (before.held_out_residual_rms, after.held_out_residual_rms),
        )
    }

    /// The same where nothing was found: one number.
    pub(super) fn none(all: Self) -> Self {
        let after = all
            .value
            .split_once("→ ")
            .map(|(_, after)| after.to_owned());
        Self {
            value: after.unwrap_or_default(),
            change: "with the five parameters alone".into(),
            ..all
        }
    }

    pub(super) fn changes(&self) -> bool {
        self.change != UNCHANGED
    }
}

/// A position error, or where none is known the residual.
fn removed(position: (Option<f64>, Option<f64>), residual: (f64, f64)) -> Gain {
    let (what, from, to, unit) = match position {
        (Some(before), Some(after)) => {
            let (from, to) = (before.to_degrees(), after.to_degrees());
            (ANGLE, from, to, Unit::Plain("°"))
        }
        _ => (RESIDUAL, residual.0, residual.1, Unit::Percent),
    };
    let (before, after) = before_after(from, to, unit);
    Gain {
        what,
        value: format!(
            "{before} → {after}{}",
            if what == ANGLE {
                ""
            } else {
                " of the amplitude"
            }
        ),
        change: change(from, to),
    }
}

fn change(before: f64, after: f64) -> String {
    let change = 100.0 * (after / before.max(f64::MIN_POSITIVE) - 1.0);
    // Not −0.
    if change.abs() < 0.05 {
        UNCHANGED.into()
    } else {
        let side = if change < 0.0 { "less" } else { "more" };
        format!("{:.1} % {side}", change.abs())
    }
}

/// Of noise, which takes nothing off the signals.
fn likelihood(gain: f64) -> Gain {
    let snr = if gain > 0.0 {
        format!("SNR {}", digits((2.0 * gain).sqrt(), 3))
    } else {
        "none".into()
    };
    let gain = digits(gain, 3);
    Gain {
        what: "noise explained in held-out data",
        value: snr,
        change: format!("log-likelihood {gain:+}; the residual itself stays as it is"),
    }
}

/// Of what is wrong in the data themselves.
fn repaired(finding: &Finding) -> Gain {
    let samples = finding.gain.repaired_samples.unwrap_or(0);
    let done = |what: &str| format!("{} {what}", counted(samples, "sample"));
    let value = match finding.place {
        Some(Place::Gap { .. }) if samples == 0 => "nothing: too much is missing".into(),
        Some(Place::Gap { .. }) => done("put back into the time base"),
        Some(Place::Repeat { inserted: true, .. }) => done("taken out of the time base"),
        Some(Place::Code { .. } | Place::Missing { .. }) => {
            "nothing: the codes are taken as they are".into()
        }
        _ => done("left out of every fit"),
    };
    let change = match finding.place {
        Some(Place::Code { .. } | Place::Missing { .. }) => {
            "mend it at the converter or its link".into()
        }
        Some(Place::Gap { .. }) => format!(
            "{} filled in, and {} not count",
            agree(samples, "its place is", "their places are"),
            agree(samples, "does", "do")
        ),
        Some(Place::Rail { .. }) => "what is clipped is not fitted, nor what is beside it".into(),
        Some(Place::Sample(_)) => "each glitch and the samples beside it".into(),
        _ => "what is known to be wrong is not fitted".into(),
    };
    Gain {
        what: "repaired",
        value,
        change,
    }
}
