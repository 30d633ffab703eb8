//! What really moves: the drive without what shakes the axis, and what only a reference shows.

use std::borrow::Cow;

use crate::context::Context;
use crate::motion::spline::Spline;
use crate::numerics::slopes::gradient;
use crate::numerics::solve::dot;

/// So near to one, what the angle does for each radian that its reference moves fast has to be, or that motion is noise.
const FOLLOWS: f64 = 0.1;

impl Context {
    /// Acceleration of the drive, radians per second squared: where the axis shakes, [`Self::acceleration`] is that of the
    /// shaking.
    pub(crate) fn drive_acceleration(&self) -> Vec<f64> {
        let Some((motion, fit)) = self.drive() else {
            return self.acceleration.clone();
        };
        let speed = self.change_of_moves(&motion, &motion.derivative(&fit));
        let per_sample = gradient(&speed).into_iter();
        per_sample.map(|a| a * self.rate * self.rate).collect()
    }

    /// The angle of the drive, radians: where the axis shakes, [`Self::alpha`] is that of the shaking.
    pub(crate) fn drive_angle(&self) -> Vec<f64> {
        let drive = self.drive();
        drive.map_or_else(|| self.alpha.clone(), |(motion, fit)| motion.values(&fit))
    }

    /// The drive, where the axis shakes: a spline, and its coefficients.
    fn drive(&self) -> Option<(Cow<'_, Spline>, Vec<f64>)> {
        self.finer.as_ref()?;
        Some(self.fitted(self.spline.as_ref()?, &self.slow()))
    }

    /// The change per sample of what really moves, of a spline of the angle of which that is `change`. Two derivatives of the angle hold so
    /// much of its noise on a slow axis that errors against a reference, which hold it as well, would follow the acceleration: as much of
    /// the errors is taken off as is the angle's, so that what is left of the noise goes with neither.
    pub(crate) fn change_of_moves(&self, spline: &Spline, change: &[f64]) -> Vec<f64> {
        let Some(against) = &self.against_reference else {
            return change.to_vec();
        };
        let change_of = |values: &[f64]| spline.derivative(&spline.fit(values, &self.weight));
        let bends = |change: &[f64]| gradient(change).iter().map(|b| b * b).sum::<f64>();
        let errors = change_of(against);
        // The radius has the same noise as the angle.
        let noise = bends(&change_of(&self.radial()));
        let own = (noise / bends(&errors).max(f64::MIN_POSITIVE)).min(1.0);
        let pairs = change.iter().zip(errors);
        pairs.map(|(c, e)| c - own * e).collect()
    }

    /// What else of the fast motion a reference shows; nothing where the angle does not move with it, for then it is the
    /// reference's noise.
    pub(crate) fn shown_by_reference(&self) -> Vec<f64> {
        let (Some(against), Some(spline)) = (&self.against_reference, &self.spline) else {
            return vec![];
        };
        let unknown = |k: usize| self.measured[k] - self.fast[k];
        let angle: Vec<f64> = (0..self.samples()).map(unknown).collect();
        let moves: Vec<f64> = angle.iter().zip(against).map(|(a, d)| a - d).collect();
        let own = spline.residual(&angle, &self.weight);
        let moves = spline.residual(&moves, &self.weight);
        let square = dot(&moves, &moves).max(f64::MIN_POSITIVE);
        let follows = dot(&own, &moves) / square;
        let apart: Vec<f64> = own.iter().zip(&moves).map(|(o, m)| o - m).collect();
        let error = (dot(&apart, &apart) / self.samples() as f64 / square).sqrt();
        let real = (follows - 1.0).abs() < FOLLOWS && error < FOLLOWS / 3.0;
        if real { moves } else { vec![] }
    }
}
