//! `design.toml`: what the user asks for, in physical units.

mod calibration;
mod correction;
mod large;
mod method;
mod overrides;
mod place;
mod read;

pub use calibration::Calibration;
pub use correction::{Correction, Harmonic};
pub use method::{CalibrationMethod, CalibrationStart};
pub use overrides::Overrides;
pub use place::Place;
pub use read::{SpecError, keys};

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// A design in physical units, as written in `design.toml`. Checked for form, not yet for sense: see
/// [`Design::new`](crate::design::Design::new).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spec {
    /// Name of the chip: a Verilog identifier.
    pub name: String,
    /// One line about it.
    #[serde(default)]
    pub description: String,
    /// The sensor in front of the ADC.
    pub sensor: Sensor,
    /// The ADC.
    pub adc: Adc,
    /// The tracking loop.
    #[serde(rename = "loop")]
    pub tracking: Tracking,
    /// On-line calibration.
    #[serde(default)]
    pub calibration: Calibration,
    /// What is corrected by a number that is known beforehand.
    #[serde(default, skip_serializing_if = "Correction::is_none")]
    pub correction: Correction,
    /// What the chip must reach.
    pub accuracy: Accuracy,
    /// How it is built.
    #[serde(default)]
    pub chip: Chip,
    /// Word lengths that override the chosen ones.
    #[serde(default)]
    pub formats: Overrides,
}

/// `[sensor]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensor {
    /// Nominal amplitude of both signals, in the unit of the ADC's range.
    pub amplitude: f64,
    /// The amplitudes differ from the nominal one by at most this fraction.
    pub amplitude_tolerance: f64,
    /// Largest offset of each channel, as a fraction of the amplitude.
    pub offset_max: f64,
    /// Largest phase error β, degrees.
    pub phase_error_max_deg: f64,
    /// Rms noise of each channel, as a fraction of the amplitude.
    #[serde(default)]
    pub noise_rms: f64,
    /// Largest bend of either channel, as a fraction of the amplitude; what 8 and 9 parameters correct.
    #[serde(default = "bend_max")]
    pub bend_max: f64,
    /// Largest speed, scale periods per second.
    pub speed_max_periods_per_s: f64,
    /// Length of a scale period, metres (linear scales).
    #[serde(default)]
    pub scale_period_m: Option<f64>,
    /// Scale periods per revolution (rotary scales).
    #[serde(default)]
    pub periods_per_revolution: Option<f64>,
}

fn bend_max() -> f64 {
    0.05
}

impl Sensor {
    /// Largest value that either signal may take with tolerance and offset alone, in nominal amplitudes; with the rest see
    /// [`Spec::reach`].
    #[must_use]
    pub fn reach(&self) -> f64 {
        1.0 + self.amplitude_tolerance + self.offset_max
    }
}

impl Spec {
    /// Largest value that either signal takes with all that is promised, in nominal amplitudes, without noise: tolerance and offset at
    /// their ends, bends y + b (2y² − 1) of either sign where they are calibrated, and what the harmonics add to the angle of any phase
    /// error.
    #[must_use]
    pub fn reach(&self) -> f64 {
        /// In a scale period: 128 in a cycle of the highest order.
        const ANGLES: u32 = 2048;
        const BETAS: i32 = 8;
        let s = &self.sensor;
        let most = 1.0 + s.amplitude_tolerance;
        let bend = if self.calibration.has_bend() {
            s.bend_max
        } else {
            0.0
        };
        let reach = |u: f64, more: f64| {
            let bent = [bend, -bend].map(|bend| (u + bend * (2.0 * u * u - 1.0) + more).abs());
            most * bent[0].max(bent[1]) + s.offset_max
        };
        let angles = (0..ANGLES).map(|k| TAU * f64::from(k) / f64::from(ANGLES));
        let of_angle = |alpha: f64| {
            let [cos, sin] = [0, 1].map(|which| self.correction.harmonics_at(which, alpha).0);
            let betas = (-BETAS..=BETAS).map(|k| f64::from(k) / f64::from(BETAS));
            let betas = betas.map(|share| share * s.phase_error_max_deg.to_radians());
            let of_sin = betas.map(|beta| reach((alpha - beta).sin(), sin));
            of_sin.fold(reach(alpha.cos(), cos), f64::max)
        };
        angles.map(of_angle).fold(0.0, f64::max)
    }
}

