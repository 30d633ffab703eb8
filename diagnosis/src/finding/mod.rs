//! Findings, as `findings.json` has them.

mod cause;
pub(crate) mod names;
pub(crate) mod units;

use nonius_quantity::Quantity;
use serde::Serialize;

pub use cause::Cause;

/// A parameter of a cause.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Standard error.
    pub std_error: f64,
    /// Its unit; "amplitude" is the mean signal amplitude.
    pub unit: String,
}

impl Parameter {
    pub(crate) fn measured(name: &str, value: f64, std_error: f64, unit: &str) -> Self {
        Self {
            name: name.into(),
            value,
            std_error,
            unit: unit.into(),
        }
    }

    pub(crate) fn exact(name: &str, value: f64, unit: &str) -> Self {
        Self::measured(name, value, 0.0, unit)
    }

    /// So many times as large, of the same name.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self {
            value: factor * self.value,
            std_error: factor.abs() * self.std_error,
            ..self.clone()
        }
    }

    /// In a sentence: value and unit, in the digits that the error allows.
    pub(crate) fn brief(&self) -> String {
        let unit = units::shown(&self.name, &self.unit);
        Quantity::new(self.value, self.std_error, unit).brief()
    }

    /// In a table: value ± error, and the unit.
    pub(crate) fn apart(&self) -> (String, String) {
        let unit = units::shown(&self.name, &self.unit);
        let (value, unit) = Quantity::new(self.value, self.std_error, unit).apart();
        (value, units::of_what(&unit, &self.name, &self.unit))
    }
}

/// What naming a cause gains. What says nothing is left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Gain {
    /// Residual on data that was not fitted, without the cause, in fractions of the amplitude.
    pub held_out_residual_rms_before: f64,
    /// And with it.
    pub held_out_residual_rms_after: f64,
    /// Position error against the reference without the cause, radians, on the same data.
    pub position_error_rms_before_rad: Option<f64>,
    /// And with it.
    pub position_error_rms_after_rad: Option<f64>,
    /// Size of the cause over the noise: the root of twice the log-likelihood that it explains.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub detection_snr: Option<f64>,
    /// Of noise: log-likelihood of data that was not fitted, with its name less without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held_out_log_likelihood_gain: Option<f64>,
    /// Samples that were put back, taken out or left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub repaired_samples: Option<usize>,
}

impl Gain {
    /// What is known before the model is judged: how much log-likelihood a cause explains.
    pub(crate) fn of(log_likelihood: f64) -> Self {
        Self {
            detection_snr: Some((2.0 * log_likelihood.max(0.0)).sqrt()),
            ..Self::default()
        }
    }

    /// The same of what takes nothing off the signals, beside a model that leaves these on data that was not fitted.
    pub(crate) fn beside(self, residual_rms: f64, position_error_rms_rad: Option<f64>) -> Self {
        Self {
            held_out_residual_rms_before: residual_rms,
            held_out_residual_rms_after: residual_rms,
            position_error_rms_before_rad: position_error_rms_rad,
            position_error_rms_after_rad: position_error_rms_rad,
            ..self
        }
    }
}

/// The parameter of a harmonic whose order is not sure: the other one that it may have.
pub const OTHER_ORDER: &str = "other_order";

/// What the chip can do about a cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Chip {
    /// It corrects it.
    #[serde(rename = "corrects")]
    Corrects,
    /// It cannot.
    #[serde(rename = "cannot correct")]
    CannotCorrect,
    /// Real motion.
    #[serde(rename = "is not a sensor error")]
    NotASensorError,
}

/// What a cause does at each sample, as the fit has it: for plots.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// Along the radius, in amplitudes.
    pub radial: Vec<f32>,
    /// Along the circle, in radians: above the motion, or against the reference.
    pub tangential: Vec<f32>,
    /// As real motion, radians, where that is a row of its own.
    pub motion: Vec<f32>,
}

