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

/// What is left without a cause, and with it.
pub(super) struct Removed {
    what: What,
    before: f64,
    after: f64,
}

/// Rms on data that were not fitted.
enum What {
    /// Error of the angle against the reference, radians.
    Angle,
    /// Residual, in fractions of the amplitude.
    Residual,
}

impl Removed {
    /// By the extended model beside the five parameters.
    pub(super) fn by_all(found: &Diagnosis) -> Self {
        let (before, after) = (&found.simulation, &found.extended);
        Self::of(
            (before.position_error_rms_rad, after.position_error_rms_rad),
            (before.held_out_residual_rms, after.held_out_residual_rms),
        )
    }

    /// A position error, or where none is known the residual.
    fn of(position: (Option<f64>, Option<f64>), residual: (f64, f64)) -> Self {
        let (what, (before, after)) = match position {
            (Some(before), Some(after)) => (What::Angle, (before, after)),
            _ => (What::Residual, residual),
        };
        Self {
            what,
            before,
            after,
        }
    }

    /// More, in per cent.
    fn change(&self) -> f64 {
        100.0 * (self.after / self.before.max(f64::MIN_POSITIVE) - 1.0)
    }

    /// Whether what is told of it is another number.
    pub(super) fn changes(&self) -> bool {
        self.change().abs() >= 0.05
    }

    /// From what to what.
    pub(super) fn told(&self) -> Gain {
        let (before, after) = self.written();
        // Not −0.
        let change = if self.changes() {
            let side = if self.change() < 0.0 { "less" } else { "more" };
            format!("{:.1} % {side}", self.change().abs())
        } else {
            "unchanged".into()
        };
        self.as_gain(format!("{before} → {after}"), change)
    }

    /// Where nothing was found: one number.
    pub(super) fn of_nothing(&self) -> Gain {
        self.as_gain(self.written().1, "with the five parameters alone".into())
    }

    fn written(&self) -> (String, String) {
        match self.what {
            What::Angle => {
                let [from, to] = [self.before, self.after].map(f64::to_degrees);
                before_after(from, to, Unit::Plain("°"))
            }
            What::Residual => before_after(self.before, self.after, Unit::Percent),
        }
    }

    fn as_gain(&self, value: String, change: String) -> Gain {
        let (what, of) = match self.what {
            What::Angle => (
                "angle error against the reference on held-out data, rms",
                "",
            ),
            What::Residual => ("residual on held-out data, rms", " of the amplitude"),
        };
        Gain {
            what,
            value: value + of,
            change,
        }
    }
}

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
        // What changes the radius alone moves no position.
        let all = [position, (None, None)].map(|position| Removed::of(position, residual));
        match all.iter().find(|one| one.changes()) {
            Some(one) => one.told(),
            None if finding.chip == Chip::NotASensorError => Self {
                what: "gain",
                value: "none".into(),
                change: "the position shows real motion, and should".into(),
            },
            None => all[1].told(),
        }
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
