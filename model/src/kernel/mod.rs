//! One sample, formula by formula. Every formula of the chip stands here and nowhere else.
//!
//! Kernels are generic over [`Signal`]; they branch on the structure of the design (which method, how many
//! parameters), never on data.

pub mod calibration;
pub mod coefficients;
pub mod correction;
pub mod detector;
pub mod lock;
pub mod loop_filter;
pub mod position;
pub mod sample;
pub mod sine;
pub mod state;
pub mod travel;

pub use coefficients::{Coefficients, Constant};
pub use sample::sample;
pub use state::{Input, Probes, State};

use crate::format::{Format, Quantiser};
use crate::rom::Rom;

/// The loop filter of the paper, section 4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Second-order filter, speed as the derivative of the position (4.1).
    One,
    /// First-order stage and integrator; type 1 only (4.2).
    Two,
    /// Second-order stage and integrator, speed for free (4.3).
    Three,
}

/// What the kernels are built from: structure and formats. The numbers are in [`Coefficients`].
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// The paper's method.
    pub method: Method,
    /// Poles of the filter at 1: 1 or 2.
    pub filter_type: u32,
    /// Calibrated parameters: 0 (none), 4 or 5.
    pub parameters: u32,
    /// The ADC codes run from 0 (offset binary) instead of around 0.
    pub offset_binary: bool,
    /// Formats of the signals.
    pub formats: Formats,
    /// Sine table.
    pub sine: Rom,
    /// Last loop gear; gear 0 is the widest bandwidth. 0: a single gear.
    pub loop_gears: u32,
    /// Each loop gear divides the bandwidth by 2^`loop_stride`.
    pub loop_stride: u32,
    /// First γ is 2^-`gamma_first`.
    pub gamma_first: u32,
    /// Last γ gear; each halves γ.
    pub gamma_gears: u32,
}

/// Formats of the signals; [`Format`] for registers and inputs, [`Quantiser`] for results.
#[derive(Clone, Debug, PartialEq)]
pub struct Formats {
    /// ADC code as it arrives; the unit is the ADC's range, so that every width fits the container.
    pub adc: Format,
    /// Normalised ADC signals `y_c`, `y_s`.
    pub y: Format,
    /// Every signal of the sample: corrected pair, sine pair, phase error, radial residual.
    pub signal: Quantiser,
    /// Phase and its increments.
    pub alpha: Format,
    /// Phase increment per sample, turns.
    pub rate: Quantiser,
    /// Upper part of the rate, where it is multiplied in two parts (type 1).
    pub rate_high: Quantiser,
    /// Phase that addresses the sine table.
    pub sine_phase: Quantiser,
    /// Count of whole periods; the unit is the whole range of the counter.
    pub count: Format,
    /// θ1, θ3 and θ5 as they are multiplied.
    pub theta: [Quantiser; 3],
    /// Accumulators of the five parameters: deviation from the nominal value.
    pub deviation: [Quantiser; 5],
    /// One step of any parameter: one format, so that one shifter serves all.
    pub step: Quantiser,
    /// Lock level.
    pub level: Quantiser,
    /// Loop gear.
    pub loop_gear: Format,
    /// γ gear.
    pub gamma_gear: Format,
    /// Periods travelled in this γ gear.
    pub gear_periods: Format,
}