/// `[adc]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adc {
    /// Resolution, 8 to 18 bits.
    pub bits: u32,
    /// The range is −`full_scale` … +`full_scale` about the middle.
    pub full_scale: f64,
    /// Middle of the range, for one-sided ADCs; in the unit of `full_scale`.
    #[serde(default)]
    pub middle: f64,
    /// Code of the output.
    #[serde(default)]
    pub coding: Coding,
    /// Samples per second, both channels at the same instant.
    pub sample_rate_hz: f64,
}

/// Code of the ADC's output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coding {
    /// Signed.
    #[default]
    TwosComplement,
    /// 0 is the lower end.
    OffsetBinary,
}

/// `[loop]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tracking {
    /// The paper's method: 1, 2 or 3.
    pub method: u32,
    /// Filter poles at 1: 1 or 2.
    #[serde(rename = "type")]
    pub filter_type: u32,
    /// ω0/2π of the closed loop, hertz.
    pub bandwidth_hz: f64,
    /// ξ of the closed loop.
    #[serde(default = "damping")]
    pub damping: f64,
    /// Second pole of a type 1 filter, 0 to 1. Default: p1 p2, which makes Methods 1 and 3 equal to Method 2.
    #[serde(default)]
    pub pole: Option<f64>,
}

fn damping() -> f64 {
    std::f64::consts::FRAC_1_SQRT_2
}

/// `[accuracy]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accuracy {
    /// Rms error of the position after calibration, in scale periods, at slow speed.
    pub rms_periods: f64,
    /// Part of it that the chip's arithmetic may take.
    #[serde(default = "share")]
    pub arithmetic_share: f64,
}

fn share() -> f64 {
    0.05
}

/// `[chip]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chip {
    /// How many multipliers at most: 1, 2, … or "all". The chip has those that its schedule uses.
    #[serde(default)]
    pub multipliers: Multipliers,
    /// Clock, hertz. Default: the slowest that serves the sample rate.
    #[serde(default)]
    pub clock_hz: Option<f64>,
    /// Bits of the period counter, 32 to 44.
    #[serde(default = "count_bits")]
    pub count_bits: u32,
}

fn count_bits() -> u32 {
    32
}

impl Default for Chip {
    fn default() -> Self {
        Self {
            multipliers: Multipliers::default(),
            clock_hz: None,
            count_bits: count_bits(),
        }
    }
}

/// How many multipliers the chip may use; those that never have a product are not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, try_from = "toml::Value")]
pub enum Multipliers {
    /// So many at most.
    Count(u32),
    /// As many as are of use: the fewest with which a sample takes no more clocks than with one for each product.
    All(All),
}

/// The word "all".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum All {
    /// As many multipliers as are of use.
    All,
}

impl TryFrom<toml::Value> for Multipliers {
    type Error = String;

    fn try_from(value: toml::Value) -> Result<Self, String> {
        match &value {
            toml::Value::Integer(n) => u32::try_from(*n).ok().map(Self::Count),
            toml::Value::String(word) => (word == "all").then_some(Self::All(All::All)),
            _ => None,
        }
        .ok_or_else(|| format!("{value}: multipliers are a whole number from 1, or \"all\""))
    }
}

impl Default for Multipliers {
    fn default() -> Self {
        Self::Count(1)
    }
}

impl Multipliers {
    /// Largest number, given how many products a sample has.
    #[must_use]
    pub fn count(self, products: usize) -> usize {
        match self {
            Self::Count(n) => (n as usize).clamp(1, products.max(1)),
            Self::All(_) => products.max(1),
        }
    }
}
