//! A line that is added to the channels.

use std::f64::consts::TAU;

use serde::Deserialize;

/// A line and its second and third harmonic in each channel: fractions of the channel's amplitude, phases those of
/// cos(2πft + phase).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the keys of `sensor.toml`, explained above")]
pub struct Interference {
    pub frequency_hz: f64,
    pub amplitude_cos: f64,
    pub phase_cos: f64,
    pub amplitude_sin: f64,
    pub phase_sin: f64,
    #[serde(default)]
    pub amplitude_cos_2: f64,
    #[serde(default)]
    pub phase_cos_2: f64,
    #[serde(default)]
    pub amplitude_sin_2: f64,
    #[serde(default)]
    pub phase_sin_2: f64,
    #[serde(default)]
    pub amplitude_cos_3: f64,
    #[serde(default)]
    pub phase_cos_3: f64,
    #[serde(default)]
    pub amplitude_sin_3: f64,
    #[serde(default)]
    pub phase_sin_3: f64,
}

impl Interference {
    /// What is added to channel 0 (cos) or 1 (sin) at a time in seconds.
    pub(crate) fn at(&self, which: usize, time: f64) -> f64 {
        let lines = if which == 0 {
            [
                (self.amplitude_cos, self.phase_cos),
                (self.amplitude_cos_2, self.phase_cos_2),
                (self.amplitude_cos_3, self.phase_cos_3),
            ]
        } else {
            [
                (self.amplitude_sin, self.phase_sin),
                (self.amplitude_sin_2, self.phase_sin_2),
                (self.amplitude_sin_3, self.phase_sin_3),
            ]
        };
        let harmonics = lines.iter().zip(1..);
        harmonics
            .map(|((amplitude, phase), harmonic)| {
                let turns = f64::from(harmonic) * self.frequency_hz * time;
                amplitude * (TAU * turns + phase).cos()
            })
            .sum()
    }
}
