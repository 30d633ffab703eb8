//! The names of causes.

use std::fmt;

use serde::Serialize;

/// A cause, by its name in `docs/diagnosis.md`: programs rely on these words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Offsets of the channels.
    Offset,
    /// Amplitudes that differ.
    GainMismatch,
    /// Phase error between the channels.
    QuadratureError,
    /// A bend y + k y² of a channel.
    EvenNonlinearity,
    /// A bend y + k y³ of a channel.
    OddNonlinearity,
    /// An order of the scale period.
    SpatialHarmonic,
    /// Compression near a rail.
    Saturation,
    /// An error as a function of the code.
    AdcNonlinearity,
    /// A bit that never changes.
    StuckBit,
    /// Steps of several codes.
    CoarseQuantisation,
    /// A channel that is sampled later.
    ChannelSkew,
    /// A low pass in one channel.
    BandwidthMismatch,
    /// A low pass in both channels.
    CommonBandwidth,
    /// Both channels late against the reference.
    Latency,
    /// Capacitors in the channels.
    AcCoupling,
    /// A line that is added to the channels.
    Interference,
    /// A line in the amplitude of both channels.
    AmplitudeRipple,
    /// Offsets that change slowly.
    OffsetDrift,
    /// Gains that change slowly.
    GainDrift,
    /// Amplitude that goes with the revolution.
    Runout,
    /// Errors of the graduation along a revolution.
    GraduationError,
    /// A dip of the amplitude at one place of the revolution.
    Contamination,
    /// Isolated samples far off.
    Glitches,
    /// Samples that are missing.
    DroppedSamples,
    /// Samples that come twice.
    RepeatedSamples,
    /// Random error of the sampling time.
    ClockJitter,
    /// Noise with a 1/f spectrum.
    FlickerNoise,
    /// Noise in proportion to the signal.
    AmplitudeNoise,
    /// Offsets with the direction of motion.
    Hysteresis,
    /// A fraction of the other channel, delayed.
    DelayedCrosstalk,
    /// Real motion at a fixed frequency.
    Vibration,
    /// Real motion that goes with the revolution.
    Cogging,
    /// White noise: no cause of the catalogue, but every simulation has it.
    WhiteNoise,
    /// A gain that follows the acceleration: no cause of the catalogue, so it is never the name of a finding.
    AccelerationGain,
}

impl Cause {
    /// As people write it.
    pub(crate) fn plain(self) -> String {
        match self {
            Self::AdcNonlinearity => "ADC nonlinearity".into(),
            Self::AcCoupling => "AC coupling".into(),
            Self::AccelerationGain => "a gain that follows the acceleration".into(),
            Self::Runout => "run-out".into(),
            _ => self.to_string().replace('_', " "),
        }
    }

    /// Whether a finding may have this name: the catalogue lists it.
    pub(crate) fn is_listed(self) -> bool {
        !matches!(self, Self::WhiteNoise | Self::AccelerationGain)
    }

    /// What it does to single codes, which no model of the sensor takes off what is left.
    pub(crate) fn errs_in_codes(self) -> bool {
        matches!(self, Self::StuckBit | Self::CoarseQuantisation)
    }

    /// A curve that a channel has instead of a straight line.
    pub(crate) fn is_a_bend(self) -> bool {
        matches!(self, Self::EvenNonlinearity | Self::OddNonlinearity)
    }

    /// A drift of the offsets or of the gains: slow, as noise may be.
    pub(crate) fn is_drift(self) -> bool {
        matches!(self, Self::OffsetDrift | Self::GainDrift)
    }
}

/// The word that `findings.json` has.
impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.serialize(f)
    }
}

#[cfg(test)]
mod tests {
    use super::Cause;

    #[test]
    fn a_cause_is_written_as_programs_know_it() {
        for (cause, word) in [
            (Cause::AdcNonlinearity, "adc_nonlinearity"),
            (Cause::AcCoupling, "ac_coupling"),
            (Cause::Runout, "runout"),
        ] {
            assert_eq!(cause.to_string(), word);
            assert_eq!(serde_json::json!(cause), word);
        }
    }
}
