//! One parameter against its gradient: how fast beside the others, by the present γ, within its range.

use super::{Coefficients, State, Structure};
use crate::signal::{Logic, Signal, Wide};
use crate::spec::CalibrationMethod;

/// log2 of what each component of the gradient is multiplied with beside γ.
///
/// Over a whole period the modes of Mᵀ n nᵀ M are 1/2 for the offsets, 1/2 and 1/4 (sum and difference) for the gains and
/// 1/8 for the phase, the last three times the square of the amplitude at the ADC; that square is taken out to a power of
/// two, which leaves a factor q. These powers make them 1/2, q and q/2, and 2q in the final form.
///
/// The gains' difference is what is slowest. A phase twice as fast, 2q, brings it along: with q from 0.5 to 1.2 five periods are
/// enough. Of all parameters the phase is then the noisiest, so once γ has settled its step is a quarter: q/2. Without phase the
/// difference needs its own help: from each gain's gradient half the other's is taken, which makes
/// sum and difference q/2 and 3q/4.
pub struct Equaliser {
    /// Of θ2 and θ4.
    pub offset: i32,
    /// Of θ1 and θ3.
    pub gain: i32,
    /// Of θ5.
    pub phase: i32,
    /// Of θ6 … θ8.
    pub bend: i32,
}

impl Equaliser {
    /// For the search and the parameters of this structure.
    #[must_use]
    pub fn of(structure: &Structure) -> Self {
        let amplitude = structure.amplitude_shift as i32;
        if structure.calibration.has_bend() {
            // By offset and phase the gradient is made of the estimate, whose amplitude is 1, and the offset's has its
            // factor; the phase is 1/2 like the bends.
            return match structure.calibration.method {
                CalibrationMethod::SumOfSquares => Self {
                    offset: 0,
                    gain: amplitude,
                    phase: 1,
                    bend: -1,
                },
                CalibrationMethod::Batch => Self {
                    offset: -1,
                    gain: amplitude - 2,
                    phase: 1,
                    bend: -1,
                },
                _ => Self {
                    offset: 0,
                    gain: 1 + amplitude,
                    phase: 2,
                    bend: 0,
                },
            };
        }
        let (offset, gain, phase) = match structure.calibration.method {
            CalibrationMethod::Final => (0, 1, 4),
            // What is remembered lags and swings: gains and phase half as fast.
            CalibrationMethod::SumOfSquares => (0, 0, 2),
            // Behind a loop that does not follow, what turns the pair counts too: 1 for the offsets, 1/2 for the gains
            // and 1/4 for the phase, all 1/2 with these.
            CalibrationMethod::Exact => (-1, 0, 1),
            // The inverse of the normal equations, with [3 -1; -1 3] for the gains and 1/4 for the 64 sectors at the
            // first gamma of 1/16: a period is a step of Newton's.
            CalibrationMethod::Batch => (-1, -2, 1),
        };
        Self {
            offset,
            gain: gain + amplitude,
            phase: phase + amplitude,
            bend: 0,
        }
    }
}

const GRADIENT: [&str; 8] = [
    "gradient_1",
    "gradient_2",
    "gradient_3",
    "gradient_4",
    "gradient_5",
    "gradient_6",
    "gradient_7",
    "gradient_8",
];
const STEP: [&str; 8] = [
    "step_1", "step_2", "step_3", "step_4", "step_5", "step_6", "step_7", "step_8",
];

/// Accumulator `i` after a step; at its nominal value where nothing is known of it.
#[inline(always)]
pub fn moved<S: Signal>(
    old: S,
    step: S,
    i: usize,
    nominal: S::Bool,
    k: &Coefficients<S>,
    structure: &Structure,
) -> S {
    let moved = (old - step).quantise(&structure.formats.deviation[i]);
    if structure.calibration.recalls() {
        // It has something better.
        return moved;
    }
    S::select(nominal, k.zero, moved)
}

/// What moves every parameter with a sample.
pub struct Mover<S: Signal> {
    /// They are moved with this sample.
    pub due: S::Bool,
    /// Where the design has a start by least squares: while it runs, by these.
    pub start: Option<(S::Bool, [S; 5])>,
    /// Nothing is known of them.
    pub nominal: S::Bool,
}

impl<S: Signal> Mover<S> {
    /// Accumulator `i` after its step against the gradient; `equaliser`: log2 of what that is multiplied with beside γ.
    #[inline(always)]
    pub fn moved(
        &self,
        i: usize,
        old: S,
        (gradient, equaliser): (S::Wide, i32),
        (state, k, structure): (&State<S>, &Coefficients<S>, &Structure),
    ) -> S {
        if self.due.is_known_false() {
            return moved(old, k.zero, i, self.nominal, k, structure);
        }
        let geared = gradient
            .scale(equaliser - structure.calibration.gamma_first as i32)
            .named(GRADIENT[i])
            .quantise_geared(
                state.gamma_gear,
                1,
                structure.calibration.gears(),
                &structure.formats.step,
            );
        let geared = match &self.start {
            Some((starting, first)) => {
                let first = first.get(i).copied().unwrap_or(k.zero);
                S::select(*starting, first, geared)
            }
            None => geared,
        };
        let step = S::select(self.due, geared, k.zero).named(STEP[i]);
        moved(old, step, i, self.nominal, k, structure)
    }
}
