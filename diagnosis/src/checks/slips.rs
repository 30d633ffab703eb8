//! Whether a sample that seems lost or put in is a code at which the ADC jumps, or an angle at which the channels bend fast: where
//! the scale moves slowly, the angle jumps there by what it moves in a sample, or goes back to the code before. The time base is
//! looked at before anything is fitted; once such an error is known, the recording is diagnosed anew with its time base as it is.

use nonius_recording::Recording;

use crate::checks::repair::{Repaired, repair};
use crate::checks::{self, Checked, TimeBase};
use crate::context::ContextError;
use crate::diagnose::{Diagnosis, whole};
use crate::motion::calm::Calm;

/// Samples on either side of a place in which a slip that is not repaired shows.
const REACH: usize = 256;
/// Sum of squares, in units of the noise, that the slips have to be worth: half of what the surest was found by.
const WORTH: f64 = 32.0;
/// Errors of the code or the angle that may look like slips.
const STEEP: [&str; 3] = ["adc_nonlinearity", "spatial_harmonic", "saturation"];

/// A diagnosis, and what it was made of.
pub(crate) struct Looked {
    pub(crate) found: Diagnosis,
    pub(crate) checked: Checked,
    pub(crate) repaired: Repaired,
    pub(crate) calm: Option<Calm>,
}

impl Looked {
    /// Diagnoses all of a recording with its time base repaired as it was checked.
    pub(crate) fn at(recording: &Recording, checked: Checked) -> Result<Self, ContextError> {
        let repaired = repair(recording, &checked);
        let context = repaired.context()?;
        let calm = Calm::of(&context);
        let found = whole(context, &checked, &repaired)?;
        Ok(Self {
            found,
            checked,
            repaired,
            calm,
        })
    }

    /// Sum of squares that is left near samples of the recording, in units of the noise.
    fn left_near(&self, places: &[usize], noise: f64) -> f64 {
        let (radial, tangential) = &self.found.residuals[1];
        // A reference slips with the sensor, and what is between them does not show it.
        let circle = self.found.left_motion.as_ref().unwrap_or(tangential);
        let mut near = vec![false; radial.len()];
        for k in places.iter().map(|k| self.repaired.place[*k]) {
            near[k.saturating_sub(REACH)..(k + REACH).min(radial.len())].fill(true);
        }
        let near = (0..near.len()).filter(|k| near[*k]);
        let square = |k: usize| (radial[k].powi(2) + circle[k].powi(2)) / noise.powi(2);
        near.map(square).sum()
    }

    /// Samples before which some are missing, and those that repeat the one before.
    fn slips(&self) -> Vec<usize> {
        let gaps = self.checked.gaps.iter().map(|gap| gap.0);
        gaps.chain(self.checked.repeated.iter().copied()).collect()
    }

    /// The same without slips that the clock does not show, where steep errors explain them.
    pub(crate) fn without_slips(self, recording: &Recording, weight: Vec<f64>) -> Self {
        let slips = self.slips();
        if slips.is_empty() || !self.is_steep() {
            return self;
        }
        let checked = checks::check(recording, weight, TimeBase::AsItIs);
        // What the clock shows stays as it is.
        let by_clock = |k: &usize| checked.gaps.binary_search_by_key(k, |gap| gap.0).is_ok();
        let slips: Vec<usize> = slips.into_iter().filter(|k| !by_clock(k)).collect();
        if slips.is_empty() {
            return self;
        }
        let Ok(other) = Self::at(recording, checked) else {
            return self;
        };
        let stranger = other.found.unexplained.significant && !self.found.unexplained.significant;
        // Of the radius, in which no axis shakes.
        let radial = &self.found.residuals[1].0;
        let counts: f64 = self.repaired.weight.iter().sum();
        let power: f64 = radial.iter().map(|r| r * r).sum();
        let noise = (power / counts.max(1.0)).sqrt();
        let worth = other.left_near(&slips, noise) - self.left_near(&slips, noise);
        let as_well = other.is_steep() && !stranger && worth < WORTH;
        if as_well { other } else { self }
    }

    fn is_steep(&self) -> bool {
        let mut causes = self.found.findings.iter().map(|f| f.cause.as_str());
        causes.any(|cause| STEEP.contains(&cause))
    }
}
