//! Fits of one half of interleaved blocks, judged on the other; and what a fit leaves of both.

use nalgebra::DVector;

use super::{Fit, Moments, System, atoms_of};
use crate::numerics::solve::Normal;
use crate::shapes::library::Shape;

/// So many times as large as in a fit an amount may well be in half of it.
const LARGER: f64 = 10.0;
/// Precision of an amount that a fit has nothing of, in units of the noise.
const UNSEEN: f64 = 1e12;

/// The sums of either half of interleaved blocks, for some atoms only.
pub(crate) struct Halves {
    /// Where each atom stands in the sums.
    atoms: Vec<usize>,
    white: [Normal; 2],
    /// Plain, the rows apart.
    plain: [[Normal; 3]; 2],
    /// Samples that count, in each half.
    counts: [f64; 2],
    against: bool,
}

impl System<'_> {
    /// The sums of either half, for all that some fits are made of; of the blocks that functions are tried on.
    pub(crate) fn halves(&mut self, shapes: &[Shape]) -> Halves {
        let atoms = atoms_of(shapes);
        self.samples.take_motion_off(&atoms, self.tried);
        let make = || self.empty(&atoms);
        let (mut white, mut plain) = ([make(), make()], [make(), make()]);
        self.samples
            .pass(&atoms, self.tried, self.tried, &mut |half, parts| {
                for (row, part) in parts.iter().enumerate() {
                    part.add_products(true, 0, &mut white[half].0[row]);
                    part.add_products(false, 0, &mut plain[half].0[row]);
                }
            });
        let only = |moments: &Moments, row: usize| {
            let mut one = self.empty(&atoms);
            one.0[row].copy_from(&moments.0[row]);
            self.normal(&one, &atoms, false)
        };
        Halves {
            white: white.map(|m| self.normal(&m, &atoms, true)),
            plain: plain.map(|m| [0, 1, 2].map(|row| only(&m, row))),
            counts: self.samples.counts(self.tried),
            against: self.context.against_reference.is_some(),
            atoms,
        }
    }
}

/// Square of what amounts leave.
fn square_left(normal: &Normal, x: &[f64]) -> f64 {
    let x = DVector::from_column_slice(x);
    normal.power - 2.0 * normal.right.dot(&x) + (&normal.gram * &x).dot(&x)
}

impl Halves {
    fn mapped(&self, shapes: &[Shape]) -> Vec<Shape> {
        shapes.iter().map(|s| s.among(&self.atoms)).collect()
    }

    fn left(&self, half: usize, row: usize, shapes: &[Shape], x: &[f64]) -> f64 {
        square_left(&self.plain[half][row].of(shapes), x)
    }

    /// Rms of radial and tangential residual together, on blocks that were not fitted. One half may hardly see something that
    /// the other does, a dip at one place or how it was when the recording began: amounts from the number `own` on are
    /// expected to be hardly larger than those of the fit, and so many of the last ones are given.
    pub(crate) fn held_out(&self, fit: &Fit, own: usize, given: usize) -> f64 {
        let left = |half: usize, shapes: &[Shape], x: &[f64]| {
            (0..2).map(|row| self.left(half, row, shapes, x)).sum()
        };
        self.rms_held_out(fit, own, given, left)
    }

    /// The same in units of the noise, white: where an axis shakes, what is along the circle hardly counts.
    pub(crate) fn held_out_in_noise(&self, fit: &Fit, own: usize, given: usize) -> f64 {
        let left =
            |half: usize, shapes: &[Shape], x: &[f64]| square_left(&self.white[half].of(shapes), x);
        self.rms_held_out(fit, own, given, left)
    }

    /// Rms of what is left of either half, by its square there, with amounts that were fitted to the other.
    fn rms_held_out(
        &self,
        fit: &Fit,
        own: usize,
        given: usize,
        left: impl Fn(usize, &[Shape], &[f64]) -> f64,
    ) -> f64 {
        let x = &fit.solution.x;
        let free = x.len() - given;
        let known = DVector::from_column_slice(&x[free..]);
        let shapes = self.mapped(&fit.shapes);
        let mut sum = 0.0;
        for half in 0..2 {
            let seen = self.white[half].of(&shapes);
            let taken = seen.gram.view((0, free), (free, given)) * &known;
            let mut gram = seen.gram.view((0, 0), (free, free)).into_owned();
            for (i, x) in x[..free].iter().enumerate().skip(own) {
                gram[(i, i)] += (LARGER * x).powi(-2).min(UNSEEN);
            }
            let half_alone = Normal::new(gram, seen.right.rows(0, free) - taken, 0.0);
            let mut amounts = half_alone.solve().x;
            amounts.extend(&x[free..]);
            sum += left(1 - half, &shapes, amounts.as_slice());
        }
        let count = 2.0 * (self.counts[0] + self.counts[1]);
        (sum.max(0.0) / count.max(1.0)).sqrt()
    }

    /// Rms of radial and tangential residual together.
    pub(crate) fn rms(&self, fit: &Fit) -> f64 {
        let sum = self.square(fit, 0) + self.square(fit, 1);
        let count = 2.0 * (self.counts[0] + self.counts[1]);
        (sum.max(0.0) / count.max(1.0)).sqrt()
    }

    /// Log-likelihood of what a fit leaves of either row, its noise free. What is left is a fraction of amplitudes, which go with what is
    /// taken off the signals; fits about different ones are compared by what is left of the signals themselves, whose amplitude
    /// over a common one has this logarithm. Along the circle more than that can be left: of the axis or of the reference, in radians.
    pub(crate) fn log_likelihood(&self, fit: &Fit, log_amplitude: f64) -> f64 {
        let count = self.counts[0] + self.counts[1];
        let [radial, tangential] = [0, 1].map(|row| self.variance(fit, row));
        let of_signals = (radial / tangential).min(1.0);
        self.log_likelihood_of_radius(fit, log_amplitude)
            - 0.5 * count * tangential.ln()
            - count * of_signals * log_amplitude
    }

    /// The same of what is left of the radius alone.
    pub(crate) fn log_likelihood_of_radius(&self, fit: &Fit, log_amplitude: f64) -> f64 {
        let count = self.counts[0] + self.counts[1];
        -0.5 * count * self.variance(fit, 0).ln() - count * log_amplitude
    }

    /// Mean square of what a fit leaves of a row.
    fn variance(&self, fit: &Fit, row: usize) -> f64 {
        let count = self.counts[0] + self.counts[1];
        (self.square(fit, row) / count).max(1e-300)
    }

    /// Position error against the reference, rms in radians, on blocks that were not fitted; see [`Self::held_out`].
    pub(crate) fn position_error(&self, fit: &Fit, own: usize, given: usize) -> Option<f64> {
        let left = |half: usize, shapes: &[Shape], x: &[f64]| self.left(half, 1, shapes, x);
        // It is one residual, and that a mean of two.
        self.against
            .then(|| 2f64.sqrt() * self.rms_held_out(fit, own, given, left))
    }

    fn square(&self, fit: &Fit, row: usize) -> f64 {
        let shapes = self.mapped(&fit.shapes);
        (0..2)
            .map(|half| self.left(half, row, &shapes, &fit.solution.x))
            .sum()
    }
}
