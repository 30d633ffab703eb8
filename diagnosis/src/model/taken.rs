//! What of each function the motion follows: it is taken off before anything is fitted.
//!
//! Of a long recording one block of samples in several is looked at first. There the motion is fitted to those blocks
//! alone: functions need not be made elsewhere.

use std::borrow::Cow;

use crate::motion::spline::Spline;

/// Fewest knots in a block where its motion is fitted alone: of fewer, it would follow much that it does not follow otherwise.
const KNOTS: f64 = 2.0;

/// How what cannot be seen is taken off a row.
pub(crate) enum Projector<'a> {
    Nothing,
    Mean,
    Spline(&'a Spline),
}

/// What is taken off an atom.
pub(crate) struct Taken {
    /// Coefficients of the motion that follows it.
    pub(crate) motion: Vec<f64>,
    /// Square of the atom before that is taken off; 0 where there is none to take off.
    pub(crate) square: f64,
}

/// What is taken off each atom, fitted to one block of samples in so many.
pub(crate) struct Motions<'a> {
    pub(crate) every: usize,
    pub(crate) spline: Option<Cow<'a, Spline>>,
    /// Samples that count.
    pub(crate) counts: f64,
    /// Nothing where it was not asked for yet.
    of: Vec<Option<Taken>>,
}

impl<'a> Motions<'a> {
    /// Fitted to all samples.
    pub(crate) fn whole(spline: Option<&'a Spline>, weight: &[f64]) -> Self {
        Self {
            every: 1,
            spline: spline.map(Cow::Borrowed),
            counts: weight.iter().sum(),
            of: vec![],
        }
    }

    /// Fitted to blocks of `block` samples, one in `every`, of which `weight` is not 0; nothing where they are too short.
    pub(crate) fn part(
        spline: Option<&Spline>,
        weight: &[f64],
        every: usize,
        block: usize,
    ) -> Option<Self> {
        let short = |s: &Spline| s.spacing() * KNOTS > block as f64;
        if spline.is_some_and(short) {
            return None;
        }
        let spline = spline.map(|s| Spline::new(weight.len(), s.spacing(), weight));
        Some(Self {
            every,
            spline: spline.map(Cow::Owned),
            counts: weight.iter().sum(),
            of: vec![],
        })
    }

    /// What is taken off an atom, where it was asked for.
    pub(crate) fn of(&self, atom: usize) -> Option<&Taken> {
        self.of.get(atom)?.as_ref()
    }

    /// Those of some atoms that were not asked for yet.
    pub(crate) fn lacking(&self, atoms: &[usize]) -> Vec<usize> {
        let lacks = |i: &&usize| self.of(**i).is_none();
        atoms.iter().filter(lacks).copied().collect()
    }

    /// Keeps what is taken off an atom.
    pub(crate) fn set(&mut self, atom: usize, taken: Taken) {
        if self.of.len() <= atom {
            self.of.resize_with(atom + 1, || None);
        }
        self.of[atom] = Some(taken);
    }

    /// Leaves out atoms that have no new number.
    pub(crate) fn retain(&mut self, map: &[Option<usize>]) {
        let old = std::mem::take(&mut self.of).into_iter().zip(map);
        for (taken, new) in old {
            if let (Some(taken), Some(new)) = (taken, new) {
                self.set(*new, taken);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Motions, Spline, Taken};

    #[test]
    fn what_is_taken_off_an_atom_goes_with_its_number() {
        let mut motions = Motions::whole(None, &[1.0]);
        let taken = |square: f64| Taken {
            motion: vec![square],
            square,
        };
        motions.set(0, taken(1.0));
        motions.set(3, taken(4.0));
        assert_eq!(motions.lacking(&[0, 1, 2, 3, 4]), [1, 2, 4]);
        motions.retain(&[None, Some(0), None, Some(1), Some(2)]);
        assert_eq!(motions.lacking(&[0, 1, 2]), [0, 2]);
        assert_eq!(motions.of(1).map(|t| t.square), Some(4.0));
    }

    #[test]
    fn a_block_of_few_knots_has_no_motion_of_its_own() {
        let weight = vec![1.0; 20_000];
        let part = |spacing: f64| {
            let spline = Spline::new(weight.len(), spacing, &weight);
            Motions::part(Some(&spline), &weight, 4, 1024).is_some()
        };
        assert!(part(400.0) && !part(600.0));
        assert!(Motions::part(None, &weight, 4, 1024).is_some());
    }
}
