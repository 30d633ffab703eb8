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

    /// The calibrated parameters, for signals in their own unit; with bends in the chip's order (see the kernel `bend`),
    /// to first order in the bends.
    pub(crate) fn theta(&self, parameters: usize) -> Vec<f64> {
        let all: Vec<f64> = self.reference.theta().iter().copied().collect();
        if parameters > 5 {
            let (gain, middle) = (1.0 / self.normalise.amplitude, self.normalise.middle);
            let (common, opposite) = ((all[2] + all[6]) / 2.0, (all[2] - all[6]) / 2.0);
            // The chip's bend of third order takes θ9 u off what stands before it.
            let (one, three) = (
                all[0] * gain / (1.0 - opposite),
                all[4] * gain / (1.0 + opposite),
            );
            let mut chip = vec![one, all[3] - one * middle, three, all[7] - three * middle];
            if parameters == 9 {
                chip.push(all[8]);
            }
            chip.extend([all[1], all[5], common, opposite]);
            return chip;
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
