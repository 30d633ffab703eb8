//! The open-loop arctangent of section 2: the baseline of every comparison.

use std::f64::consts::TAU;

/// Unwrapped arctangent of sin over cos.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arctangent {
    last: Option<f64>,
}

impl Arctangent {
    /// The angle of the pair in radians, continued from the one before by less than half a turn.
    pub fn step(&mut self, cos: f64, sin: f64) -> f64 {
        let angle = sin.atan2(cos);
        let angle = match self.last {
            Some(last) => angle + TAU * ((last - angle) / TAU).round(),
            None => angle,
        };
        self.last = Some(angle);
        angle
    }
}
