//! One pass over the samples: functions are made block by block, motion is taken off, the rest whitened, and only the
//! sums of products are kept. So memory does not grow with the number of causes.

use std::cell::OnceCell;
use std::ops::Range;

use crate::block::{Block, Shared};
use crate::context::Context;
use crate::library::{Library, ROWS, Row};
use crate::part::{CHUNK, Part, STRIDE};
use crate::solve::dot;
use crate::spline::{Basis, Spline};
use crate::whiten::{ORDER, Whitener};

/// Interleaved blocks, every other one of which is held out.
pub(crate) const BLOCKS: usize = 20;

/// How what cannot be seen is taken off a row.
enum Projector<'a> {
    Nothing,
    Mean(f64),
    Spline(&'a Spline),
}

/// Whether a block is looked at where of so many one is: one of each group, and not always the same, for the motion may
/// repeat itself.
fn chosen(block: usize, every: usize) -> bool {
    /// The golden ratio's fraction: its multiples spread evenly over a turn.
    const SPREAD: f64 = 0.618_033_988_749_894_9;
    let place = (block / every) as f64 * SPREAD;
    block % every == (place.fract() * every as f64) as usize
}

/// The splines of a block, made when they are asked for.
struct Splines<'a> {
    spline: Option<&'a Spline>,
    start: usize,
    samples: usize,
    made: OnceCell<Option<Basis>>,
}

impl Splines<'_> {
    fn basis(&self) -> Option<&Basis> {
        let make = || Some(self.spline?.basis(self.start, self.samples, false));
        self.made.get_or_init(make).as_ref()
    }
}

/// Takes a block, the splines of it, which of the atoms asked for, and its values.
type Visit<'v> = dyn FnMut(&Block, &Splines, usize, &[f64]) + 'v;

/// Functions, data and noise of a recording: everything that a pass needs.
pub(crate) struct Samples<'a> {
    pub(crate) context: &'a Context,
    pub(crate) library: Library,
    /// The data of each row; empty where there is no such row.
    pub(crate) data: [Vec<f64>; 3],
    pub(crate) whiteners: [Whitener; 3],
    /// What is taken off each atom: coefficients of the motion that follows it.
    motions: Vec<Vec<f64>>,
    /// Square of each atom before the motion is taken off; 0 where there is none to take off.
    pub(crate) squares: Vec<f64>,
}

impl<'a> Samples<'a> {
    pub(crate) fn new(context: &'a Context, library: Library, data: [Vec<f64>; 3]) -> Self {
        let mut this = Self {
            context,
            library,
            data,
            whiteners: Default::default(),
            motions: vec![],
            squares: vec![],
        };
        this.take_motion_off();
        this
    }

    /// Functions without their motion and without data: for sums of them alone.
    pub(crate) fn unfitted(context: &'a Context, library: Library) -> Self {
        Self {
            context,
            library,
            data: Default::default(),
            whiteners: Default::default(),
            motions: vec![],
            squares: vec![],
        }
    }

