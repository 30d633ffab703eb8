//! `[correction]`: what is corrected by numbers that are known beforehand.

use serde::{Deserialize, Serialize};

/// `[correction]`
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Correction {
    /// sin is sampled so much later than cos, seconds; negative: earlier. 0: at the same instant, and the chip is the one
    /// without this correction.
    #[serde(default)]
    pub channel_skew_s: f64,
    /// What repeats with the scale period and stands in no other parameter. None: the chip is the one without the table.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<Harmonic>,
}

impl Correction {
    /// Nothing to correct.
    #[must_use]
    pub fn is_none(&self) -> bool {
        !self.has_skew() && self.harmonics.is_empty()
    }

    /// What the harmonics add to channel `which` (0 the cosine, 1 the sine) at the angle `alpha`, radians, and its derivative;
    /// as fractions of the amplitude.
    #[must_use]
    pub fn harmonics_at(&self, which: usize, alpha: f64) -> (f64, f64) {
        let each = self.harmonics.iter().map(|h| h.at(which, alpha));
        each.fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1))
    }

    /// The channels are not sampled at the same instant.
    #[must_use]
    pub fn has_skew(&self) -> bool {
        self.channel_skew_s != 0.0
    }
}

/// `[[correction.harmonics]]`: what one order of the scale period adds to the channels, amplitude · cos(order · α + phase)
/// in each, as in the finding `spatial_harmonic` and in `sensor.toml`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Harmonic {
    /// Cycles per scale period, 2 to 16.
    pub order: u32,
    /// In the cosine channel, as a fraction of its amplitude.
    pub amplitude_cos: f64,
    /// Its phase, radians.
    pub phase_cos: f64,
    /// In the sine channel, as a fraction of its amplitude.
    pub amplitude_sin: f64,
    /// Its phase, radians.
    pub phase_sin: f64,
}

impl Harmonic {
    /// Amplitude and phase in each channel, the cosine first.
    #[must_use]
    pub fn channels(&self) -> [(f64, f64); 2] {
        [
            (self.amplitude_cos, self.phase_cos),
            (self.amplitude_sin, self.phase_sin),
        ]
    }

    /// What it adds to channel `which` (0 the cosine, 1 the sine) at the angle `alpha`, radians, and the derivative; as
    /// fractions of the amplitude.
    #[must_use]
    pub fn at(&self, which: usize, alpha: f64) -> (f64, f64) {
        let (amplitude, phase) = self.channels()[which];
        let order = f64::from(self.order);
        let (sin, cos) = (order * alpha + phase).sin_cos();
        (amplitude * cos, -amplitude * order * sin)
    }
}
