//! The linear model of a recording: sums of products of every function with every other, and fits made of them alone.

mod broad;
pub(crate) mod exact;
mod halves;
pub(crate) mod known;
mod part;
mod residual;
pub(crate) mod sweep;
mod taken;
pub(crate) mod tuned;
mod uneven;
pub(crate) mod whiten;

use std::ops::Range;
use std::rc::Rc;

use nalgebra::{DMatrix, DVector};

use crate::causes::Catalogue;
use crate::context::Context;
use crate::model::sweep::Samples;
use crate::model::whiten::Whitener;
use crate::noise::flicker::Flicker;
use crate::noise::flicker::records::Record;
use crate::numerics::solve::{Normal, Solution};
use crate::numerics::statistics;
use crate::select::selection::Accepted;
use crate::shapes::library::{ROWS, Row, Shape};

pub(crate) use halves::Halves;
pub(crate) use residual::{Residual, Weighed, above_motion};

/// Rms, in amplitudes, below which nothing was measured: numbers that were calculated leave their rounding.
pub(crate) const ROUNDING: f64 = 1e-9;
/// Share of a function's square below which it is a rounding error.
const NOTHING: f64 = 1e-18;

/// Sums of products of one pass, row by row: atoms in the order asked for, then the data.
struct Moments([DMatrix<f64>; 3]);

impl Moments {
    /// Square of the data of each row.
    fn powers(&self) -> [f64; 3] {
        let data = |sums: &DMatrix<f64>| sums[(sums.nrows() - 1, sums.nrows() - 1)];
        self.0.each_ref().map(data)
    }
}

/// Data, functions and sums of a recording.
pub(crate) struct System<'a> {
    pub(crate) context: &'a Context,
    pub(crate) samples: Samples<'a>,
    /// Products of all atoms, whitened.
    pub(crate) total: Normal,
    /// Of so many blocks of samples, one stands in `total`.
    every: usize,
    /// Of so many blocks of samples, one is looked at by [`Self::among`].
    tried: usize,
    /// Flicker noise in what everything that any cause could explain leaves.
    pub(crate) flicker: Option<Flicker>,
    /// Records of such noise, drawn when they are asked for.
    pub(crate) records: Option<Vec<Rc<Record>>>,
    /// Such noise is not looked for.
    pub(crate) only_white: bool,
}

/// Shapes in the model, and their amounts.
#[derive(Clone)]
pub(crate) struct Fit {
    pub(crate) shapes: Vec<Shape>,
    pub(crate) solution: Solution,
}

impl<'a> System<'a> {
    /// Whitens with what is left when everything that any cause could explain is taken off; `motion` is what of a
    /// reference's motion the spline does not follow. Of `every` blocks of samples one is looked at, until
    /// [`Self::complete`].
    pub(crate) fn new(
        context: &'a Context,
        motion: Option<Vec<f64>>,
        catalogue: &mut Catalogue,
        carried: &[Accepted],
        every: usize,
    ) -> Self {
        let data = [
            context.radial(),
            context.tangential(),
            motion.unwrap_or_default(),
        ];
        let mut samples =
            Samples::new(context, std::mem::take(&mut catalogue.library), data, every);
        // What is known was taken off exactly, and comes back as it is to first order: so the fit is of the whole.
        let known: Vec<(usize, f64)> = carried.iter().flat_map(Accepted::amounts).collect();
        // The reference moves as it did.
        let moves = |i: usize| samples.library.atoms[i].row == Row::Motion;
        let off = known.iter().filter(|(i, _)| !moves(*i));
        let back = off.map(|(i, x)| (*i, -x)).collect::<Vec<_>>();
        samples.data = samples.left(&back);
        let mut this = Self {
            context,
            samples,
            total: Normal::new(DMatrix::zeros(0, 0), DVector::zeros(0), 0.0),
            every,
            tried: every,
            flicker: None,
            records: None,
            only_white: false,
        };
        let atoms: Vec<usize> = (0..this.samples.library.atoms.len()).collect();
        for (whitener, data) in this.samples.whiteners.iter_mut().zip(&this.samples.data) {
            let power = data.iter().map(|v| v * v).sum::<f64>() / data.len().max(1) as f64;
            whitener.sigma = power.sqrt().max(ROUNDING);
        }
        // Of a part, those of all atoms are needed only once the colour of the noise is known.
        let plain = (!this.samples.follows_a_part()).then(|| this.moments(&atoms, every));
        if let Some(plain) = &plain {
            this.total = this.units(plain, &atoms, every);
        }
        let known: Vec<usize> = known.iter().map(|k| k.0).collect();
        this.measure_noise(catalogue, &known);
        // White noise changes the scale of a row only.
        let white = this.samples.whiteners.iter().all(Whitener::is_white);
        let moments = match plain {
            Some(plain) if white => plain,
            _ => this.moments(&atoms, every),
        };
        this.total = this.units(&moments, &atoms, every);
        this
    }

    /// Log-likelihood that a number has to explain to be worth it.
    pub(crate) fn price(&self) -> f64 {
        statistics::price(self.context.samples() as f64)
    }

