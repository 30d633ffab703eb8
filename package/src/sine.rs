//! The error of sine and cosine, measured over every phase.

use std::f64::consts::TAU;

use nonius_model::bits::Bits;
use nonius_model::design::Design;
use nonius_model::kernel::sine::sine;
use serde::Serialize;

/// Phases up to this many bits are all tried; of longer ones every so many.
const EXHAUSTIVE_BITS: u32 = 22;

/// Largest errors of sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SineError {
    /// Of sine and of cosine.
    pub largest: f64,
    /// Of the angle that the pair points to, in turns.
    pub largest_angle_turns: f64,
    /// Every phase was tried.
    pub exhaustive: bool,
    /// Phases tried.
    pub phases: u64,
}

/// The phases of so many bits that are tried, and whether these are all.
pub(crate) fn phases(bits: u32) -> (bool, impl Iterator<Item = u64>) {
    let step = 1u64 << bits.saturating_sub(EXHAUSTIVE_BITS);
    // An odd stride reaches every position within a segment.
    let stride = if step == 1 { 1 } else { step + 1 };
    (step == 1, (0..1u64 << bits).step_by(stride as usize))
}

/// Sine and cosine against the exact ones, for every phase of the sine unit (each stands for the middle of what it
/// cuts off).
#[must_use]
pub fn sine_error(design: &Design) -> SineError {
    let (coefficients, structure) = (design.constants.bits(), &design.structure);
    let bits = structure.formats.sine_phase.format.fraction;
    let (exhaustive, places) = phases(bits);
    let mut result = SineError {
        largest: 0.0,
        largest_angle_turns: 0.0,
        exhaustive,
        phases: 0,
    };
    for phase in places {
        let exact = (phase as f64 + 0.5) / 2f64.powi(bits as i32) * TAU;
        let (s, c) = sine(Bits::from_raw(phase as i64, bits), &coefficients, structure);
        let (s, c) = (s.to_f64(), c.to_f64());
        let (sin, cos) = exact.sin_cos();
        let worst = (s - sin).abs().max((c - cos).abs());
        result.largest = result.largest.max(worst);
        let angle = (s * cos - c * sin).atan2(c * cos + s * sin) / TAU;
        result.largest_angle_turns = result.largest_angle_turns.max(angle.abs());
        result.phases += 1;
    }
    result
}
