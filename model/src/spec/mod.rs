//! `design.toml`: what the user asks for, in physical units.

mod correction;
mod large;
mod overrides;
mod place;
mod read;

pub use correction::{Correction, Harmonic};
pub use overrides::Overrides;
pub use place::Place;
pub use read::{SpecError, keys};

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
    /// Largest value that either signal may take with what is promised here, in amplitudes.
    #[must_use]
    pub fn reach(&self) -> f64 {
        1.0 + self.amplitude_tolerance + self.offset_max
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

/// `[calibration]`
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Calibration {
    /// 0 (off), 4 (gains, offsets), 5 (and phase), 8 (4 and bends) or 9 (8 and phase).
    #[serde(default = "five")]
    pub parameters: u32,
    /// Which gradient moves them.
    #[serde(default)]
    pub method: CalibrationMethod,
    /// How the search begins after lock.
    #[serde(default)]
    pub start: CalibrationStart,
    /// The mean gradient of `sum_of_squares` forgets 2^-`forgetting` of itself with each sample: λ = 1 − 2^-`forgetting`.
    #[serde(default = "forgetting")]
    pub forgetting: u32,
    /// Whether 8 and 9 parameters learn the direction that the radius does not show.
    #[serde(default = "yes")]
    pub completion: bool,
    /// γ of that direction is 2^-`completion_gamma` per sample.
    #[serde(default = "completion_gamma")]
    pub completion_gamma: u32,
    /// First γ is 2^-`gamma_first`.
    #[serde(default = "gamma_first")]
    pub gamma_first: u32,
    /// Last γ is 2^-`gamma_last`.
    #[serde(default = "gamma_last")]
    pub gamma_last: u32,
    /// Periods of travel between gears. Default: see [`gear_periods`](Self::gear_periods).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gear_periods: Option<u32>,
    /// |ρ| above this returns to the first γ.
    #[serde(default = "restart")]
    pub restart_residual: f64,
    /// |ρ| above this holds the parameters once γ has settled: the signal may be fading. See [`Spec::hold_residual`].
    #[serde(default = "hold")]
    pub hold_residual: f64,
    /// Where they begin to be held, the parameters go back to what they were some periods before: a fade of the signal takes
    /// nothing along. Two registers for each parameter.
    #[serde(default)]
    pub recall: bool,
}

fn five() -> u32 {
    5
}
fn forgetting() -> u32 {
    3
}
fn yes() -> bool {
    true
}
fn completion_gamma() -> u32 {
    10
}
fn gamma_first() -> u32 {
    4
}
fn gamma_last() -> u32 {
    10
}
fn restart() -> f64 {
    0.25
}

fn hold() -> f64 {
    0.0625
}

impl Spec {
    /// |ρ| from which parameters are held: as the design says, and at least what noise (six σ) and a phase error that is not
    /// calibrated (sin β sin 2α / 2, and a quarter of that) leave in the radius.
    #[must_use]
    pub fn hold_residual(&self) -> f64 {
        let phase = match self.calibration.parameters {
            5 | 9 => 0.0,
            _ => 0.625 * self.sensor.phase_error_max_deg.to_radians().sin(),
        };
        let left = 6.0 * self.sensor.noise_rms + phase;
        self.calibration.hold_residual.max(left)
    }
}

impl Calibration {
    /// Whether the search is the final form with four or five parameters.
    #[must_use]
    pub fn is_linear_final(&self) -> bool {
        self.method == CalibrationMethod::Final && self.parameters < 8
    }

    /// Periods of travel between gears: as the design says, or what is soonest below 1 % of the first miscalibration. The final
    /// form with four and five parameters is still quick in the fourth period; the others swing or are noisy there.
    #[must_use]
    pub fn gear_periods(&self) -> u32 {
        self.gear_periods
            .unwrap_or(if self.is_linear_final() { 4 } else { 3 })
    }

    /// Which of θ1 … θ9 are calibrated.
    #[must_use]
    pub fn thetas(&self) -> &'static [usize] {
        match self.parameters {
            0 => &[],
            4 => &[1, 2, 3, 4],
            5 => &[1, 2, 3, 4, 5],
            8 => &[1, 2, 3, 4, 6, 7, 8, 9],
            _ => &[1, 2, 3, 4, 5, 6, 7, 8, 9],
        }
    }
}

/// The gradient searches of the paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationMethod {
    /// The residual gradient in its final form (5.5.1): along the radius.
    #[default]
    Final,
    /// The residual gradient with the recursion (11).
    Exact,
    /// The sum of squares (5.2, 5.3) with a forgetting factor.
    SumOfSquares,
    /// The sum of squares, gathered over a period of travel before each update.
    Batch,
}

/// How the calibration begins after lock, and again where the residual shows that the signal has changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CalibrationStart {
    /// With the largest γ.
    #[default]
    Gears,
    /// Θ by linearised least squares over each of the first two periods of travel, then the gears.
    LeastSquares,
}

impl Default for Calibration {
    fn default() -> Self {
        Self {
            parameters: five(),
            method: CalibrationMethod::default(),
            start: CalibrationStart::default(),
            forgetting: forgetting(),
            completion: yes(),
            completion_gamma: completion_gamma(),
            gamma_first: gamma_first(),
            gamma_last: gamma_last(),
            gear_periods: None,
            restart_residual: restart(),
            hold_residual: hold(),
            recall: false,
        }
    }
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
    /// How many multipliers: 1, 2, … or "all".
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

/// How many multipliers the chip may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "multipliers are a whole number from 1, or \"all\""
)]
pub enum Multipliers {
    /// So many.
    Count(u32),
    /// One for each product.
    All(All),
}

/// The word "all".
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum All {
    /// One multiplier for each product.
    All,
}

impl Default for Multipliers {
    fn default() -> Self {
        Self::Count(1)
    }
}

impl Multipliers {
    /// The number, given how many products a sample has.
    #[must_use]
    pub fn count(self, products: usize) -> usize {
        match self {
            Self::Count(n) => (n as usize).clamp(1, products.max(1)),
            Self::All(_) => products.max(1),
        }
    }
}
