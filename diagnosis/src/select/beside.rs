//! What shapes explain beside a fit.

use crate::model::{System, amounts};
use crate::numerics::solve::{Normal, Solution};
use crate::numerics::statistics::{after_trials, log_tail};
use crate::shapes::library::Shape;

/// The normal equations with the fit taken off, and how much it explains.
pub(crate) struct Beside<'a> {
    whole: &'a Normal,
    rest: Normal,
    /// The equations of the radius alone and which atoms stand in it, where what is seen along the circle may be the axis.
    radius: Option<(Normal, Vec<bool>)>,
}

/// Probability below which the radius has to show a cause of the sensor where the axis vibrates.
const RADIUS: f64 = 1e-3;
/// Share of what a cause claims for the radius that has to be there.
const CLAIMED: f64 = 0.5;

impl<'a> Beside<'a> {
    pub(crate) fn new(whole: &'a Normal, shapes: &[Shape]) -> Self {
        Self {
            whole,
            rest: whole.deflated(shapes),
            radius: None,
        }
    }

    /// Beside shapes of all atoms that are taken in, where the axis may vibrate.
    pub(crate) fn all_that_moves(system: &'a System, shapes: &[Shape]) -> Self {
        let all: Vec<usize> = (0..system.total.right.len()).collect();
        Self::new(&system.total, shapes).where_it_moves(system, shapes, &all)
    }

    /// The same where the axis may vibrate; `atoms` are those of the equations.
    pub(crate) fn where_it_moves(
        mut self,
        system: &System,
        shapes: &[Shape],
        atoms: &[usize],
    ) -> Self {
        if system.vibrates() {
            let radial = system.radial(atoms);
            let parts: Vec<Shape> = shapes.iter().map(|s| s.only(&radial)).collect();
            self.radius = Some((self.whole.deflated(&parts), radial));
        }
        self
    }

    /// Whether the radius shows its part of shapes in these amounts. A vibration that the prediction of the noise does not
    /// hold is in every shape that stands along the circle, but it never shows in the radius; a cause of the sensor does.
    /// `trials`: choices that it has to make up for.
    pub(crate) fn in_radius(
        &self,
        shapes: &[Shape],
        x: &[f64],
        freedom: usize,
        trials: f64,
    ) -> bool {
        let Some((radius, radial)) = &self.radius else {
            return true;
        };
        let part = Shape(amounts(shapes, x)).only(radial);
        let claimed = radius.product(&part, &part).max(0.0).sqrt();
        let shown: f64 = part.0.iter().map(|(i, x)| x * radius.right[*i]).sum();
        let seen = shown.max(0.0) / claimed.max(f64::MIN_POSITIVE);
        let log_p = after_trials(log_tail(seen * seen, freedom), trials);
        seen > CLAIMED * claimed && log_p < RADIUS.ln()
    }

    /// What shapes explain beside the fit, and how many numbers they have for it.
    pub(crate) fn gain(&self, shapes: &[Shape]) -> (f64, usize) {
        let solution = self.solve(shapes);
        (solution.gain(), solution.rank)
    }

    /// What shapes explain of another beside the fit, as if that were the data, and how many numbers they have for it.
    pub(crate) fn gain_of(&self, data: &Shape, shapes: &[Shape]) -> (f64, usize) {
        let mut rest = self.rest.clone();
        rest.right.fill(0.0);
        for (i, x) in &data.0 {
            rest.right.axpy(*x, &self.rest.gram.column(*i), 1.0);
        }
        let solution = rest.solve_beside(self.whole, shapes);
        (solution.gain(), solution.rank)
    }

    /// Whether wide shapes do all that simple ones do: those have no number of their own beside them.
    pub(crate) fn holds(&self, wide: &[Shape], simple: &[Shape]) -> bool {
        self.gain(&[wide, simple].concat()).1 == self.gain(wide).1
    }

    /// The amounts of shapes beside the fit.
    pub(crate) fn solve(&self, shapes: &[Shape]) -> Solution {
        self.rest.solve_beside(self.whole, shapes)
    }

    /// Size of all that shapes in these amounts do, what the fit and the motion can do as well included, in units of the
    /// noise.
    pub(crate) fn size(&self, shapes: &[Shape], x: &[f64]) -> f64 {
        let all = Shape(amounts(shapes, x));
        self.whole.product(&all, &all).max(0.0).sqrt()
    }
}
