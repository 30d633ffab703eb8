//! The causes that can be simulated, each with the numbers that the diagnosis gives it.

use serde::Deserialize;

/// One `[[cause]]`; amplitudes are fractions of the channel's amplitude, phases those of cos(x + phase).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
#[allow(
    missing_docs,
    reason = "fields are named as in DESIGN's catalogue, units in their names or above"
)]
pub enum Cause {
    /// y + k y².
    EvenNonlinearity { k_cos: f64, k_sin: f64 },
    /// y + k y³.
    OddNonlinearity { k_cos: f64, k_sin: f64 },
    /// An order of the scale period in each channel.
    SpatialHarmonic {
        order: f64,
        amplitude_cos: f64,
        phase_cos: f64,
        amplitude_sin: f64,
        phase_sin: f64,
    },
    /// What is beyond the threshold is compressed, at both rails.
    Saturation { threshold: f64, compression: f64 },
    /// One bit of the ADC has a wrong weight.
    AdcNonlinearity {
        bit: f64,
        step_cos: f64,
        step_sin: f64,
    },
    /// sin is sampled later than cos.
    ChannelSkew { delay_s: f64 },
    /// A first-order low pass in one channel.
    BandwidthMismatch {
        #[serde(default)]
        tau_cos_s: f64,
        #[serde(default)]
        tau_sin_s: f64,
    },
    /// The same low pass in both channels.
    CommonBandwidth { tau_s: f64 },
    /// Both channels are late.
    Latency { delay_s: f64 },
    /// An offset with the sign of the speed.
    Hysteresis { offset_cos: f64, offset_sin: f64 },
    /// A line added to each channel.
    Interference {
        frequency_hz: f64,
        amplitude_cos: f64,
        phase_cos: f64,
        amplitude_sin: f64,
        phase_sin: f64,
    },
    /// The amplitude of both channels modulated by a line.
    AmplitudeRipple {
        frequency_hz: f64,
        depth: f64,
        phase: f64,
    },
    /// Offsets that change evenly from one end to the other.
    OffsetDrift { change_cos: f64, change_sin: f64 },
    /// Gains likewise.
    GainDrift { change_cos: f64, change_sin: f64 },
    /// The amplitude of both channels modulated with the revolution.
    Runout { order: f64, depth: f64, phase: f64 },
    /// A dip of the amplitude at one place of the revolution, radians.
    Contamination { depth: f64, place: f64, width: f64 },
    /// Noise of each channel in proportion to its signal.
    AmplitudeNoise { rms: f64 },
    /// A random error of the sampling time.
    ClockJitter { rms_s: f64 },
    /// The axis vibrates: radians of the scale period.
    Vibration {
        frequency_hz: f64,
        amplitude: f64,
        phase: f64,
    },
    /// The axis moves unevenly with the revolution: radians of the scale period.
    Cogging {
        order: f64,
        amplitude: f64,
        phase: f64,
    },
    /// Isolated samples far off: their share, and by how much in the unit of the signals.
    Glitches { share: f64, largest: f64 },
}
