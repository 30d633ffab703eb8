//! What so much of each atom does, sample by sample, and what it leaves of the data.

use super::Samples;
use crate::model::taken::Projector;
use crate::shapes::library::{ROWS, Row};

impl Samples<'_> {
    /// What atoms in these amounts take off the data of each row.
    pub(crate) fn left(&self, amounts: &[(usize, f64)]) -> [Vec<f64>; 3] {
        let mut left = self.data.clone();
        let atoms: Vec<usize> = amounts.iter().map(|a| a.0).collect();
        let weight = &self.context.weight;
        // What all together do in a block, and what of it the motion follows.
        let mut together: [Vec<f64>; 3] = Default::default();
        let used = |row: Row| atoms.iter().any(|i| self.library.atoms[*i].row == row);
        let mut smooth = ROWS.map(|row| match self.projector(row, 1) {
            _ if !used(row) => vec![],
            Projector::Nothing => vec![],
            Projector::Mean => vec![0.0],
            Projector::Spline(spline) => vec![0.0; spline.count()],
        });
        let mut more = atoms.len();
        self.fill(&atoms, 1, &mut |block, splines, i, values| {
            let (row, x) = (self.library.atoms[atoms[i]].row as usize, amounts[i].1);
            let own = &mut together[row];
            own.resize(block.len(), 0.0);
            for ((o, v), w) in own.iter_mut().zip(values).zip(&weight[block.start..]) {
                *o += x * v * w;
            }
            more -= 1;
            if more > 0 {
                return;
            }
            more = atoms.len();
            for ((own, left), smooth) in together.iter_mut().zip(&mut left).zip(&mut smooth) {
                let pairs = left.iter_mut().skip(block.start).zip(own.iter());
                pairs.for_each(|(l, o)| *l -= o);
                match smooth.len() {
                    0 => {}
                    1 => smooth[0] += own.iter().sum::<f64>(),
                    _ if own.is_empty() => {}
                    _ => splines
                        .basis()
                        .into_iter()
                        .for_each(|b| b.accumulate(own, smooth)),
                }
                own.clear();
            }
        });
        self.solved(smooth.iter_mut(), 1);
        for ((row, smooth), own) in ROWS.iter().zip(smooth).zip(&mut left) {
            match self.projector(*row, 1) {
                _ if smooth.is_empty() => {}
                Projector::Nothing => {}
                Projector::Mean => {
                    let pairs = own.iter_mut().zip(weight);
                    pairs.for_each(|(l, w)| *l += smooth[0] * w);
                }
                Projector::Spline(spline) => {
                    let values = spline.values(&smooth);
                    for ((l, v), w) in own.iter_mut().zip(values).zip(weight) {
                        *l += v * w;
                    }
                }
            }
        }
        left
    }

    /// The sum of atoms as they are, of a row, sample by sample: of one block in so many, 0 elsewhere.
    pub(crate) fn sum(&self, amounts: &[(usize, f64)], row: Row, every: usize) -> Vec<f64> {
        let own: Vec<(usize, f64)> = amounts
            .iter()
            .filter(|(i, _)| self.library.atoms[*i].row == row)
            .copied()
            .collect();
        let atoms: Vec<usize> = own.iter().map(|a| a.0).collect();
        let mut sum = vec![0.0; self.context.samples()];
        self.fill(&atoms, every, &mut |block, _, i, values| {
            let part = &mut sum[block.start..block.start + block.len()];
            part.iter_mut()
                .zip(values)
                .for_each(|(s, v)| *s += own[i].1 * v);
        });
        sum
    }
}
