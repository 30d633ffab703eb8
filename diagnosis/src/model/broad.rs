//! What any cause could explain is taken off before the noise is measured.
//!
//! Of a short recording, shapes of every domain together explain a good part of the noise itself, and what they leave has holes in its
//! spectrum: whitened by that, noise looks like a cause. So where no domain explains more than as many free numbers do of noise, the
//! noise of a row is measured before they are taken off, and what the five parameters fit makes it no quieter.

use super::{Moments, System};
use crate::causes::Catalogue;
use crate::library::{ROWS, Row, Shape};
use crate::statistics::at_most_of_noise;

/// What is taken off one row.
struct Own {
    /// Atoms and how much of each.
    amounts: Vec<(usize, f64)>,
    /// Free numbers in them.
    freedom: usize,
    /// What they explain of the sum of squares.
    explained: f64,
    /// Domains in them.
    domains: usize,
}

/// What is taken off, row by row.
pub(super) struct Taken([Own; 3]);

impl Taken {
    pub(super) fn amounts(&self) -> Vec<(usize, f64)> {
        let rows = self.0.iter();
        rows.flat_map(|own| own.amounts.iter().copied()).collect()
    }

    /// No domain explains more than noise.
    pub(super) fn is_noise(&self, row: Row) -> bool {
        self.0[row as usize].domains == 0
    }

    pub(super) fn freedom(&self, row: Row) -> usize {
        self.0[row as usize].freedom
    }
}

/// The best amounts of those of some atoms that stand in a row.
fn fitted(system: &System, atoms: &[usize], row: Row) -> Own {
    let own = |i: &&usize| system.samples.library.atoms[**i].row == row;
    let mut atoms: Vec<usize> = atoms.iter().filter(own).copied().collect();
    atoms.sort_unstable();
    atoms.dedup();
    let shapes: Vec<Shape> = atoms.iter().map(|i| Shape(vec![(*i, 1.0)])).collect();
    let solution = system.total.of(&shapes).solve();
    Own {
        freedom: solution.rank,
        explained: solution.explained,
        domains: 0,
        amounts: atoms.into_iter().zip(solution.x).collect(),
    }
}

/// All of these atoms.
pub(super) fn all(system: &System, atoms: &[usize]) -> Taken {
    Taken(ROWS.map(|row| fitted(system, atoms, row)))
}

/// The five parameters, what is `known`, and of the domains those that explain more than noise; `plain` are the sums of products that
/// the system was made of.
pub(super) fn seen(
    system: &System,
    catalogue: &Catalogue,
    known: &[usize],
    plain: &Moments,
) -> Taken {
    let counts: f64 = system.context.weight.iter().sum();
    Taken(ROWS.map(|row| {
        let power = plain.power(row) / system.samples.whiteners[row as usize].sigma.powi(2);
        seen_in_row(
            system,
            catalogue,
            known,
            row,
            (power, counts / system.every as f64),
        )
    }))
}

/// The same of one row, of such a sum of squares over so many samples.
fn seen_in_row(
    system: &System,
    catalogue: &Catalogue,
    known: &[usize],
    row: Row,
    (power, samples): (f64, f64),
) -> Own {
    let atoms_of = |shapes: &[Shape]| -> Vec<usize> {
        let all = shapes.iter().flat_map(|s| s.0.iter().map(|part| part.0));
        all.collect()
    };
    let left = |own: &Own| (1.0 - own.explained / power).max(1e-12);
    let mut domains: Vec<Vec<usize>> = catalogue.generic.values().map(|d| atoms_of(d)).collect();
    let mut atoms = [&atoms_of(&catalogue.parameters), known].concat();
    let mut now = fitted(system, &atoms, row);
    loop {
        let beyond = |domain: &Vec<usize>| {
            let with = fitted(system, &[atoms.as_slice(), domain].concat(), row);
            let gain = 0.5 * samples * (left(&now) / left(&with)).ln();
            let numbers = with.freedom.saturating_sub(now.freedom);
            (gain - at_most_of_noise(numbers), with)
        };
        let tried = domains.iter().map(beyond).enumerate();
        let best = tried.max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let Some((i, (_, with))) = best.filter(|(_, (more, _))| *more > 0.0) else {
            return now;
        };
        atoms.extend(domains.remove(i));
        now = Own {
            domains: now.domains + 1,
            ..with
        };
    }
}
