//! What the model leaves of a recording, and what parts of it do, sample by sample.

use std::ops::Range;

use super::{Fit, System, amounts};
use crate::context::Context;
use crate::finding::Effect;
use crate::shapes::library::{Row, Shape};

/// What the model so far leaves of the recording.
#[derive(Clone, Debug)]
pub(crate) struct Residual {
    /// Along the radius, in amplitudes.
    pub radial: Vec<f64>,
    /// Along the circle, in radians: above the motion, or against the reference.
    pub tangential: Vec<f64>,
    /// What moves faster than the spline, in radians: where real vibration shows; `None` where it is the tangential
    /// residual.
    pub motion: Option<Vec<f64>>,
}

impl Residual {
    /// Where real vibration shows.
    pub(crate) fn fast(&self) -> &[f64] {
        self.motion.as_deref().unwrap_or(&self.tangential)
    }
}

/// What of a residual tells where a line stands, its noise being of some colour.
pub(crate) struct Weighed {
    /// Radial and tangential residual, weighed as the likelihood does: a line in the channels stands out of both together.
    pub(crate) matched: [Vec<f64>; 2],
    /// The unpredictable part of what moves faster than the spline.
    pub(crate) fast: Vec<f64>,
}

impl System<'_> {
    /// A residual weighed by its noise, where the axis vibrates.
    pub(crate) fn weighed(&self, residual: &Residual) -> Option<Weighed> {
        let [radial, tangential, motion] = &self.samples.whiteners;
        // A reference shows the axis by itself.
        let (axis, shakes) = match residual.motion {
            Some(_) => (motion, !motion.is_white()),
            None => (tangential, self.vibrates()),
        };
        if !shakes {
            return None;
        }
        Some(Weighed {
            matched: [
                radial.matched(&residual.radial),
                tangential.matched(&residual.tangential),
            ],
            fast: axis.unpredictable(residual.fast()),
        })
    }

    /// What a fit leaves.
    pub(crate) fn residual(&self, fit: &Fit) -> Residual {
        self.left(&fit.amounts())
    }

    /// What shapes that are fitted together leave where those of a range are not taken off: the others are as they are beside them.
    pub(crate) fn left_but(&self, shapes: Vec<Shape>, range: Range<usize>) -> Residual {
        let mut fit = self.fit(shapes);
        fit.solution.x[range].fill(0.0);
        self.residual(&fit)
    }

    /// What so much of each atom leaves.
    pub(crate) fn left(&self, amounts: &[(usize, f64)]) -> Residual {
        let [radial, tangential, motion] = self.samples.left(amounts);
        Residual {
            radial,
            tangential,
            motion: (!motion.is_empty()).then_some(motion),
        }
    }

    /// What some of the shapes of a fit do, as it is seen beside the motion.
    pub(crate) fn effect(&self, fit: &Fit, range: std::ops::Range<usize>) -> Effect {
        let own = amounts(&fit.shapes[range.clone()], &fit.solution.x[range]);
        let left = self.samples.left(&own);
        let taken = |row: Row| {
            let pairs = self.samples.data[row as usize]
                .iter()
                .zip(&left[row as usize]);
            pairs.map(|(d, l)| (d - l) as f32).collect()
        };
        Effect {
            radial: taken(Row::Radial),
            tangential: taken(Row::Tangential),
            motion: taken(Row::Motion),
        }
    }
}

/// What of an angle the spline does not follow.
pub(crate) fn above_motion(context: &Context, angle: &[f64]) -> Vec<f64> {
    match &context.spline {
        Some(spline) => spline.residual(angle, &context.weight),
        None => vec![0.0; angle.len()],
    }
}
