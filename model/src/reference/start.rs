//! How α̂ starts. From rest into a fast signal a narrow loop may never lock; the paper does not say.

use std::f64::consts::TAU;

use super::arctangent::Arctangent;
use super::interpolator::Estimate;
use super::loops::{Loop, LoopConfig};
use super::{ReferenceError, Theta};

/// Where the loop begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// In this state: α̂_0 and e_{−1} in radians, speed in radians per second.
    At {
        /// α̂_0.
        alpha_hat: f64,
        /// Speed.
        speed: f64,
        /// e_{−1}.
        e_1: f64,
    },
    /// From the open-loop arctangent: a straight line through so many samples gives α̂ and speed.
    Arctangent {
        /// At least 2.
        samples: u32,
    },
}

impl Start {
    pub(super) fn begin(
        self,
        tracking: LoopConfig,
    ) -> Result<(Loop, Option<Acquisition>), ReferenceError> {
        match self {
            Self::At {
                alpha_hat,
                speed,
                e_1,
            } => Ok((Loop::moving(tracking, alpha_hat, speed, e_1), None)),
            Self::Arctangent { samples } if samples >= 2 => {
                let tracking = Loop::new(tracking);
                Ok((tracking, Some(Acquisition::after(samples, &tracking))))
            }
            Self::Arctangent { .. } => Err(ReferenceError::Impossible(
                "a speed takes at least two samples of the arctangent",
            )),
        }
    }
}

/// The straight line, as far as it has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Acquisition {
    wanted: u32,
    arctangent: Arctangent,
    /// α̂ of the loop that went astray, whole turns.
    turns: i64,
    /// Samples so far; first angle; Σ φ and Σ k φ with φ the angle less the first.
    seen: u32,
    first: f64,
    sum: f64,
    moment: f64,
    /// What the last sample said.
    last: Estimate,
}

/// Below this radius the pair tells no angle.
const WEAK: f64 = 0.25;

impl Acquisition {
    pub(super) fn after(samples: u32, tracking: &Loop) -> Self {
        let (turns, phase) = tracking.turns_and_phase();
        Self {
            wanted: samples,
            arctangent: Arctangent::default(),
            last: Estimate {
                alpha_hat: tracking.alpha_hat(),
                turns,
                phase,
                speed: 0.0,
                theta: Theta::zeros(),
                e: 0.0,
                rho: 0.0,
                locked: false,
                updated: false,
            },
            turns,
            seen: 0,
            first: 0.0,
            sum: 0.0,
            moment: 0.0,
        }
    }

    /// What the last sample said, one sample on at the speed known so far.
    pub(super) fn expected(&self, ts: f64) -> Estimate {
        let moved = self.last.phase + self.last.speed * ts;
        let turns = (moved / TAU).round();
        Estimate {
            alpha_hat: self.last.alpha_hat + self.last.speed * ts,
            turns: self.last.turns + turns as i64,
            phase: moved - turns * TAU,
            ..self.last
        }
    }

    /// One corrected pair; the loop, when the line is done.
    pub(super) fn step(
        &mut self,
        corrected: [f64; 2],
        config: LoopConfig,
    ) -> (Estimate, Option<Loop>) {
        let (seen, found) = self.extend(corrected, config);
        self.last = seen;
        (seen, found)
    }

    fn extend(&mut self, corrected: [f64; 2], config: LoopConfig) -> (Estimate, Option<Loop>) {
        let radius = corrected[0].hypot(corrected[1]);
        let angle = self.arctangent.step(corrected);
        let (turns, phase) = self.arctangent.turns_and_phase();
        let mut estimate = Estimate {
            alpha_hat: angle + self.turns as f64 * TAU,
            turns: turns + self.turns,
            phase,
            speed: 0.0,
            theta: Theta::zeros(),
            e: 0.0,
            rho: radius - 1.0,
            locked: false,
            updated: false,
        };
        if radius < WEAK {
            self.seen = 0;
            return (estimate, None);
        }
        if self.seen == 0 {
            (self.first, self.sum, self.moment) = (angle, 0.0, 0.0);
        }
        let k = f64::from(self.seen);
        self.sum += angle - self.first;
        self.moment += k * (angle - self.first);
        self.seen += 1;
        if self.seen < 2 {
            return (estimate, None);
        }
        let n = k + 1.0;
        // Least squares: slope = Σ (k − k̄) φ / Σ (k − k̄)².
        let middle = k / 2.0;
        let slope = (self.moment - middle * self.sum) / (n * (n * n - 1.0) / 12.0);
        estimate.speed = slope / config.ts;
        if self.seen < self.wanted {
            return (estimate, None);
        }
        let next = self.first + self.sum / n + slope * (n - middle) + self.turns as f64 * TAU;
        (
            estimate,
            Some(Loop::moving(config, next, estimate.speed, 0.0)),
        )
    }
}
