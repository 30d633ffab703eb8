//! Findings, as `findings.json` has them.

use serde::Serialize;

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
}

/// What naming a cause gains.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Gain {
    /// Residual on data that was not fitted, without the cause, in fractions of the amplitude.
    pub held_out_residual_rms_before: f64,
    /// And with it.
    pub held_out_residual_rms_after: f64,
    /// Position error against the reference without the cause, radians.
    pub position_error_rms_before_rad: Option<f64>,
    /// And with it.
    pub position_error_rms_after_rad: Option<f64>,
}

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
    /// In the codes of a channel (0 is cos), again every `step` of them.
    Code {
        /// Which channel.
        channel: usize,
        /// Codes.
        step: i64,
    },
}

/// A cause shown to be in a recording.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Finding {
    /// Its name, from the contract's list.
    pub cause: String,
    /// Another cause that explains the data as well.
    pub confounded_with: Vec<String>,
    /// After all trials.
    pub p_value: f64,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// What it gains.
    pub gain: Gain,
    /// One sentence, with numbers.
    pub evidence: String,
    /// What the chip can do.
    pub chip: Chip,
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

    /// The same with where it is seen.
    pub(crate) fn at(mut self, place: Place) -> Self {
        self.place = Some(place);
        self
    }

    /// From the codes or the time base alone: nothing random about it.
    pub(crate) fn digital(cause: &str, parameters: Vec<Parameter>, evidence: String) -> Self {
        Self {
            cause: cause.into(),
            confounded_with: vec![],
            p_value: 0.0,
            parameters,
            gain: Gain::default(),
            evidence,
            chip: Chip::CannotCorrect,
            weight: f64::MAX,
            effect: None,
            place: None,
        }
    }
}
