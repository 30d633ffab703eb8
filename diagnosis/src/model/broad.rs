//! What any cause could explain is taken off before the noise is measured.
//!
//! Of a short recording, shapes of every domain together explain a good part of the noise itself, and what they leave has holes in its
//! spectrum: whitened by that, noise looks like a cause. So where no domain explains more than as many free numbers do of noise, the
//! noise of a row is measured before they are taken off, and what the five parameters fit makes it no quieter.

use super::{ROUNDING, System, atoms_of};
use crate::causes::{self, Catalogue};
use crate::model::whiten::Whitener;
use crate::noise::flicker;
use crate::numerics::solve::Normal;
use crate::numerics::statistics::at_most_of_noise;
use crate::shapes::library::{ROWS, Row, Shape};

/// So many times as many samples as a part has tell slow noise from amounts that are off.
const MORE: usize = 8;

impl System<'_> {
    /// Measures the noise of every row, its colour included, beside causes that are `known`, and finds flicker noise.
    pub(super) fn measure_noise(&mut self, catalogue: &Catalogue, known: &[usize]) {
        let (context, every) = (self.context, self.every);
        let mut any = catalogue.broad.clone();
        any.extend(known);
        any.sort_unstable();
        any.dedup();
        let along = self.along_all(&any);
        let mut left = self.samples.left(&all(self, (&along, &any)));
        self.flicker = flicker::find(context, &left[0]);
        if every > 1 && self.flicker.is_some() {
            self.flicker = flicker::find(context, &self.left_of_radius(&any));
        }
        let powers = self.moments(&[], every).powers();
        let known = Baseline::new(self, catalogue, known, powers, (&along, &any));
        let mut more = self.samples.left(&known.amounts());
        let fast = if left[2].is_empty() {
            Row::Tangential
        } else {
            Row::Motion
        };
        let counts: f64 = context.weight.iter().sum();
        for (left, of_noise) in [(&mut left, false), (&mut more, true)] {
            let own = std::mem::take(&mut left[fast as usize]);
            left[fast as usize] = causes::without_cogging(context, own);
            // What does not count is nothing there, and of noise alone what is fitted goes with it: neither makes the rest quieter.
            for (left, row) in left.iter_mut().zip(ROWS) {
                let fitted = if of_noise { known.freedom(row) } else { 0 };
                let free = (counts - fitted as f64).max(1.0);
                let louder = (context.samples() as f64 / free).sqrt();
                left.iter_mut().for_each(|l| *l *= louder);
            }
        }
        for row in ROWS {
            let [left, more] = [&left, &more].map(|l| &l[row as usize]);
            if left.is_empty() {
                continue;
            }
            let gone = match (&context.spline, row) {
                (_, Row::Radial) => 0.0,
                (_, Row::Tangential) if context.against_reference.is_some() => 0.0,
                (Some(spline), _) => 0.7 / spline.spacing(),
                (None, _) => 0.0,
            };
            // A reference without noise says nothing about how well a spline follows real motion: that is worth as much
            // as the channels could show, at every frequency.
            let noise = self.samples.whiteners[Row::Radial as usize].sigma;
            let least = if row == Row::Motion { noise } else { 0.0 };
            let least = least.max(ROUNDING);
            // What all shapes leave of noise alone has a colour of their making.
            let noise_alone = if known.is_noise_beside(row) {
                more
            } else {
                left
            };
            let mut whitener = Whitener::of(noise_alone, gone, least);
            if row == Row::Tangential {
                whitener.sigma = whitener.sigma.max(0.05 * noise);
            }
            self.samples.whiteners[row as usize] = whitener;
        }
    }

    /// Normal equations of atoms without the motion of all samples. What the motion of a part of them takes nearly off would have
    /// any amount there, and would be loud elsewhere.
    fn along_all(&mut self, atoms: &[usize]) -> Normal {
        if !self.samples.follows_a_part() {
            return self.total.only(atoms);
        }
        let moments = self.moments_along(atoms, self.every, 1);
        self.units(&moments, atoms, 1)
    }

    /// What the best amounts of some atoms leave of the radius, fitted to several times as many samples as a part has. Amounts that were
    /// fitted to a part are off by more than all samples would allow, and slow functions with such amounts leave what looks like
    /// slow noise.
    fn left_of_radius(&mut self, atoms: &[usize]) -> Vec<f64> {
        let radial = self.in_row(atoms, Row::Radial);
        let own: Vec<usize> = radial.map(|i| atoms[i]).collect();
        let every = self.every.div_ceil(MORE);
        let moments = self.moments(&own, every);
        let normal = self.units(&moments, &own, every);
        let shapes: Vec<Shape> = (0..own.len()).map(|i| Shape(vec![(i, 1.0)])).collect();
        let x = normal.of(&shapes).solve().x;
        let amounts: Vec<(usize, f64)> = own.into_iter().zip(x).collect();
        let [radial, ..] = self.samples.left(&amounts);
        radial
    }
}

