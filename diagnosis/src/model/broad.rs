//! What any cause could explain is taken off before the noise is measured.
//!
//! Of a short recording, shapes of every domain together explain a good part of the noise itself, and what they leave has holes in its
//! spectrum: whitened by that, noise looks like a cause. So a domain is taken off only where it explains more than as many free
//! numbers explain of noise, and what is taken off makes the rest no quieter.

use super::System;
use crate::causes::Catalogue;
use crate::library::{Row, Shape};
use crate::statistics::at_most_of_noise;

/// What is taken off one row.
#[derive(Default)]
pub(super) struct Taken {
    /// Atoms and how much of each.
    pub(super) amounts: Vec<(usize, f64)>,
    /// Free numbers in them.
    pub(super) freedom: usize,
}

/// What some atoms explain of one row.
struct Explained {
    x: Vec<f64>,
    freedom: usize,
    /// Share of the row's power that they leave.
    left: f64,
}

fn explained(system: &System, atoms: &[usize], samples: f64) -> Explained {
    let shapes: Vec<Shape> = atoms.iter().map(|i| Shape(vec![(*i, 1.0)])).collect();
    let solution = system.total.of(&shapes).solve();
    Explained {
        freedom: solution.rank,
        left: (1.0 - solution.explained / samples).max(f64::MIN_POSITIVE),
        x: solution.x,
    }
}

/// The five parameters, what is `known`, and of the domains those that explain more than noise. The row's data are in units of their
/// rms.
pub(super) fn taken(system: &System, catalogue: &Catalogue, known: &[usize], row: Row) -> Taken {
    let samples = system.samples.data[row as usize].len() as f64 / system.every as f64;
    let own = |shapes: &[Shape]| -> Vec<usize> {
        let atoms = shapes.iter().flat_map(|s| s.0.iter().map(|part| part.0));
        let atoms = atoms.chain(known.iter().copied());
        let mut atoms: Vec<usize> = atoms
            .filter(|i| system.samples.library.atoms[*i].row == row)
            .collect();
        atoms.sort_unstable();
        atoms.dedup();
        atoms
    };
    let mut shapes = catalogue.parameters.clone();
    let mut domains: Vec<&Vec<Shape>> = catalogue.generic.values().collect();
    let mut atoms = own(&shapes);
    let mut now = explained(system, &atoms, samples);
    loop {
        let beyond = |domain: &Vec<Shape>| {
            let atoms = own(&[shapes.as_slice(), domain].concat());
            let with = explained(system, &atoms, samples);
            let gain = 0.5 * samples * (now.left / with.left).ln();
            let more = gain - at_most_of_noise(with.freedom.saturating_sub(now.freedom));
            (more, atoms, with)
        };
        let tried = domains.iter().enumerate().map(|(i, d)| (i, beyond(d)));
        let best = tried.max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let Some((i, (_, with_atoms, with))) = best.filter(|(_, (more, ..))| *more > 0.0) else {
            break;
        };
        shapes.extend(domains.remove(i).iter().cloned());
        (atoms, now) = (with_atoms, with);
    }
    Taken {
        amounts: atoms.into_iter().zip(now.x).collect(),
        freedom: now.freedom,
    }
}