    /// Whether what is left along the circle is the axis more than it is noise.
    pub(crate) fn vibrates(&self) -> bool {
        /// Knots closer than so many samples follow a motion that goes on beyond them.
        const FAST: f64 = 10.0;
        let coloured = !self.samples.whiteners[Row::Tangential as usize].is_white();
        let spline = self.context.spline.as_ref();
        let fast = spline.is_some_and(|s| s.spacing() < FAST);
        self.context.against_reference.is_none() && (coloured || fast)
    }

    /// Which of these atoms stand along the radius.
    pub(crate) fn radial(&self, atoms: &[usize]) -> Vec<bool> {
        let row = |i: &usize| self.samples.library.atoms[*i].row;
        atoms.iter().map(|i| row(i) == Row::Radial).collect()
    }

    /// What of shapes shows the sensor for sure: where the axis vibrates, what stands along the radius.
    pub(crate) fn sure(&self, shapes: &[Shape]) -> Vec<Shape> {
        if self.vibrates() {
            self.in_radius(shapes)
        } else {
            shapes.to_vec()
        }
    }

    /// What of shapes stands along the radius.
    pub(crate) fn in_radius(&self, shapes: &[Shape]) -> Vec<Shape> {
        let all: Vec<usize> = (0..self.samples.library.atoms.len()).collect();
        let radial = self.radial(&all);
        let parts = shapes.iter().map(|s| s.only(&radial));
        parts.filter(|s| !s.0.is_empty()).collect()
    }

    /// Of so many blocks of samples, one is looked at.
    pub(crate) fn every(&self) -> usize {
        self.every
    }

    /// Of so many blocks of samples, functions are tried on one.
    pub(crate) fn tried(&self) -> usize {
        self.tried
    }

    /// From now on functions are tried on all samples.
    pub(crate) fn try_on_all(&mut self) {
        self.tried = 1;
    }

    /// Looks at all samples.
    pub(crate) fn complete(&mut self) {
        (self.every, self.tried) = (1, 1);
        self.samples.forget_the_part();
        let atoms: Vec<usize> = (0..self.samples.library.atoms.len()).collect();
        let moments = self.moments(&atoms, 1);
        self.total = self.units(&moments, &atoms, 1);
    }

    /// Sums over one block in so many.
    fn moments(&mut self, atoms: &[usize], every: usize) -> Moments {
        self.moments_along(atoms, every, every)
    }

    /// The same, with motions that were fitted to one block in so many, `followed`.
    fn moments_along(&mut self, atoms: &[usize], every: usize, followed: usize) -> Moments {
        self.samples.take_motion_off(atoms, followed);
        let mut sums = self.empty(atoms);
        self.samples.pass(atoms, every, followed, &mut |_, parts| {
            for (part, sum) in parts.iter().zip(&mut sums.0) {
                part.add_products(true, 0, sum);
            }
        });
        sums
    }

    fn empty(&self, atoms: &[usize]) -> Moments {
        Moments(ROWS.map(|row| {
            let count = self.in_row(atoms, row).count();
            DMatrix::zeros(count + 1, count + 1)
        }))
    }

    fn in_row<'b>(&'b self, atoms: &'b [usize], row: Row) -> impl Iterator<Item = usize> + 'b {
        let of =
            move |(i, a): (usize, &usize)| (self.samples.library.atoms[*a].row == row).then_some(i);
        atoms.iter().enumerate().filter_map(of)
    }

    /// Normal equations of atoms, in units of the noise or plain.
    fn normal(&self, moments: &Moments, atoms: &[usize], white: bool) -> Normal {
        let mut list = moments.0.iter().zip(ROWS).zip(&self.samples.whiteners);
        let m = atoms.len();
        let (mut gram, mut right) = (DMatrix::zeros(m, m), DVector::zeros(m));
        let mut power = 0.0;
        for ((sums, row), whitener) in &mut list {
            let scale = if white { whitener.sigma.powi(-2) } else { 1.0 };
            let own: Vec<usize> = self.in_row(atoms, row).collect();
            let last = own.len();
            for (j, b) in own.iter().enumerate() {
                for (i, a) in own[..=j].iter().enumerate() {
                    gram[(*a, *b)] = sums[(i, j)] * scale;
                    gram[(*b, *a)] = sums[(i, j)] * scale;
                }
                right[*b] = sums[(j, last)] * scale;
            }
            power += sums[(last, last)] * scale;
        }
        Normal::new(gram, right, power)
    }

    /// Normal equations of sums over one block in so many, in units of the noise.
    fn units(&self, moments: &Moments, atoms: &[usize], every: usize) -> Normal {
        self.without_nothing(self.normal(moments, atoms, true), atoms, every)
    }