/// What is taken off one row.
struct Own {
    /// Atoms and how much of each.
    amounts: Vec<(usize, f64)>,
    /// Free numbers in them.
    freedom: usize,
    /// What they explain of the sum of squares.
    explained: f64,
}

/// Amounts of what is taken off, row by row.
fn amounts(rows: &[Own; 3]) -> Vec<(usize, f64)> {
    let all = rows.iter().flat_map(|own| own.amounts.iter());
    all.copied().collect()
}

/// Normal equations, and the atoms whose they are, in the order of their numbers.
type Of<'a> = (&'a Normal, &'a [usize]);

/// The best amounts of those of some atoms that stand in a row.
fn fitted(system: &System, (normal, all): Of, atoms: &[usize], row: Row) -> Own {
    let own = |i: &&usize| system.samples.library.atoms[**i].row == row;
    let mut atoms: Vec<usize> = atoms.iter().filter(own).copied().collect();
    atoms.sort_unstable();
    atoms.dedup();
    let shape = |i: &usize| Shape(vec![(*i, 1.0)]).among(all);
    let shapes: Vec<Shape> = atoms.iter().map(shape).collect();
    let solution = normal.of(&shapes).solve();
    Own {
        freedom: solution.rank,
        explained: solution.explained,
        amounts: atoms.into_iter().zip(solution.x).collect(),
    }
}

/// The best amounts of all of these atoms.
fn all(system: &System, of: Of) -> Vec<(usize, f64)> {
    amounts(&ROWS.map(|row| fitted(system, of, of.1, row)))
}

/// The five parameters and what is known, as they are taken off.
struct Baseline {
    rows: [Own; 3],
    noise: [bool; 3],
}

impl Baseline {
    /// With causes that are `known`; `powers` are the squares of the data, `of` equations that hold all of them
    /// and every generic shape.
    fn new(
        system: &System,
        catalogue: &Catalogue,
        known: &[usize],
        powers: [f64; 3],
        of: Of,
    ) -> Self {
        let atoms = [&atoms_of(&catalogue.parameters), known].concat();
        let rows = ROWS.map(|row| fitted(system, of, &atoms, row));
        let counts: f64 = system.context.weight.iter().sum();
        let samples = counts / system.every as f64;
        let noise = ROWS.map(|row| {
            let power = powers[row as usize] / system.samples.whiteners[row as usize].sigma.powi(2);
            let left = |own: &Own| (1.0 - own.explained / power).max(1e-12);
            let without = &rows[row as usize];
            let explains = |domain: &Vec<Shape>| {
                let with = fitted(system, of, &[&atoms[..], &atoms_of(domain)].concat(), row);
                let gain = 0.5 * samples * (left(without) / left(&with)).ln();
                let numbers = with.freedom.saturating_sub(without.freedom);
                gain > at_most_of_noise(numbers)
            };
            !catalogue.generic.values().any(explains)
        });
        Self { rows, noise }
    }

    fn amounts(&self) -> Vec<(usize, f64)> {
        amounts(&self.rows)
    }

    /// No domain explains more of a row than as many free numbers do of noise.
    fn is_noise_beside(&self, row: Row) -> bool {
        self.noise[row as usize]
    }

    /// Free numbers in a row.
    fn freedom(&self, row: Row) -> usize {
        self.rows[row as usize].freedom
    }
}
