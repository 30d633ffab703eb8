//! Stimuli at the limits of codes and parameters.

use std::f64::consts::TAU;

use rand::{Rng, SeedableRng, rngs::StdRng};

use crate::plant::{Codes, Plant};

/// Both rails of both channels, and the middle.
pub(crate) fn corners(plant: &Plant, k: usize) -> Codes {
    if k % 7 == 3 {
        return (plant.middle, plant.middle);
    }
    let rail = |bit: usize| if k & bit == 0 { plant.full } else { plant.low };
    (rail(1), rail(2))
}

/// The parameters are led to their bounds and beyond before a gear has ended calm, then come codes that the correction cannot hold.
pub(crate) fn bounds(plant: &Plant, k: usize) -> Codes {
    let Plant {
        rows,
        amplitude: a,
        offset: o,
        beta,
        ..
    } = *plant;
    let t = ((k as f64 / plant.samples() - 0.03) * 8.0).clamp(0.0, 1.0);
    let alpha = TAU * k as f64 * plant.top.min(1.0 / 20.0);
    if 3 * k < 2 * rows {
        let cos = a * (1.0 - 0.5 * t) * alpha.cos() + o * 6.0 * t;
        let sin = a * (1.0 - 0.5 * t) * (alpha - beta * 6.0 * t).sin() - o * 6.0 * t;
        (plant.code(cos), plant.code(sin))
    } else {
        let rail = |v: f64| if v < 0.0 { plant.low } else { plant.full };
        (rail(alpha.cos()), rail(alpha.sin()))
    }
}

/// So small a signal that both gains come to rest near their bounds, and later a little smaller, beyond the limit.
pub(crate) fn small(plant: &Plant, k: usize) -> Codes {
    let early = k as f64 / plant.samples() < 0.62;
    of_gains(plant, k, if early { 14.6 } else { 16.2 })
}

/// The same, and later at them.
pub(crate) fn smaller(plant: &Plant, k: usize) -> Codes {
    let early = k as f64 / plant.samples() < 0.9;
    of_gains(plant, k, if early { 15.4 } else { 18.0 })
}

/// Gains at so many sixteenths of their bound make it a circle; the limit of what is near the bound is 15.
fn of_gains(plant: &Plant, k: usize, sixteenths: f64) -> Codes {
    let constants = &plant.design.constants;
    let nominal = constants.theta_1_nominal.ideal;
    let small = nominal / (nominal + constants.gain_near_bound.value() * sixteenths / 15.0);
    let alpha = TAU * k as f64 * plant.top / 2.5;
    let code = |v: f64| plant.code(plant.amplitude * small * v);
    (code(alpha.cos()), code(alpha.sin()))
}

/// Any codes.
pub(crate) fn random(plant: &Plant) -> Vec<Codes> {
    let mut random = StdRng::seed_from_u64(1);
    let mut code = || random.random_range(plant.low..=plant.full);
    (0..plant.rows).map(|_| (code(), code())).collect()
}