/// Where in the data something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// At a sample of the recording.
    Sample(usize),
    /// Before a sample of the recording, so many are missing.
    Gap {
        /// The sample.
        sample: usize,
        /// How many.
        missing: usize,
    },
    /// At a sample that repeats the one before.
    Repeat {
        /// The sample.
        sample: usize,
        /// It was put in, and does not stand in another's place.
        inserted: bool,
    },
    /// In the codes of a channel (0 is cos), again every `step` of them.
    Code {
        /// Which channel.
        channel: usize,
        /// Codes.
        step: i64,
    },
    /// At the code of a rail that clips a channel (0 is cos).
    Rail {
        /// Which channel.
        channel: usize,
        /// The signed code about mid-scale.
        code: i64,
    },
    /// At a code of a channel (0 is cos) that never comes.
    Missing {
        /// Which channel.
        channel: usize,
        /// The signed code about mid-scale.
        code: i64,
    },
}

/// A cause shown to be in a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Its name, from the catalogue.
    pub cause: Cause,
    /// Another cause that explains the data as well.
    pub confounded_with: Vec<Cause>,
    /// After all trials.
    pub p_value: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// What it gains.
    pub gain: Gain,
    /// One sentence, with numbers; of a group it names both first.
    pub evidence: String,
    /// What the chip can do.
    pub chip: Chip,
    /// What `design.toml` does about it, in sentences; the program that writes the design says so.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub design: Vec<String>,
    /// log-likelihood that it explains: the order of the findings.
    #[serde(skip)]
    pub weight: f64,
    /// What it does; `None` for noise, and for what is wrong in the data themselves.
    #[serde(skip)]
    pub effect: Option<Effect>,
    /// Where in the data it is seen first; `None` for what a fit found.
    #[serde(skip)]
    pub place: Option<Place>,
}

impl Finding {
    /// A parameter's value.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<f64> {
        let one = self.parameters.iter().find(|p| p.name == name);
        one.map(|p| p.value)
    }

    /// The causes that it may be, as people write them.
    #[must_use]
    pub fn plain_name(&self) -> String {
        self.all_as(Cause::plain)
    }

    /// The evidence, each after its name in `findings.json`.
    #[must_use]
    pub fn named_evidence(&self) -> String {
        let seen = self
            .evidence
            .strip_prefix(&self.group())
            .unwrap_or(&self.evidence);
        format!("{}: {seen}", self.all_as(|cause| cause.to_string()))
    }

    /// The causes that it may be, each as `said` says it.
    fn all_as(&self, said: impl Fn(Cause) -> String) -> String {
        let others = self.confounded_with.iter().copied();
        let all: Vec<String> = std::iter::once(self.cause)
            .chain(others)
            .map(said)
            .collect();
        all.join(" or ")
    }

    /// What stands before the evidence of a group; nothing where there is one name.
    fn group(&self) -> String {
        if self.confounded_with.is_empty() {
            String::new()
        } else {
            format!("{}: ", self.plain_name())
        }
    }

    /// With both names before the evidence, where there are two.
    pub(crate) fn naming_both(mut self) -> Self {
        self.evidence.insert_str(0, &self.group());
        self
    }

    /// With so many samples that were put back, taken out or left out.
    pub(crate) fn repairing(mut self, samples: usize) -> Self {
        self.gain.repaired_samples = Some(samples);
        self
    }

    /// The same with where it is seen.
    pub(crate) fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// From the codes or the time base alone: nothing random about it.
    pub(crate) fn digital(cause: Cause, parameters: Vec<Parameter>, evidence: String) -> Self {
        Self {
            cause,
            confounded_with: vec![],
            p_value: 0.0,
            parameters,
            gain: Gain::default(),
            evidence,
            chip: Chip::CannotCorrect,
            design: vec![],
            weight: f64::MAX,
            effect: None,
            place: None,
        }
    }
}
