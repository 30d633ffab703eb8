//! The paper's system in floating point with the numbers of a design.

use anyhow::{Context, Result};
use nonius_model::design::Design;
use nonius_model::reference::from_spec::{self, Normalise};
use nonius_model::reference::{Estimate, Reference};

/// The reference of a design, for signals in the unit of its ADC's range.
pub(crate) struct Paper {
    reference: Reference,
    normalise: Normalise,
}

impl Paper {
    /// As the design says.
    pub(crate) fn of(design: &Design) -> Result<Self> {
        let config =
            from_spec::config(&design.spec).context("the paper cannot build this design")?;
        Ok(Self {
            reference: Reference::new(config).context("the paper cannot build this design")?,
            normalise: Normalise::of(&design.spec),
        })
    }

    /// What is known before the next sample; speed in radians per sample.
    pub(crate) fn expected(&self) -> (Estimate, f64) {
        let known = self.reference.expected();
        (known, known.speed * self.reference.tracking().config.ts)
    }

    /// The first parameters, for signals in their own unit; those of sections 5.4 for y, the signals in units of the
    /// nominal amplitude.
    pub(crate) fn theta(&self, parameters: usize) -> Vec<f64> {
        let all: Vec<f64> = self.reference.theta().iter().copied().collect();
        if parameters > 5 {
            return all[..parameters].to_vec();
        }
        let five = [all[0], all[1], all[2], all[3], all[4]];
        self.normalise.theta_of_signals(five)[..parameters].to_vec()
    }

    /// One sample.
    pub(crate) fn step(&mut self, cos: f64, sin: f64) {
        let (y_c, y_s) = (self.normalise.y(cos), self.normalise.y(sin));
        self.reference.step(y_c, y_s);
    }
}