    fn projector(&self, row: Row) -> Projector<'_> {
        let against = self.context.against_reference.is_some();
        match (row, &self.context.spline) {
            (Row::Radial, _) => Projector::Nothing,
            (Row::Tangential, _) if against => Projector::Mean(self.context.weight.iter().sum()),
            (_, Some(spline)) => Projector::Spline(spline),
            (_, None) => Projector::Nothing,
        }
    }

    /// Samples that count in either half of the interleaved blocks.
    pub(crate) fn counts(&self) -> [f64; 2] {
        let half = self.context.samples().div_ceil(BLOCKS).max(1);
        let mut counts = [0.0; 2];
        for (i, block) in self.context.weight.chunks(half).enumerate() {
            counts[i % 2] += block.iter().sum::<f64>();
        }
        counts
    }

    /// Fits the motion to every atom that has none yet.
    pub(crate) fn take_motion_off(&mut self) {
        let from = self.motions.len();
        let fresh: Vec<usize> = (from..self.library.atoms.len()).collect();
        let weight = &self.context.weight;
        let mut sums: Vec<Vec<f64>> = fresh
            .iter()
            .map(|i| match self.projector(self.library.atoms[*i].row) {
                Projector::Nothing => vec![],
                Projector::Mean(_) => vec![0.0],
                Projector::Spline(spline) => vec![0.0; spline.count()],
            })
            .collect();
        let wanted: Vec<usize> = fresh
            .into_iter()
            .filter(|i| !sums[i - from].is_empty())
            .collect();
        let mut weighted = vec![];
        let mut squares = vec![0.0; self.library.atoms.len() - from];
        self.fill(&wanted, 1, &mut |block, splines, i, values| {
            let range = block.start..block.start + block.len();
            let weights = &weight[range];
            let counted = if weights.iter().all(|w| *w == 1.0) {
                values
            } else {
                weighted.clear();
                weighted.extend(values.iter().zip(weights).map(|(v, w)| v * w));
                &weighted
            };
            squares[wanted[i] - from] += dot(counted, counted);
            let own = &mut sums[wanted[i] - from];
            match own.len() {
                1 => own[0] += counted.iter().sum::<f64>(),
                _ => splines
                    .basis()
                    .into_iter()
                    .for_each(|b| b.accumulate(counted, own)),
            }
        });
        for (own, atom) in sums.iter_mut().zip(&self.library.atoms[from..]) {
            if let Projector::Mean(total) = self.projector(atom.row) {
                own[0] /= total.max(1.0);
            }
        }
        if let Some(spline) = &self.context.spline {
            let count = spline.count();
            spline.solve_all(sums.iter_mut().filter(|s| s.len() == count));
        }
        self.motions.extend(sums);
        self.squares.extend(squares);
    }

    /// Leaves out atoms that are not kept; the new number of each.
    pub(crate) fn retain(&mut self, keep: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
        let map = self.library.retain(keep);
        let kept = std::mem::take(&mut self.motions).into_iter().zip(&map);
        self.motions = kept
            .filter_map(|(m, new)| new.is_some().then_some(m))
            .collect();
        let kept = std::mem::take(&mut self.squares).into_iter().zip(&map);
        self.squares = kept
            .filter_map(|(s, new)| new.is_some().then_some(s))
            .collect();
        map
    }

    /// Makes the functions of atoms block by block, of so many blocks in one, as they are: block, splines of it, which of the
    /// atoms, values.
    fn fill(&self, atoms: &[usize], every: usize, visit: &mut Visit) {
        if atoms.is_empty() {
            return;
        }
        let n = self.context.samples();
        // Each group is filled once for all of its atoms.
        let mut groups: Vec<(usize, Vec<usize>)> = vec![];
        for (i, atom) in atoms.iter().enumerate() {
            let group = self.library.atoms[*atom].group;
            match groups.iter_mut().find(|g| g.0 == group) {
                Some(known) => known.1.push(i),
                None => groups.push((group, vec![i])),
            }
        }
        let (mut scratch, mut shared) = (vec![], Shared::default());
        let half = n.div_ceil(BLOCKS).max(1);
        for first in (0..n).step_by(half) {
            let last = (first + half).min(n);
            for start in (first..last).step_by(CHUNK) {
                if !chosen(start / CHUNK, every) {
                    continue;
                }
                let range = start..(start + CHUNK).min(last);
                let block = self.context.block(range, &mut shared);
                let splines = Splines {
                    spline: self.context.spline.as_ref(),
                    start: block.start,
                    samples: block.len(),
                    made: OnceCell::new(),
                };
                for (group, members) in &groups {
                    let group = &self.library.groups[*group];
                    let (len, count) = (block.len(), group.count);
                    let need = group.way.values() * count * len;
                    if scratch.len() < need {
                        scratch.resize(need, 0.0);
                    }
                    group.write(&block, &mut scratch[..need]);
                    for i in members {
                        let atom = self.library.atoms[atoms[*i]];
                        let along = group.way.values() > 1 && atom.row != Row::Radial;
                        let at = (if along { count } else { 0 } + atom.function) * len;
                        visit(&block, &splines, *i, &scratch[at..at + len]);
                    }
                }
            }
        }
    }

    /// Goes through the samples, of so many blocks through one: the half of the blocks that it belongs to, and the three
    /// rows. What whitening takes for the past of a block is the end of the one that was looked at before: for data and
    /// functions alike, so what is fitted stays right.
    pub(crate) fn pass(
        &self,
        atoms: &[usize],
        every: usize,
        visit: &mut dyn FnMut(usize, &[Part; 3]),
    ) {
        let n = self.context.samples();
        let rows: Vec<usize> = atoms
            .iter()
            .map(|i| self.library.atoms[*i].row as usize)
            .collect();
        let mut next = [0; 3];
        let columns: Vec<usize> = rows
            .iter()
            .map(|row| {
                next[*row] += 1;
                next[*row] - 1
            })
            .collect();
        let mut parts: [Part; 3] = Default::default();
        for (row, part) in parts.iter_mut().enumerate() {
            if self.data[row].is_empty() {
                continue;
            }
            part.columns = next[row] + 1;
            part.plain = vec![0.0; part.columns * STRIDE];
            if !self.whiteners[row].is_white() {
                part.white = vec![0.0; part.columns * STRIDE];
            }
        }
        let half = n.div_ceil(BLOCKS).max(1);
        let mut left = atoms.len();
        let weight = &self.context.weight;
        let mut finish = |range: Range<usize>, parts: &mut [Part; 3]| {
            for (row, part) in parts.iter_mut().enumerate() {
                if part.columns == 0 {
                    continue;
                }
                part.samples = range.len();
                let data = (part.columns - 1) * STRIDE + ORDER;
                part.plain[data..data + range.len()]
                    .copy_from_slice(&self.data[row][range.clone()]);
                self.whiteners[row].block(part.columns, range.len(), &part.plain, &mut part.white);
            }
            visit(range.start / half % 2, parts);
            // The end of this block is the past of the next.
            for part in parts.iter_mut().filter(|p| p.columns > 0) {
                for column in 0..part.columns {
                    let from = column * STRIDE;
                    let end = from + range.len();
                    part.plain.copy_within(end..end + ORDER, from);
                }
            }
        };
        if atoms.is_empty() {
            for first in (0..n).step_by(half) {
                let last = (first + half).min(n);
                for start in (first..last).step_by(CHUNK) {
                    if chosen(start / CHUNK, every) {
                        finish(start..(start + CHUNK).min(last), &mut parts);
                    }
                }
            }
            return;
        }
        self.fill(atoms, every, &mut |block, splines, i, values| {
            let part = &mut parts[rows[i]];
            let from = columns[i] * STRIDE + ORDER;
            let own = &mut part.plain[from..from + block.len()];
            let motion = &self.motions[atoms[i]];
            match motion.as_slice() {
                [] => own.copy_from_slice(values),
                [mean] => own.iter_mut().zip(values).for_each(|(o, v)| *o = v - mean),
                _ => match splines.basis() {
                    Some(basis) => basis.take_off(motion, values, own),
                    None => own.copy_from_slice(values),
                },
            }
            let weights = &weight[block.start..block.start + block.len()];
            if weights.iter().any(|w| *w != 1.0) {
                own.iter_mut().zip(weights).for_each(|(v, w)| *v *= w);
            }
            left -= 1;
            if left == 0 {
                left = atoms.len();
                finish(block.start..block.start + block.len(), &mut parts);
            }
        });
    }

    /// What atoms in these amounts take off the data of each row.
    pub(crate) fn left(&self, amounts: &[(usize, f64)]) -> [Vec<f64>; 3] {
        let mut left = self.data.clone();
        let atoms: Vec<usize> = amounts.iter().map(|a| a.0).collect();
        let weight = &self.context.weight;
        let mut smooth: [Vec<f64>; 3] = Default::default();
        for (i, x) in amounts {
            let row = self.library.atoms[*i].row as usize;
            let motion = &self.motions[*i];
            smooth[row].resize(motion.len(), 0.0);
            for (sum, m) in smooth[row].iter_mut().zip(motion) {
                *sum += x * m;
            }
        }
        self.fill(&atoms, 1, &mut |block, _, i, values| {
            let (row, x) = (self.library.atoms[atoms[i]].row as usize, amounts[i].1);
            let own = &mut left[row][block.start..block.start + block.len()];
            for ((l, v), w) in own.iter_mut().zip(values).zip(&weight[block.start..]) {
                *l -= x * v * w;
            }
        });
        for (row, smooth) in ROWS.iter().zip(smooth) {
            let own = &mut left[*row as usize];
            match (self.projector(*row), smooth.is_empty()) {
                (_, true) | (Projector::Nothing, _) => {}
                (Projector::Mean(_), _) => {
                    let pairs = own.iter_mut().zip(weight);
                    pairs.for_each(|(l, w)| *l += smooth[0] * w);
                }
                (Projector::Spline(spline), _) => {
                    let values = spline.values(&smooth);
                    for ((l, v), w) in own.iter_mut().zip(values).zip(weight) {
                        *l += v * w;
                    }
                }
            }
        }
        left
    }

    /// The sum of atoms as they are, of a row, at every sample.
    pub(crate) fn sum(&self, amounts: &[(usize, f64)], row: Row) -> Vec<f64> {
        let own: Vec<(usize, f64)> = amounts
            .iter()
            .filter(|(i, _)| self.library.atoms[*i].row == row)
            .copied()
            .collect();
        let atoms: Vec<usize> = own.iter().map(|a| a.0).collect();
        let mut sum = vec![0.0; self.context.samples()];
        self.fill(&atoms, 1, &mut |block, _, i, values| {
            let part = &mut sum[block.start..block.start + block.len()];
            part.iter_mut()
                .zip(values)
                .for_each(|(s, v)| *s += own[i].1 * v);
        });
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::chosen;

    #[test]
    fn one_block_of_each_group_is_chosen_and_not_always_the_same() {
        for every in [1, 2, 8] {
            let places: Vec<usize> = (0..100 * every).filter(|b| chosen(*b, every)).collect();
            let groups: Vec<usize> = places.iter().map(|b| b / every).collect();
            assert_eq!(groups, (0..100).collect::<Vec<_>>());
            for place in 0..every {
                let often = places.iter().filter(|b| *b % every == place).count();
                assert!(
                    often.abs_diff(100 / every) <= 3,
                    "{place} of {every}: {often}"
                );
            }
        }
    }
}
