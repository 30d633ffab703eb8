//! What is hidden in a recording.

use serde::{Deserialize, Serialize};

/// What kind of case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Nothing.
    Nothing,
    /// One cause as the textbook draws it.
    One,
    /// One cause as the world draws it.
    Wild,
    /// Two causes, of SNR 60 and 30.
    Two,
    /// A cause that the catalogue does not hold, of SNR 40.
    Stranger,
    /// Three to five causes; no seed stands for it unless it is asked for.
    Many,
}

/// A parameter of a hidden cause, by the words of `findings.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrueParameter {
    /// Name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// The best standard error that any method can have is |value| / SNR.
    pub bounded: bool,
}

/// The cause of another name that does nearly the same: the low pass of a delay, the delay of a low pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Twin {
    /// Distance to the nearest recording with it, in units of the noise, as the SNR is.
    pub distance: f64,
    /// How many times as often as the twin the cause is hidden in recordings with a reference, or without.
    pub odds: f64,
}

/// One hidden cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HiddenCause {
    /// Its name.
    pub name: String,
    /// Other names of the catalogue that are true of it: right where they are named beside its own, and not enough without.
    pub brings: Vec<String>,
    /// SNR that was drawn.
    pub snr_asked: f64,
    /// SNR that it has.
    pub snr: f64,
    /// Of a delay or a low pass that is the only cause, as the textbook draws it: the other one. Where that is never hidden in such a
    /// recording there is none.
    pub twin: Option<Twin>,
    /// In the unit of its own.
    pub magnitude: f64,
    /// Parameters.
    pub parameters: Vec<TrueParameter>,
    /// It is real motion.
    pub motion: bool,
    /// It is electrical and changes the position shown.
    pub electrical: bool,
}

/// What is in a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    /// All follows from it (and from the number of samples).
    pub seed: u64,
    /// Kind of case.
    pub kind: Kind,
    /// What is hidden.
    pub hidden: Vec<HiddenCause>,
    /// Samples.
    pub samples: usize,
    /// How the axis is driven.
    pub drive: String,
    /// Rms of the real broadband vibration, rad.
    pub vibration_rad: Option<f64>,
    /// A reference column.
    pub reference: bool,
    /// White noise, ADC included, of the mean amplitude.
    pub noise: f64,
    /// Of the ADC.
    pub bits: u32,
    /// Samples per second.
    pub rate: f64,
}

impl Truth {
    /// What is hidden with the SNR of each, in words.
    pub(crate) fn listed(&self) -> String {
        let each = self.hidden.iter();
        let each = each.map(|h| format!("{} ({:.0})", h.name, h.snr));
        match self.hidden.is_empty() {
            true => "nothing".into(),
            false => each.collect::<Vec<_>>().join(", "),
        }
    }
}
