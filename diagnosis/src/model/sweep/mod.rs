//! One pass over the samples: functions are made block by block, motion is taken off, the rest whitened, and only the
//! sums of products are kept. So memory does not grow with the number of causes.

mod amounts;

use std::cell::OnceCell;
use std::ops::Range;

use crate::context::Context;
use crate::model::part::{CHUNK, Part, STRIDE};
use crate::model::taken::{Motions, Projector, Taken};
use crate::model::whiten::{ORDER, Whitener};
use crate::motion::spline::{Basis, Spline};
use crate::numerics::solve::dot;
use crate::shapes::block::{Block, Shared};
use crate::shapes::library::{Library, Row};

/// Interleaved blocks, every other one of which is held out.
const BLOCKS: usize = 20;

/// Whether a block is looked at where of so many one is: one of each group, and not always the same, for the motion may
/// repeat itself.
fn chosen(block: usize, every: usize) -> bool {
    /// The golden ratio's fraction: its multiples spread evenly over a turn.
    const SPREAD: f64 = 0.618_033_988_749_894_9;
    let place = (block / every) as f64 * SPREAD;
    block % every == (place.fract() * every as f64) as usize
}

/// Samples of either half of interleaved blocks: so many of the one, then of the other.
pub(crate) fn half(samples: usize) -> usize {
    samples.div_ceil(BLOCKS).max(1)
}

/// The blocks that are looked at where of so many one is.
fn blocks(samples: usize, every: usize) -> impl Iterator<Item = Range<usize>> {
    let half = half(samples);
    let of = move |first: usize| {
        let last = (first + half).min(samples);
        let starts = (first..last).step_by(CHUNK);
        starts.map(move |start| start..(start + CHUNK).min(last))
    };
    let all = (0..samples).step_by(half).flat_map(of);
    all.filter(move |range| chosen(range.start / CHUNK, every))
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
    /// No sample is left out.
    all_count: bool,
    /// What is taken off each atom.
    whole: Motions<'a>,
    /// The same where one block in several is looked at.
    part: Option<Motions<'a>>,
}

impl<'a> Samples<'a> {
    /// `every`: of so many blocks, one may be looked at.
    pub(crate) fn new(
        context: &'a Context,
        library: Library,
        data: [Vec<f64>; 3],
        every: usize,
    ) -> Self {
        let weight = &context.weight;
        let spline = context.spline.as_ref();
        let of_part = || {
            let mut looked_at = vec![0.0; weight.len()];
            for range in blocks(weight.len(), every) {
                looked_at[range.clone()].copy_from_slice(&weight[range]);
            }
            Motions::part(spline, &looked_at, every, CHUNK)
        };
        Self {
            context,
            library,
            data,
            whiteners: Default::default(),
            all_count: weight.iter().all(|w| *w == 1.0),
            whole: Motions::whole(spline, weight),
            part: (every > 1).then(of_part).flatten(),
        }
    }

    /// From now on all samples are looked at.
    pub(crate) fn forget_the_part(&mut self) {
        self.part = None;
    }

    /// Whether the motion of a part is fitted to that alone.
    pub(crate) fn follows_a_part(&self) -> bool {
        self.part.is_some()
    }

