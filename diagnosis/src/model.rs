//! Residuals as data, shapes as columns, both whitened: the linear model of a recording.

use crate::column::Shape;
use crate::context::Context;
use crate::solve::{Normal, Solution};
use crate::whiten::Whitener;

/// What the model so far leaves of the recording.
#[derive(Clone, Debug)]
pub(crate) struct Residual {
    /// Along the radius, in amplitudes.
    pub radial: Vec<f64>,
    /// Along the circle, in radians: above the motion, or against the reference.
    pub tangential: Vec<f64>,
    /// What moves faster than the spline, in radians: where real vibration shows.
    pub motion: Vec<f64>,
}

/// A column in the plain data and whitened.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    pub(crate) plain: Vec<f64>,
    pub(crate) white: Vec<f64>,
}

/// Data and whiteners of a context. Blocks: radial, tangential and, with a reference, real motion.
pub(crate) struct System<'a> {
    pub(crate) context: &'a Context,
    pub(crate) data: Column,
    whiteners: Vec<Whitener>,
    motion: Option<Vec<f64>>,
}

impl<'a> System<'a> {
    /// Whitens with what is left when everything that any cause could explain is taken off.
    pub(crate) fn new(context: &'a Context, motion: Option<Vec<f64>>, saturated: &[Shape]) -> Self {
        let mut plain = context.radial();
        plain.extend(context.tangential());
        plain.extend(motion.iter().flatten());
        let blocks = 2 + usize::from(motion.is_some());
        let mut this = Self {
            context,
            data: Column {
                white: plain.clone(),
                plain,
            },
            whiteners: vec![Whitener::default(); blocks],
            motion,
        };
        let n = context.samples();
        for (block, whitener) in this.whiteners.iter_mut().enumerate() {
            // White, of the size of the data: good enough to fit everything once.
            let part = &this.data.plain[block * n..(block + 1) * n];
            let power = part.iter().map(|v| v * v).sum::<f64>() / n as f64;
            whitener.sigma = power.sqrt().max(1e-12);
        }
        let columns: Vec<Vec<f64>> = saturated
            .iter()
            .map(|s| this.column(s, false).plain)
            .collect();
        let left = crate::solve::without(&this.data.plain, &columns);
        for block in 0..blocks {
            let part = flattened(&left[block * n..(block + 1) * n]);
            let gone = match (&context.spline, block) {
                (_, 0) => 0.0,
                (_, 1) if context.against_reference.is_some() => 0.0,
                (Some(spline), _) => 0.7 / spline.spacing(),
                (None, _) => 0.0,
            };
            this.whiteners[block] = Whitener::of(&part, gone);
        }
        // A reference without noise says nothing about how well a spline follows real motion.
        let least = 0.05 * this.whiteners[0].sigma;
        for whitener in &mut this.whiteners {
            whitener.sigma = whitener.sigma.max(least);
        }
        this.data.white = this.whitened(&this.data.plain);
        this
    }

    fn whitened(&self, plain: &[f64]) -> Vec<f64> {
        let n = self.context.samples();
        let mut all = Vec::with_capacity(plain.len());
        for (block, whitener) in self.whiteners.iter().enumerate() {
            all.extend(whitener.apply(&plain[block * n..(block + 1) * n]));
        }
        all
    }

    /// Rms of the unpredictable part of the radial residual.
    pub(crate) fn noise(&self) -> f64 {
        self.whiteners[0].sigma
    }

    /// A shape as a column; `motion` shapes are real motion.
    pub(crate) fn column(&self, shape: &Shape, motion: bool) -> Column {
        let context = self.context;
        let (mut plain, tangential) = shape.rotated(&context.cos, &context.sin);
        for (r, w) in plain.iter_mut().zip(&context.weight) {
            *r *= w;
        }
        let n = plain.len();
        match (&self.motion, motion) {
            (Some(_), true) => {
                plain.iter_mut().for_each(|r| *r = 0.0);
                plain.extend(std::iter::repeat_n(0.0, n));
                plain.extend(above_motion(context, &tangential));
            }
            (Some(_), false) => {
                plain.extend(context.seen(&tangential));
                plain.extend(std::iter::repeat_n(0.0, n));
            }
            (None, _) => plain.extend(context.seen(&tangential)),
        }
        Column {
            white: self.whitened(&plain),
            plain,
        }
    }

