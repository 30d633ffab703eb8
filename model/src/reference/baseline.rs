//! The open-loop chip of section 2 as a whole: correction by the extremes of the signals, or none, and the arctangent.

use super::arctangent::Arctangent;
use super::extremes::PeriodExtremes;
use super::interpolator::Estimate;
use super::{Parameters, Theta};

/// What corrects the pair before the arctangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Baseline {
    /// A fixed Θ.
    Fixed(Parameters, Theta),
    /// The extremes of each period.
    Extremes(PeriodExtremes),
}

/// Open-loop interpolator: configuration and state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLoop {
    baseline: Baseline,
    ts: f64,
    arctangent: Arctangent,
    before: Option<f64>,
}

impl OpenLoop {
    /// `ts` in seconds.
    #[must_use]
    pub fn new(baseline: Baseline, ts: f64) -> Self {
        Self {
            baseline,
            ts,
            arctangent: Arctangent::default(),
            before: None,
        }
    }

    /// One sample; speed as the difference of two angles. e is zero: there is no loop.
    pub fn step(&mut self, y_c: f64, y_s: f64) -> Estimate {
        let y = [y_c, y_s];
        let (parameters, theta) = match &self.baseline {
            Baseline::Fixed(parameters, theta) => (*parameters, *theta),
            Baseline::Extremes(extremes) => {
                let four = Parameters::Four;
                (four, four.from_five(extremes.theta()))
            }
        };
        let corrected = parameters.corrected(&theta, y);
        let alpha_hat = self.arctangent.step(corrected);
        if let Baseline::Extremes(extremes) = &mut self.baseline {
            extremes.step(y, alpha_hat);
        }
        let speed = self.before.map_or(0.0, |b| (alpha_hat - b) / self.ts);
        self.before = Some(alpha_hat);
        let (turns, phase) = self.arctangent.turns_and_phase();
        Estimate {
            alpha_hat,
            turns,
            phase,
            speed,
            theta,
            e: 0.0,
            rho: corrected[0].hypot(corrected[1]) - 1.0,
            locked: true,
            updated: false,
        }
    }
}