    /// What is taken off each atom where of so many blocks one is looked at.
    fn motions(&self, every: usize) -> &Motions<'a> {
        let part = self.part.as_ref().filter(|_| every > 1);
        part.unwrap_or(&self.whole)
    }

    /// How what cannot be seen is taken off a row where of so many blocks one is looked at.
    fn projector(&self, row: Row, every: usize) -> Projector<'_> {
        let motions = self.motions(every);
        match row {
            Row::Radial => Projector::Nothing,
            Row::Tangential if self.context.against_reference.is_some() => Projector::Mean,
            _ => motions
                .spline
                .as_deref()
                .map_or(Projector::Nothing, Projector::Spline),
        }
    }

    /// Samples that count in either half of the interleaved blocks, of so many of which one is looked at.
    pub(crate) fn counts(&self, every: usize) -> [f64; 2] {
        let half = half(self.context.samples());
        let mut counts = [0.0; 2];
        for range in blocks(self.context.samples(), every) {
            let of = range.start / half % 2;
            counts[of] += self.context.weight[range].iter().sum::<f64>();
        }
        counts
    }

    /// Square of an atom before its motion is taken off, in one block of so many; 0 where there is none to take off.
    pub(crate) fn square(&self, atom: usize, every: usize) -> f64 {
        self.motions(every).of(atom).map_or(0.0, |t| t.square)
    }

    /// Fits the motion to those of some atoms that have none yet, in one block of so many.
    pub(crate) fn take_motion_off(&mut self, atoms: &[usize], every: usize) {
        let (mut wanted, mut sums) = (vec![], vec![]);
        for atom in self.motions(every).lacking(atoms) {
            let sum = match self.projector(self.library.atoms[atom].row, every) {
                Projector::Nothing => continue,
                Projector::Mean => vec![0.0],
                Projector::Spline(spline) => vec![0.0; spline.count()],
            };
            wanted.push(atom);
            sums.push(sum);
        }
        let weight = &self.context.weight;
        let mut weighted = vec![];
        let mut squares = vec![0.0; wanted.len()];
        let looked_at = self.motions(every).every;
        self.fill(&wanted, looked_at, &mut |block, splines, i, values| {
            let range = block.start..block.start + block.len();
            let weights = &weight[range];
            let counted = if self.all_count {
                values
            } else {
                weighted.clear();
                weighted.extend(values.iter().zip(weights).map(|(v, w)| v * w));
                &weighted
            };
            squares[i] += dot(counted, counted);
            let own = &mut sums[i];
            match own.len() {
                1 => own[0] += counted.iter().sum::<f64>(),
                _ => splines
                    .basis()
                    .into_iter()
                    .for_each(|b| b.accumulate(counted, own)),
            }
        });
        self.solved(sums.iter_mut(), every);
        let fresh = sums.into_iter().zip(squares).zip(wanted);
        let motions = self.part.as_mut().filter(|_| every > 1);
        let motions = motions.unwrap_or(&mut self.whole);
        for ((motion, square), atom) in fresh {
            motions.set(atom, Taken { motion, square });
        }
    }

    /// Sums of products, with 1 or with B-splines → means, or coefficients.
    fn solved<'b>(&self, sums: impl Iterator<Item = &'b mut Vec<f64>>, every: usize) {
        let motions = self.motions(every);
        let (means, splines): (Vec<_>, Vec<_>) = sums.partition(|sum| sum.len() == 1);
        for mean in means {
            mean[0] /= motions.counts.max(1.0);
        }
        if let Some(spline) = &motions.spline {
            spline.solve_all(splines.into_iter());
        }
    }

    /// Leaves out atoms that are not kept; the new number of each.
    pub(crate) fn retain(&mut self, keep: impl Fn(usize) -> bool) -> Vec<Option<usize>> {
        let map = self.library.retain(keep);
        self.whole.retain(&map);
        if let Some(part) = &mut self.part {
            part.retain(&map);
        }
        map
    }

    /// Makes the functions of atoms block by block, of so many blocks in one, as they are: block, splines of it, which of the
    /// atoms, values.
    fn fill(&self, atoms: &[usize], every: usize, visit: &mut Visit) {
        if atoms.is_empty() {
            return;
        }
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
        for range in blocks(self.context.samples(), every) {
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

    /// Goes through the samples, of so many blocks through one: the half of the blocks that it belongs to, and the three
    /// rows. Their motions are those that were fitted to one of so many blocks, `followed`. What whitening takes for the past of a
    /// block is the end of the one that was looked at before: for data and functions alike, so what is fitted stays right.
    pub(crate) fn pass(
        &self,
        atoms: &[usize],
        every: usize,
        followed: usize,
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
        let half = half(n);
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
            blocks(n, every).for_each(|range| finish(range, &mut parts));
            return;
        }
        let motions = self.motions(followed);
        self.fill(atoms, every, &mut |block, splines, i, values| {
            let part = &mut parts[rows[i]];
            let from = columns[i] * STRIDE + ORDER;
            let own = &mut part.plain[from..from + block.len()];
            let motion = motions.of(atoms[i]);
            let motion = motion.map_or(&[][..], |taken| &taken.motion);
            match motion {
                [] => own.copy_from_slice(values),
                [mean] => own.iter_mut().zip(values).for_each(|(o, v)| *o = v - mean),
                _ => match splines.basis() {
                    Some(basis) => basis.take_off(motion, values, own),
                    None => own.copy_from_slice(values),
                },
            }
            if !self.all_count {
                let weights = &weight[block.start..block.start + block.len()];
                own.iter_mut().zip(weights).for_each(|(v, w)| *v *= w);
            }
            left -= 1;
            if left == 0 {
                left = atoms.len();
                finish(block.start..block.start + block.len(), &mut parts);
            }
        });
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