    /// Splits plain values into blocks.
    pub(crate) fn residual(&self, left: &[f64]) -> Residual {
        let n = self.context.samples();
        let radial = left[..n].to_vec();
        let tangential = left[n..2 * n].to_vec();
        let motion = match self.motion {
            Some(_) => left[2 * n..].to_vec(),
            None => tangential.clone(),
        };
        Residual {
            radial,
            tangential,
            motion,
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

/// Values without what sticks out of their spectrum: lines are no noise.
fn flattened(values: &[f64]) -> Vec<f64> {
    let mut left = values.to_vec();
    for _ in 0..3 {
        left = crate::lines::without_strongest(&left);
    }
    left
}

/// The columns that are in the model, and their solution.
#[derive(Clone)]
pub(crate) struct Fit {
    pub(crate) columns: Vec<Column>,
    whites: Vec<Vec<f64>>,
    normal: Normal,
    pub(crate) solution: Solution,
}

impl Fit {
    pub(crate) fn new(system: &System, columns: Vec<Column>) -> Self {
        let whites: Vec<Vec<f64>> = columns.iter().map(|c| c.white.clone()).collect();
        let normal = Normal::of(&system.data.white, &whites);
        let solution = normal.solve();
        Self {
            columns,
            whites,
            normal,
            solution,
        }
    }

    /// The solution with more columns.
    pub(crate) fn with(&self, system: &System, more: &[Column]) -> Solution {
        let whites: Vec<Vec<f64>> = more.iter().map(|c| c.white.clone()).collect();
        self.normal
            .extended(&system.data.white, &self.whites, &whites)
            .solve()
    }

    /// More columns for good.
    pub(crate) fn extended(&self, system: &System, more: Vec<Column>) -> Self {
        let mut whites = self.whites.clone();
        let fresh: Vec<Vec<f64>> = more.iter().map(|c| c.white.clone()).collect();
        let normal = self
            .normal
            .extended(&system.data.white, &self.whites, &fresh);
        whites.extend(fresh);
        let mut columns = self.columns.clone();
        columns.extend(more);
        let solution = normal.solve();
        Self {
            columns,
            whites,
            normal,
            solution,
        }
    }

    /// What is left of the plain data.
    pub(crate) fn left(&self, system: &System) -> Vec<f64> {
        let mut left = system.data.plain.clone();
        for (column, x) in self.columns.iter().zip(&self.solution.x) {
            for (l, p) in left.iter_mut().zip(&column.plain) {
                *l -= x * p;
            }
        }
        left
    }

    /// Rms of radial and tangential residual together.
    pub(crate) fn rms(&self, system: &System) -> f64 {
        let left = self.left(system);
        let n = system.context.samples();
        rms_of(&left[..2 * n], &system.context.weight)
    }

    /// The same on interleaved blocks that were not fitted.
    pub(crate) fn held_out(&self, system: &System) -> f64 {
        const BLOCKS: usize = 20;
        let n = system.context.samples();
        let block = n.div_ceil(BLOCKS).max(1);
        let (mut sum, mut count) = (0.0, 0.0);
        for half in 0..2 {
            let fits = |row: usize| (row % n) / block % 2 == half;
            let masked = |v: &[f64]| -> Vec<f64> {
                v.iter()
                    .enumerate()
                    .map(|(k, x)| if fits(k) { *x } else { 0.0 })
                    .collect()
            };
            let columns: Vec<Vec<f64>> = self.whites.iter().map(|c| masked(c)).collect();
            let x = Normal::of(&masked(&system.data.white), &columns).solve().x;
            for row in (0..2 * n).filter(|row| !fits(*row)) {
                let weight = system.context.weight[row % n];
                let model: f64 = self
                    .columns
                    .iter()
                    .zip(&x)
                    .map(|(c, x)| c.plain[row] * x)
                    .sum();
                sum += weight * (system.data.plain[row] - model).powi(2);
                count += weight;
            }
        }
        (sum / f64::max(count, 1.0)).sqrt()
    }

    /// Position error against the reference, rms in radians.
    pub(crate) fn position_error(&self, system: &System) -> Option<f64> {
        system.context.against_reference.as_ref()?;
        let n = system.context.samples();
        let left = self.left(system);
        let tangential = &left[n..2 * n];
        let weight: f64 = system.context.weight.iter().sum();
        let mean = tangential.iter().sum::<f64>() / weight.max(1.0);
        let pairs = tangential.iter().zip(&system.context.weight);
        let sum: f64 = pairs.map(|(t, w)| w * (t - mean).powi(2)).sum();
        Some((sum / weight.max(1.0)).sqrt())
    }
}

fn rms_of(left: &[f64], weight: &[f64]) -> f64 {
    let sum: f64 = left.iter().map(|v| v * v).sum();
    let count: f64 = 2.0 * weight.iter().sum::<f64>();
    (sum / count.max(1.0)).sqrt()
}