    /// What follows the motion wholly leaves rounding errors, and they explain nothing.
    fn without_nothing(&self, mut total: Normal, atoms: &[usize], every: usize) -> Normal {
        for (i, number) in atoms.iter().enumerate() {
            let atom = self.samples.library.atoms[*number];
            let scale = self.samples.whiteners[atom.row as usize].sigma.powi(-2);
            if total.gram[(i, i)] < NOTHING * scale * self.samples.square(*number, every) {
                total.gram.row_mut(i).fill(0.0);
                total.gram.column_mut(i).fill(0.0);
                total.right[i] = 0.0;
            }
        }
        Normal::new(total.gram, total.right, total.power)
    }

    /// Takes atoms in that the library has got since.
    pub(crate) fn extend(&mut self) {
        let known = self.total.right.len();
        let atoms: Vec<usize> = (0..self.samples.library.atoms.len()).collect();
        if atoms.len() == known {
            return;
        }
        self.samples.take_motion_off(&atoms, self.every);
        let fresh = ROWS.map(|row| self.in_row(&atoms[..known], row).count());
        let mut sums = self.empty(&atoms);
        self.samples
            .pass(&atoms, self.every, self.every, &mut |_, parts| {
                for ((part, sum), fresh) in parts.iter().zip(&mut sums.0).zip(fresh) {
                    part.add_products(true, fresh, sum);
                }
            });
        let mut total = self.normal(&sums, &atoms, true);
        // What was known stays.
        let mut block = total.gram.view_mut((0, 0), (known, known));
        block.copy_from(&self.total.gram);
        self.total = self.without_nothing(total, &atoms, self.every);
    }

    /// Normal equations of some atoms, of new ones that no pass has seen yet too, and those atoms: cheaper than to take
    /// the new ones in against every function.
    pub(crate) fn among(&mut self, atoms: &[usize]) -> Normal {
        let moments = self.moments(atoms, self.tried);
        self.units(&moments, atoms, self.tried)
    }

    /// Leaves atoms out; the new number of each.
    pub(crate) fn retain(&mut self, keep: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
        let map = self.samples.retain(keep);
        // Some may not have been taken in yet.
        let known = self.total.right.len();
        let kept: Vec<usize> = (0..known).filter(|i| map[*i].is_some()).collect();
        self.total = self.total.only(&kept);
        map
    }

    /// Rms of the noise along the circle, where a reference shows the motion and that noise is white.
    pub(crate) fn against_reference(&self) -> Option<f64> {
        let own = &self.samples.whiteners[Row::Tangential as usize];
        let shows = self.context.against_reference.is_some() && own.is_white();
        shows.then_some(own.sigma)
    }

    /// Rms of an error of a sample, in amplitudes, that explains so much log-likelihood in all.
    pub(crate) fn size(&self, gain: f64) -> f64 {
        let samples: f64 = self.context.weight.iter().sum();
        self.noise() * (2.0 * gain.max(0.0) / samples.max(1.0)).sqrt()
    }

    /// Rms of the unpredictable part of the radial residual.
    pub(crate) fn noise(&self) -> f64 {
        self.samples.whiteners[0].sigma
    }

    /// The shapes' best amounts where functions are tried.
    pub(crate) fn fit_tried(&mut self, shapes: Vec<Shape>) -> Fit {
        if self.tried == self.every {
            return self.fit(shapes);
        }
        let atoms = atoms_of(&shapes);
        let own = Shape::all_among(&shapes, &atoms);
        let solution = self.among(&atoms).of(&own).solve();
        Fit { shapes, solution }
    }

    /// The shapes' best amounts.
    pub(crate) fn fit(&self, shapes: Vec<Shape>) -> Fit {
        let solution = self.total.of(&shapes).solve();
        Fit { shapes, solution }
    }
}

impl Fit {
    /// Its shapes but those of a range.
    pub(crate) fn others(&self, range: &Range<usize>) -> Vec<Shape> {
        let shapes = self.shapes.iter().enumerate();
        let others = shapes.filter(|(k, _)| !range.contains(k));
        others.map(|(_, s)| s.clone()).collect()
    }

    /// The shapes with others in the place of a range.
    pub(crate) fn with_in_place(&self, range: Range<usize>, own: &[Shape]) -> Vec<Shape> {
        let mut shapes = self.shapes.clone();
        shapes.splice(range, own.iter().cloned());
        shapes
    }

    /// How much of each atom is in it.
    pub(crate) fn amounts(&self) -> Vec<(usize, f64)> {
        amounts(&self.shapes, &self.solution.x)
    }
}

/// The atoms of shapes, in the order of their numbers.
pub(crate) fn atoms_of<'a>(shapes: impl IntoIterator<Item = &'a Shape>) -> Vec<usize> {
    let all = shapes.into_iter().flat_map(|s| s.0.iter().map(|p| p.0));
    let set: std::collections::BTreeSet<usize> = all.collect();
    set.into_iter().collect()
}

/// How much of each atom is in a sum of shapes.
pub(crate) fn amounts(shapes: &[Shape], x: &[f64]) -> Vec<(usize, f64)> {
    let mut sums = std::collections::BTreeMap::new();
    for (shape, x) in shapes.iter().zip(x) {
        for (atom, share) in &shape.0 {
            *sums.entry(*atom).or_insert(0.0) += share * x;
        }
    }
    sums.into_iter().collect()
}
