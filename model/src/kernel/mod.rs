//! One sample, formula by formula. Every formula of the chip stands here and nowhere else.
//!
//! Kernels are generic over [`Signal`](crate::signal::Signal); they branch on the structure of the design (which method, how many
//! parameters), never on data.

pub mod bend;
pub mod calibration;
pub mod catch_up;
pub mod coefficients;
pub mod completion;
pub mod correction;
pub mod counted;
pub mod detector;
pub mod followed;
pub mod gather;
pub mod gears;
pub mod gradient;
pub mod harmonics;
pub mod learned;
pub mod lock;
pub mod loop_filter;
pub mod measured;
pub mod position;
pub mod recall;
pub mod sample;
pub mod seen;
pub mod sensitivity;
pub mod sine;
pub mod skew;
pub mod sparse;
pub mod start;
pub mod state;
pub mod step;
pub mod strays;
pub mod sum_of_squares;
pub mod travel;
pub mod waits;

pub use coefficients::{Coefficients, Constant};
pub use sample::{advance, sample};
pub use state::{Input, Probes, State};

use crate::format::{Format, Quantiser};
use crate::rom::Rom;
use crate::spec::Calibration;

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
    /// Which parameters are calibrated, and by what search.
    pub calibration: Calibration,
    /// How far channel skew is corrected; `None`: the sine is sampled with the cosine.
    pub skew: Option<skew::Order>,
    /// Stored harmonics of the scale period; `None`: the channels are pure.
    pub harmonics: Option<harmonics::Harmonics>,
    /// The ADC codes run from 0 (offset binary) instead of around 0.
    pub offset_binary: bool,
    /// Formats of the signals.
    pub formats: Formats,
    /// Sine table.
    pub sine: Rom,
    /// Last loop gear, each of half the bandwidth of the one before; gear 0 is the widest. 0: a single gear.
    pub loop_gears: u32,
    /// The gradient by gains and phase carries the square of the amplitude, ¼ … 1; this power of two brings it near 1.
    pub amplitude_shift: u32,
    /// Speeds are promised at which the radius does not show all, and the phase error is learned from there.
    pub sparse: bool,
    /// The same of the bend of third order that both channels have.
    pub sparse_bends: bool,
}

impl Structure {
    /// Neither bends, nor skew, nor harmonics, nor another gradient than the final form, nor another start than its gears, nor so few samples a
    /// period that the phase error must tell.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        let c = &self.calibration;
        let known = self.skew.is_some() || self.harmonics.is_some();
        c.is_linear_final() && !(known || c.starts() || self.sparse)
    }

    /// Samples in which the loop catches up with motion do not count. A loop of type 1 always lags.
    #[must_use]
    pub fn catches_up(&self) -> bool {
        self.filter_type == 2 && self.calibration.is_on() && self.calibration.settles()
    }
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
    /// The same where half a bit was added before.
    pub signal_rounded: Quantiser,
    /// ρ as it moves the parameters.
    pub residual: Quantiser,
    /// n ρ.
    pub along: Quantiser,
    /// Phase, modulo one turn.
    pub alpha: Quantiser,
    /// Difference of two phases, modulo one turn.
    pub phase_difference: Quantiser,
    /// Phase increment per sample, turns.
    pub rate: Quantiser,
    /// Upper part of the rate, where it is multiplied in two parts (type 1).
    pub rate_high: Quantiser,
    /// Speed as it is multiplied by the delay of the sine, turns per sample.
    pub skew_rate: Quantiser,
    /// Phase by which the sine is sampled later, radians.
    pub skew: Quantiser,
    /// Stored harmonics, as a fraction of the amplitude.
    pub harmonic: Quantiser,
    /// Phase that addresses the sine table.
    pub sine_phase: Quantiser,
    /// The same modulo half a turn, a quarter, and a segment of the table.
    pub sine_modulo: [Quantiser; 3],
    /// Count of whole periods; the unit is the whole range of the counter.
    pub count: Quantiser,
    /// The same modulo four periods.
    pub count_of_four: Quantiser,
    /// θ1, θ3 and θ5 as they are multiplied.
    pub theta: [Quantiser; 3],
    /// θ6 and θ7 as they are multiplied.
    pub theta_bend: Quantiser,
    /// 4 (θ8 ± θ9) as it is multiplied.
    pub theta_cubic: Quantiser,
    /// Accumulators of the nine parameters: deviation from the nominal value.
    pub deviation: [Quantiser; 9],
    /// What is remembered of them.
    pub remembered: [Quantiser; 9],
    /// A gain as it is watched for a fade.
    pub gain_watched: Quantiser,
    /// ∇α̂ of recursion (11) and its increment, radians.
    pub alpha_gradient: Quantiser,
    /// Gathered gradient of the sum of squares, or of the start.
    pub gathered: Quantiser,
    /// Samples in a period of travel.
    pub travel_samples: Quantiser,
    /// Periods solved by least squares.
    pub start_periods: Quantiser,
    /// One step of any parameter: one format, so that one shifter serves all.
    pub step: Quantiser,
    /// Lock level.
    pub level: Quantiser,
    /// Loop gear.
    pub loop_gear: Quantiser,
    /// γ gear.
    pub gamma_gear: Quantiser,
    /// Quiet periods of travel in this γ gear.
    pub gear_periods: Quantiser,
    /// Periods of travel with a large residual.
    pub held_periods: Quantiser,
    /// Samples without lock.
    pub unlocked_samples: Quantiser,
    /// Periods of travel in which the search failed.
    pub failed_periods: Quantiser,
}
