//! Whether a sample that seems lost or put in is a code at which the ADC jumps: where the scale moves slowly, the angle jumps
//! there by what it moves in a sample, or goes back to the code before. The time base is looked at before anything is fitted;
//! once the ADC's steps are known, the recording is diagnosed anew with its time base as it is.

use std::ops::Range;

use nonius_recording::Recording;

use crate::checks::{self, Checked, TimeBase};
use crate::context::{Context, ContextError};
use crate::diagnose::{Diagnosis, whole};
use crate::repair::{Repaired, repair};

/// Samples on either side of a place in which a slip that is not repaired shows.
const REACH: usize = 256;
/// Sum of squares, in units of the noise, that the slips have to be worth: half of what the surest was found by.
const WORTH: f64 = 32.0;
/// Steps against code.
const ADC: &str = "adc_nonlinearity";

/// A diagnosis, and what it was made of.
pub(crate) struct Looked {
    pub(crate) found: Diagnosis,
    pub(crate) checked: Checked,
    pub(crate) repaired: Repaired,
}

impl Looked {
    /// Diagnoses all of a recording with its time base repaired as it was checked.
    pub(crate) fn at(
        recording: &Recording,
        checked: Checked,
        context: impl Fn(&Repaired) -> Result<Context, ContextError>,
    ) -> Result<Self, ContextError> {
        let repaired = repair(recording, &checked);
        let found = whole(context(&repaired)?, &checked, &repaired)?;
        Ok(Self {
            found,
            checked,
            repaired,
        })
    }

    /// Sum of squares that is left near samples of the recording, in units of the noise.
    fn left_near(&self, places: &[usize], noise: f64) -> f64 {
        let (radial, tangential) = &self.found.residuals[1];
        // A reference slips with the sensor, and what is between them does not show it.
        let circle = self.found.left_motion.as_ref().unwrap_or(tangential);
        let near = |k: &usize| -> Range<usize> {
            let k = self.repaired.place[*k];
            k.saturating_sub(REACH)..(k + REACH).min(radial.len())
        };
        let square = |k: usize| (radial[k].powi(2) + circle[k].powi(2)) / noise.powi(2);
        places.iter().flat_map(near).map(square).sum()
    }

    /// Samples before which some are missing, and those that were put in.
    fn slips(&self) -> Vec<usize> {
        let gaps = self.checked.gaps.iter().map(|gap| gap.0);
        gaps.chain(self.checked.extra.iter().copied()).collect()
    }

    /// The same without slips that the clock does not show, where the ADC's steps explain them.
    pub(crate) fn without_slips(
        self,
        recording: &Recording,
        weight: Vec<f64>,
        context: impl Fn(&Repaired) -> Result<Context, ContextError>,
    ) -> Result<Self, ContextError> {
        if !self.found.findings.iter().any(|f| f.cause == ADC) {
            return Ok(self);
        }
        let checked = checks::check(recording, weight, TimeBase::AsItIs);
        if checked.findings.len() == self.checked.findings.len() {
            return Ok(self);
        }
        let other = Self::at(recording, checked, context)?;
        let steps = other.found.findings.iter().any(|f| f.cause == ADC);
        let stranger = other.found.unexplained.significant && !self.found.unexplained.significant;
        let (slips, noise) = (self.slips(), self.found.extended.residual_rms);
        let worth = other.left_near(&slips, noise) - self.left_near(&slips, noise);
        let as_well = steps && !stranger && worth < WORTH;
        Ok(if as_well { other } else { self })
    }
}
