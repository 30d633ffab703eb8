//! What is seen of what is added to the channels: along the radius, and, where a reference shows the motion, along the circle
//! too.

use std::ops::Range;

use crate::context::Context;
use crate::model::{Residual, System};
use crate::numerics::pair::PairSums;

/// Residuals that show the offsets of both channels, in units in which their white noise is that of the radius.
#[derive(Clone, Copy)]
pub(crate) struct Channels<'a> {
    pub(crate) context: &'a Context,
    /// Along the radius, in amplitudes.
    pub(crate) radial: &'a [f64],
    /// Against the reference, in radians, and noise of the radius over its own.
    tangential: Option<(&'a [f64], f64)>,
}

/// What a residual shows of offsets of cosine and sine, and the residual.
pub(crate) struct Row {
    pub(crate) of: [f64; 2],
    pub(crate) left: f64,
}

impl<'a> Channels<'a> {
    /// Along the radius alone.
    pub(crate) fn in_radius(context: &'a Context, radial: &'a [f64]) -> Self {
        Self {
            context,
            radial,
            tangential: None,
        }
    }

    /// Of what a model leaves. Noise along the circle that is not white is the axis or something unknown.
    pub(crate) fn of(system: &System<'a>, left: &'a Residual) -> Self {
        let context = system.context;
        let ratio = system
            .against_reference()
            .map(|noise| system.noise() / noise);
        Self {
            context,
            radial: &left.radial,
            tangential: ratio.map(|ratio| (left.tangential.as_slice(), ratio)),
        }
    }

    /// The same of the first samples.
    pub(crate) fn first(mut self, samples: usize) -> Self {
        self.radial = &self.radial[..samples];
        self
    }

    /// Samples.
    pub(crate) fn samples(&self) -> usize {
        self.radial.len()
    }

    /// Residuals of a sample.
    pub(crate) fn count(&self) -> f64 {
        if self.tangential.is_some() { 2.0 } else { 1.0 }
    }

    /// What a sample shows.
    pub(crate) fn rows(&self, k: usize) -> impl Iterator<Item = Row> + use<> {
        let (cos, sin) = (self.context.cos[k], self.context.sin[k]);
        let radial = Row {
            of: [cos, sin],
            left: self.radial[k],
        };
        let tangential = self.tangential.map(|(left, ratio)| Row {
            of: [-sin * ratio, cos * ratio],
            left: left[k] * ratio,
        });
        std::iter::once(radial).chain(tangential)
    }

    /// Log-likelihood that steady offsets explain of the first samples of a recording: of all of it they are fitted, and slow
    /// noise is a steady offset to a part.
    pub(crate) fn steady(&self, all: usize) -> f64 {
        if self.samples() >= all {
            return 0.0;
        }
        let power = self.power();
        if power <= 0.0 {
            return 0.0;
        }
        let counting: f64 = self.context.weight[..self.samples()].iter().sum();
        let left = power - self.sums(0..self.samples()).explained();
        0.5 * counting * self.count() * (power / left.max(f64::MIN_POSITIVE)).ln()
    }

    /// Sums of products of offsets of both channels and what is seen of some samples.
    pub(crate) fn sums(&self, of: Range<usize>) -> PairSums {
        let mut sums = PairSums::default();
        for k in of {
            for Row { of: [c, s], left } in self.rows(k) {
                sums.add(c, s, left, self.context.weight[k]);
            }
        }
        sums
    }

    /// Sum of squares.
    pub(crate) fn power(&self) -> f64 {
        let all = (0..self.samples()).flat_map(|k| self.rows(k));
        all.map(|row| row.left * row.left).sum()
    }
}
