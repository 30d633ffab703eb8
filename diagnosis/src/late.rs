//! Samples that were put in: behind one, the angle is late by what it moves in a sample. On a fast axis that is a step; where the
//! axis turns back it is a corner, for its speed is late, too.

use nonius_recording::Recording;

use crate::checks::{Checked, ninth};
use crate::jumps::{AROUND, Corners, SIDES, angle, column, powers};
use crate::solve::{dot, weights_of, without};

/// Longer curves, for slow axes.
const LONGER: (usize, i32) = (1200, 5);
/// Order of a curve from which on the bend of the speed is known, too.
const BENDS: i32 = 5;
/// Parts of a side at which the noise is looked at.
const PARTS: usize = 4;
/// Standard deviations from which on a delay counts.
const SURE: f64 = 5.0;
/// A delay is so near one sample, beside what noise makes of it.
const WHOLE: f64 = 0.15;

/// Curves through so many samples on either side of a place, and what the angle behind it does beside them if it is late.
struct Curves {
    side: usize,
    /// Weights of the samples that give the speed in the middle in radians per sample, how it changes to either end, how that does.
    speeds: Vec<Vec<f64>>,
    /// What those of the samples behind the middle have that the curve does not follow.
    behind: Vec<Vec<f64>>,
    corners: Corners,
}

impl Curves {
    fn new((side, order): (usize, i32)) -> Self {
        let powers = powers(side, order);
        let known = if order < BENDS { 2 } else { 3 };
        let middle = side as f64 - 0.5;
        // The derivative of xⁿ is n xⁿ⁻¹.
        let speed = |n: usize| -> Vec<f64> {
            let others: Vec<Vec<f64>> = (0..powers.len())
                .filter(|i| *i != n)
                .map(|i| powers[i].clone())
                .collect();
            let weights = weights_of(&powers[n], &others);
            weights.iter().map(|w| w * n as f64 / middle).collect()
        };
        let behind = |n: usize| {
            let later = |x: f64| if x > 0.0 { x.powi(n as i32 - 1) } else { 0.0 };
            without(&column(side, later), &powers)
        };
        Self {
            side,
            speeds: (1..=known).map(speed).collect(),
            behind: (1..=known).map(behind).collect(),
            corners: Corners::new(side, order),
        }
    }

    /// Samples about a place that show it, if there are as many.
    fn near<'a>(&self, angle: &'a [f64], place: usize) -> Option<&'a [f64]> {
        angle.get(place.checked_sub(self.side)?..place + self.side)
    }

    /// What a delay of one sample takes off the angle near a place: its square, and its product with the angle.
    fn of_one(&self, near: &[f64]) -> [f64; 2] {
        let mut one = vec![0.0; near.len()];
        for (speed, behind) in self.speeds.iter().zip(&self.behind) {
            let by = dot(near, speed);
            one.iter_mut().zip(behind).for_each(|(s, b)| *s += by * b);
        }
        [dot(&one, &one), dot(near, &one)]
    }

    /// The angle about a place, where its noise is known.
    fn look<'a>(&'a self, angle: &'a [f64], place: usize) -> Option<Look<'a>> {
        let side = self.side;
        let around = place.saturating_sub(AROUND * side)..place + AROUND * side;
        let apart = around
            .step_by((side / PARTS).max(1))
            .filter(|j| j.abs_diff(place) >= side);
        let sizes: Vec<f64> = apart
            .filter_map(|j| self.near(angle, j))
            .map(|near| {
                let [square, with] = self.of_one(near);
                (with / square.sqrt().max(f64::MIN_POSITIVE)).abs()
            })
            .collect();
        let near = self.near(angle, place)?;
        (sizes.len() > AROUND * PARTS).then(|| Look {
            curves: self,
            near,
            of_one: self.of_one(near),
            noise: ninth(&sizes) / 1.645,
        })
    }
}

/// The angle about a place.
struct Look<'a> {
    curves: &'a Curves,
    near: &'a [f64],
    /// See [`Curves::of_one`].
    of_one: [f64; 2],
    /// Of a sample, by what delays seem to be on either side.
    noise: f64,
}

impl Look<'_> {
    /// Standard deviations by which a delay of one sample is seen.
    fn told(&self) -> f64 {
        self.of_one[0].sqrt() / self.noise
    }

    /// Whether the angle behind the place is late by one sample, and no corner of the drive is the likelier reason: it may stand
    /// anywhere and have any size, which is paid for.
    fn is_late(&self) -> bool {
        let ([square, with], told) = (self.of_one, self.told());
        let corners = &self.curves.corners;
        let samples = -with / square;
        let paid = (2.0 * self.curves.side as f64).ln() + 2.0 * (corners.count() as f64).ln();
        let explained = -2.0 * with - square;
        samples * told > SURE
            && (samples - 1.0).abs() < WHOLE + 3.0 / told
            && corners.explained(self.near) < explained + paid * self.noise.powi(2)
    }
}

/// Those of some samples behind which the angle is late by what it moves in a sample: they were put in. One of them is looked
/// for, not the farthest of all, so a smaller delay tells; curves are as long as tells the most there.
pub(crate) fn late(recording: &Recording, checked: &Checked, of: &[usize]) -> Vec<usize> {
    if of.is_empty() {
        return vec![];
    }
    let Some(angle) = angle(recording, &checked.weight) else {
        return vec![];
    };
    let all: Vec<Curves> = SIDES.into_iter().chain([LONGER]).map(Curves::new).collect();
    let is_late = |k: &usize| {
        let looks = all.iter().filter_map(|curves| curves.look(&angle, *k));
        let best = looks.max_by(|a, b| a.told().total_cmp(&b.told()));
        best.is_some_and(|look| look.is_late())
    };
    of.iter().copied().filter(is_late).collect()
}
