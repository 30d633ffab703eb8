//! Whether a sample that seems lost or put in is a code at which the ADC jumps, or an angle at which the channels bend fast: where
//! the scale moves slowly, the angle jumps there by what it moves in a sample, or goes back to the code before. The time base is
//! looked at before anything is fitted; once such an error is known, the recording is diagnosed anew with its time base as it is.

use nonius_recording::Recording;

use crate::checks::repair::{Repaired, repair};
use crate::checks::{self, Checked, TimeBase};
use crate::context::ContextError;
use crate::diagnose::{Diagnosis, whole};
use crate::finding::Cause;
use crate::motion::calm::Calm;

/// Samples on either side of a place in which a slip that is not repaired shows.
const REACH: usize = 256;
/// Samples on either side of it between which the angle jumps.
const SIDES: [usize; 3] = [4, 16, 64];
/// Sum of squares, each in units of what is usual, that the slips have to be worth, of up to so many: half of what the surest was found by.
/// By chance the sum of more goes further with their root.
const WORTH: f64 = 32.0;
const UP_TO: f64 = 16.0;
/// Errors of the code or the angle that may look like slips.
const STEEP: [Cause; 5] = [
    Cause::AdcNonlinearity,
    Cause::SpatialHarmonic,
    Cause::EvenNonlinearity,
    Cause::OddNonlinearity,
    Cause::Saturation,
];

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

    /// How much slips show in what is left near samples of the recording, in units of the noise: as a sum of squares along the radius, and
    /// as squares of the jumps of the angle there.
    fn left_near(&self, places: &[usize], noise: f64) -> f64 {
        let (radial, tangential) = &self.found.residuals[1];
        // A reference slips with the sensor, and what is between them does not show it.
        let circle = self.found.left_motion.as_ref().unwrap_or(tangential);
        let jumps = Jumps::of(circle, &self.repaired.weight);
        let places: Vec<usize> = places.iter().map(|k| self.repaired.place[*k]).collect();
        let mut near = vec![false; radial.len()];
        for k in &places {
            near[k.saturating_sub(REACH)..(k + REACH).min(radial.len())].fill(true);
        }
        let near = (0..near.len()).filter(|k| near[*k]);
        let along_radius: f64 = near.map(|k| (radial[k] / noise).powi(2)).sum();
        along_radius + places.iter().map(|k| jumps.at(*k)).sum::<f64>()
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
        let noise = rms(&self.found.residuals[1].0, &self.repaired.weight);
        let worth = other.left_near(&slips, noise) - self.left_near(&slips, noise);
        let asked = WORTH * (slips.len() as f64 / UP_TO).sqrt().max(1.0);
        let as_well = other.is_steep() && !stranger && worth < asked;
        if as_well { other } else { self }
    }

    fn is_steep(&self) -> bool {
        let mut all = self.found.findings.iter();
        all.any(|f| STEEP.contains(&f.cause))
    }
}

/// How values jump: between the means of so many samples that count on either side.
struct Jumps {
    /// Sums of values that count, and their numbers, before each sample.
    sums: Vec<(f64, f64)>,
    /// Mean square of the jumps at all samples, by how many there are on a side. What an axis at work leaves goes to and fro everywhere.
    usual: [f64; SIDES.len()],
}

impl Jumps {
    fn of(values: &[f64], weight: &[f64]) -> Self {
        let mut sums = vec![(0.0, 0.0)];
        let (mut sum, mut count) = (0.0, 0.0);
        for (value, weight) in values.iter().zip(weight) {
            sum += value * weight;
            count += weight;
            sums.push((sum, count));
        }
        let mut this = Self {
            sums,
            usual: [1.0; SIDES.len()],
        };
        this.usual = SIDES.map(|side| {
            let squares: f64 = (0..values.len()).map(|k| this.jump(k, side).powi(2)).sum();
            (squares / values.len().max(1) as f64).max(f64::MIN_POSITIVE)
        });
        this
    }

    fn jump(&self, at: usize, side: usize) -> f64 {
        let mean = |from: usize, to: usize| {
            let ((before, few), (after, many)) = (self.sums[from], self.sums[to]);
            (many > few).then(|| (after - before) / (many - few))
        };
        let last = self.sums.len() - 1;
        let before = mean(at.saturating_sub(side), at);
        let after = mean(at, (at + side).min(last));
        before
            .zip(after)
            .map_or(0.0, |(before, after)| after - before)
    }

    /// The square of the clearest jump at a sample, over what is usual.
    fn at(&self, at: usize) -> f64 {
        let each = SIDES.iter().zip(self.usual);
        let over = each.map(|(side, usual)| self.jump(at, *side).powi(2) / usual);
        over.fold(0.0, f64::max)
    }
}

/// Rms of what samples that count have.
fn rms(values: &[f64], weight: &[f64]) -> f64 {
    let counts: f64 = weight.iter().sum();
    let power: f64 = values.iter().map(|v| v * v).sum();
    (power / counts.max(1.0)).sqrt()
}
