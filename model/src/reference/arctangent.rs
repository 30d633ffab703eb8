//! Section 2: the open-loop arctangent, the baseline of every comparison.

use std::f64::consts::TAU;

/// α̂ = arctan(s/c) in all four quadrants, unwrapped to the nearest turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arctangent {
    turns: i64,
    phase: Option<f64>,
}

impl Arctangent {
    /// The next α̂, radians: continues from the last by less than half a turn.
    pub fn step(&mut self, corrected: [f64; 2]) -> f64 {
        let phase = corrected[1].atan2(corrected[0]);
        if let Some(before) = self.phase {
            self.turns -= ((phase - before) / TAU).round() as i64;
        }
        self.phase = Some(phase);
        self.turns as f64 * TAU + phase
    }

    /// The last α̂ as whole turns and the phase, −π … π, that remains.
    #[must_use]
    pub fn turns_and_phase(&self) -> (i64, f64) {
        (self.turns, self.phase.unwrap_or(0.0))
    }
}
