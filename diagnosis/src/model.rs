//! The linear model of a recording: sums of products of every function with every other, and fits made of them alone.

use nalgebra::{DMatrix, DVector};

use crate::causes::Catalogue;
use crate::context::Context;
use crate::finding::Effect;
use crate::flicker::{self, Flicker};
use crate::library::{ROWS, Row, Shape};
use crate::selection::Accepted;
use crate::solve::{Normal, Solution};
use crate::sweep::Samples;
use crate::whiten::Whitener;

/// Share of a function's square below which it is a rounding error.
const NOTHING: f64 = 1e-18;

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

/// Sums of products of one pass, row by row: atoms in the order asked for, then the data.
struct Moments(pub(crate) [DMatrix<f64>; 3]);

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
}

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
        let mut samples = Samples::new(context, std::mem::take(&mut catalogue.library), data);
        // What is known was taken off exactly, and comes back as it is to first order: so the fit is of the whole.
        let known: Vec<(usize, f64)> = carried.iter().flat_map(Accepted::amounts).collect();
        let back = known.iter().map(|(i, x)| (*i, -x)).collect::<Vec<_>>();
        let motion = std::mem::take(&mut samples.data[Row::Motion as usize]);
        samples.data = samples.left(&back);
        // The reference moves as it did.
        samples.data[Row::Motion as usize] = motion;
        let mut this = Self {
            context,
            samples,
            total: Normal::new(DMatrix::zeros(0, 0), DVector::zeros(0), 0.0),
            every,
            tried: every,
            flicker: None,
        };
        let atoms: Vec<usize> = (0..this.samples.library.atoms.len()).collect();
        for (whitener, data) in this.samples.whiteners.iter_mut().zip(&this.samples.data) {
            let power = data.iter().map(|v| v * v).sum::<f64>() / data.len().max(1) as f64;
            whitener.sigma = power.sqrt().max(1e-12);
        }
        let plain = this.moments(&atoms, every);
        this.total = this.without_nothing(this.normal(&plain, &atoms, true), &atoms);
        let mut broad = catalogue.broad.clone();
        broad.extend(
            known
                .iter()
                .map(|k| k.0)
                .filter(|i| !catalogue.broad.contains(i)),
        );
        let shapes: Vec<Shape> = broad.iter().map(|i| Shape(vec![(*i, 1.0)])).collect();
        let x = this.total.of(&shapes).solve().x;
        let amounts: Vec<(usize, f64)> = broad.into_iter().zip(x).collect();
        let left = this.samples.left(&amounts);
        this.flicker = flicker::find(context, &left[0]);
        for (row, left) in ROWS.iter().zip(&left).filter(|(_, l)| !l.is_empty()) {
            let gone = match (&context.spline, row) {
                (_, Row::Radial) => 0.0,
                (_, Row::Tangential) if context.against_reference.is_some() => 0.0,
                (Some(spline), _) => 0.7 / spline.spacing(),
                (None, _) => 0.0,
            };
            this.samples.whiteners[*row as usize] = Whitener::of(left, gone);
        }
        // A reference without noise says nothing about how well a spline follows real motion: that is worth as much as
        // the channels could show.
        let noise = this.samples.whiteners[0].sigma;
        for (whitener, share) in this.samples.whiteners.iter_mut().zip([1.0, 0.05, 1.0]) {
            whitener.sigma = whitener.sigma.max(share * noise);
        }
        // White noise changes the scale of a row only.
        let white = this.samples.whiteners.iter().all(Whitener::is_white);
        let moments = if white {
            plain
        } else {
            this.moments(&atoms, every)
        };
        this.total = this.without_nothing(this.normal(&moments, &atoms, true), &atoms);
        this
    }

    /// Of so many blocks of samples, one is looked at.
    pub(crate) fn every(&self) -> usize {
        self.every
    }

    /// From now on functions are tried on all samples.
    pub(crate) fn try_on_all(&mut self) {
        self.tried = 1;
    }

    /// Looks at all samples.
    pub(crate) fn complete(&mut self) {
        (self.every, self.tried) = (1, 1);
        self.samples.take_motion_off();
        let atoms: Vec<usize> = (0..self.samples.library.atoms.len()).collect();
        let moments = self.moments(&atoms, 1);
        self.total = self.without_nothing(self.normal(&moments, &atoms, true), &atoms);
    }

    fn moments(&self, atoms: &[usize], every: usize) -> Moments {
        let mut sums = self.empty(atoms);
        self.samples.pass(atoms, every, &mut |_, parts| {
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

    /// What follows the motion wholly leaves rounding errors, and they explain nothing.
    fn without_nothing(&self, mut total: Normal, atoms: &[usize]) -> Normal {
        for (i, number) in atoms.iter().enumerate() {
            let atom = self.samples.library.atoms[*number];
            let scale = self.samples.whiteners[atom.row as usize].sigma.powi(-2);
            if total.gram[(i, i)] < NOTHING * scale * self.samples.squares[*number] {
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
        self.samples.take_motion_off();
        let fresh = ROWS.map(|row| self.in_row(&atoms[..known], row).count());
        let mut sums = self.empty(&atoms);
        self.samples.pass(&atoms, self.every, &mut |_, parts| {
            for ((part, sum), fresh) in parts.iter().zip(&mut sums.0).zip(fresh) {
                part.add_products(true, fresh, sum);
            }
        });
        let mut total = self.normal(&sums, &atoms, true);
        // What was known stays.
        let mut block = total.gram.view_mut((0, 0), (known, known));
        block.copy_from(&self.total.gram);
        self.total = self.without_nothing(total, &atoms);
    }

    /// Normal equations of some atoms, of new ones that no pass has seen yet too, and those atoms: cheaper than to take
    /// the new ones in against every function.
    pub(crate) fn among(&mut self, atoms: &[usize]) -> Normal {
        self.samples.take_motion_off();
        let moments = self.moments(atoms, self.tried);
        self.without_nothing(self.normal(&moments, atoms, true), atoms)
    }

    /// Leaves atoms out; the new number of each.
    pub(crate) fn retain(&mut self, keep: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
        let map = self.samples.retain(keep);
        // Some may not have been taken in yet.
        let known = self.total.right.len();
        let kept: Vec<usize> = (0..known).filter(|i| map[*i].is_some()).collect();
        let gram = self.total.gram.select_rows(&kept).select_columns(&kept);
        let right = self.total.right.select_rows(&kept);
        self.total = Normal::new(gram, right, self.total.power);
        map
    }

    /// Rms of the unpredictable part of the radial residual.
    pub(crate) fn noise(&self) -> f64 {
        self.samples.whiteners[0].sigma
    }

    /// The shapes' best amounts.
    pub(crate) fn fit(&self, shapes: Vec<Shape>) -> Fit {
        let solution = self.total.of(&shapes).solve();
        Fit { shapes, solution }
    }

    /// What a fit leaves.
    pub(crate) fn residual(&self, fit: &Fit) -> Residual {
        let [radial, tangential, motion] = self.samples.left(&fit.amounts());
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

    /// The sums of either half, for all that some fits are made of.
    pub(crate) fn halves(&self, shapes: &[Shape]) -> Halves {
        let atoms = atoms_of(shapes);
        let make = || self.empty(&atoms);
        let (mut white, mut plain) = ([make(), make()], [make(), make()]);
        self.samples.pass(&atoms, 1, &mut |half, parts| {
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
            counts: self.samples.counts(),
            against: self.context.against_reference.is_some(),
            atoms,
        }
    }
}

impl Halves {
    fn mapped(&self, shapes: &[Shape]) -> Vec<Shape> {
        shapes.iter().map(|s| s.among(&self.atoms)).collect()
    }

    fn left(&self, half: usize, row: usize, shapes: &[Shape], x: &[f64]) -> f64 {
        let normal = self.plain[half][row].of(shapes);
        let x = DVector::from_column_slice(x);
        normal.power - 2.0 * normal.right.dot(&x) + (&normal.gram * &x).dot(&x)
    }

    /// Rms of radial and tangential residual together, on blocks that were not fitted.
    pub(crate) fn held_out(&self, shapes: &[Shape]) -> f64 {
        let shapes = self.mapped(shapes);
        let mut sum = 0.0;
        for half in 0..2 {
            let x = self.white[half].of(&shapes).solve().x;
            sum += (0..2)
                .map(|row| self.left(1 - half, row, &shapes, &x))
                .sum::<f64>();
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

    /// Log-likelihood of what a fit leaves of either row, its noise free.
    pub(crate) fn log_likelihood(&self, fit: &Fit) -> f64 {
        let count = self.counts[0] + self.counts[1];
        let of = |row| -0.5 * count * (self.square(fit, row) / count).max(1e-300).ln();
        of(0) + of(1)
    }

    /// Position error against the reference, rms in radians.
    pub(crate) fn position_error(&self, fit: &Fit) -> Option<f64> {
        let count = self.counts[0] + self.counts[1];
        self.against
            .then(|| (self.square(fit, 1).max(0.0) / count.max(1.0)).sqrt())
    }

    fn square(&self, fit: &Fit, row: usize) -> f64 {
        let shapes = self.mapped(&fit.shapes);
        (0..2)
            .map(|half| self.left(half, row, &shapes, &fit.solution.x))
            .sum()
    }
}

impl Fit {
    /// How much of each atom is in it.
    pub(crate) fn amounts(&self) -> Vec<(usize, f64)> {
        amounts(&self.shapes, &self.solution.x)
    }
}

/// The atoms of shapes, in the order of their numbers.
pub(crate) fn atoms_of(shapes: &[Shape]) -> Vec<usize> {
    let all = shapes.iter().flat_map(|s| s.0.iter().map(|p| p.0));
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

/// What of an angle the spline does not follow.
pub(crate) fn above_motion(context: &Context, angle: &[f64]) -> Vec<f64> {
    match &context.spline {
        Some(spline) => spline.residual(angle, &context.weight),
        None => vec![0.0; angle.len()],
    }
}
