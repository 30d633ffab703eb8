//! The causes that can be simulated, each with the numbers that the diagnosis gives it.

use serde::Deserialize;

use crate::drift::Drift;
use crate::interference::Interference;

/// One `[[cause]]`; amplitudes are fractions of the channel's amplitude, phases those of cos(x + phase).
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
#[allow(
    missing_docs,
    reason = "fields are named as in docs/diagnosis.md, units in their names or above"
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
    /// What is beyond the threshold is compressed; the most particular of the numbers for a rail holds.
    Saturation {
        threshold: f64,
        compression: f64,
        #[serde(default)]
        compression_upper: Option<f64>,
        #[serde(default)]
        compression_lower: Option<f64>,
        #[serde(default)]
        compression_cos_upper: Option<f64>,
        #[serde(default)]
        compression_cos_lower: Option<f64>,
        #[serde(default)]
        compression_sin_upper: Option<f64>,
        #[serde(default)]
        compression_sin_lower: Option<f64>,
    },
    /// One bit of the ADC has a wrong weight.
    AdcNonlinearity {
        bit: f64,
        step_cos: f64,
        step_sin: f64,
    },
    /// A bit of the codes of a channel (both, if none is named) never changes: it is 0 or 1.
    StuckBit {
        bit: f64,
        #[serde(default)]
        channel: Option<Channel>,
        #[serde(default)]
        level: f64,
    },
    /// Codes of a channel (both, if none is named) come in steps of so many, down to the next one.
    CoarseQuantisation {
        step_lsb: f64,
        #[serde(default)]
        channel: Option<Channel>,
        #[serde(default)]
        remainder_lsb: f64,
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
    /// A first-order high pass in both channels, before their offsets.
    AcCoupling { corner_hz: f64 },
    /// A fraction of the other channel, delayed. What shows is their product; a fraction without delay is a phase error and
    /// a gain. Without a delay, the limit of small ones.
    DelayedCrosstalk {
        product_into_cos_s: f64,
        product_into_sin_s: f64,
        #[serde(default)]
        delay_s: f64,
    },
    /// An offset with the sign of the speed; where the scale rests at first, with that of the first motion, or the other one if
    /// `start_side` is negative.
    Hysteresis {
        offset_cos: f64,
        offset_sin: f64,
        #[serde(default = "one")]
        start_side: f64,
    },
    /// A line added to each channel, and its second and third harmonic.
    Interference(Interference),
    /// The amplitude of both channels modulated by a line.
    AmplitudeRipple {
        frequency_hz: f64,
        depth: f64,
        phase: f64,
    },
    /// Offsets that change from one end of the recording to the other.
    OffsetDrift(Drift),
    /// Gains likewise.
    GainDrift(Drift),
    /// The amplitude of both channels modulated with the revolution.
    Runout { order: f64, depth: f64, phase: f64 },
    /// The graduation is off with the revolution: radians of the scale period.
    GraduationError {
        order: f64,
        amplitude: f64,
        phase: f64,
    },
    /// A dip of the amplitude at one place of the revolution, radians.
    Contamination { depth: f64, place: f64, width: f64 },
    /// Noise of each channel in proportion to its signal.
    AmplitudeNoise { rms: f64 },
    /// A random error of the sampling time.
    ClockJitter { rms_s: f64 },
    /// Noise of each channel with a 1/f spectrum, in amplitudes per root hertz at one hertz, one-sided; where it meets the
    /// white noise follows from both.
    FlickerNoise {
        density_at_1_hz: f64,
        #[serde(default)]
        corner_hz: f64,
    },
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
    /// Samples that are missing from the time base, at random places: their share.
    DroppedSamples { share: f64 },
    /// Samples that are those before them once more, at random places: their share.
    RepeatedSamples { share: f64 },
}

fn one() -> f64 {
    1.0
}

/// One of the two channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Channel {
    /// The cosine channel.
    Cos,
    /// The sine channel.
    Sin,
}

impl Channel {
    /// Whether a cause of this channel, or of both if none is named, is in channel 0 (cos) or 1 (sin).
    pub(crate) fn holds(of: Option<Self>, which: usize) -> bool {
        match of {
            None => true,
            Some(Self::Cos) => which == 0,
            Some(Self::Sin) => which == 1,
        }
    }
}
