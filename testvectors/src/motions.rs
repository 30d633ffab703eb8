//! Stimuli of motion: the signal is there, and the axis moves.

use std::f64::consts::TAU;

use nonius_model::spec::Calibration;

use crate::plant::{Codes, Plant};

pub(crate) fn standstill(plant: &Plant, _: usize) -> Codes {
    plant.at(0.3)
}

pub(crate) fn forwards(plant: &Plant, k: usize) -> Codes {
    plant.at(plant.slowly(0.017, k))
}

pub(crate) fn backwards(plant: &Plant, k: usize) -> Codes {
    plant.at(0.4 - plant.slowly(0.013, k))
}

/// What ties are looked for from.
pub(crate) fn slow_turn(plant: &Plant, k: usize) -> Codes {
    plant.at(plant.slowly(0.007, k))
}

/// At top speed, over to as fast the other way as slowly as there is time, and back.
pub(crate) fn sweep(plant: &Plant, k: usize) -> Codes {
    let n = plant.samples();
    plant.at(swept(k as f64 / n) * n * plant.top)
}

/// Position of a sweep over its time 0 … 1.
fn swept(t: f64) -> f64 {
    match t {
        t if t < 1.0 / 6.0 => t,
        t if t < 5.0 / 6.0 => {
            let turning = t - 1.0 / 6.0;
            1.0 / 6.0 + turning - 1.5 * turning * turning
        }
        t => 1.0 - t,
    }
}

/// So slow that the direction is the old one, then the other one.
pub(crate) fn creep(plant: &Plant, k: usize) -> Codes {
    // Rate below which the direction does not change, turns.
    let dead = plant.design.constants.direction_rate.value();
    let n = plant.samples();
    let t = k as f64 / n - 0.5;
    plant.at(0.3 + 4.0 * dead * n * t * t)
}

/// Over a period and back.
pub(crate) fn reversals(plant: &Plant, k: usize) -> Codes {
    let swing = plant.travelled(k) / 32.0;
    plant.at(0.65 * (1.0 - (swing * TAU).cos()))
}

/// So fast that bends rest, forwards and backwards, and a little slower.
pub(crate) fn fast(plant: &Plant, k: usize) -> Codes {
    let third = plant.rows / 3;
    let run = |of: usize| k.saturating_sub(of * third).min(third) as f64;
    let rate = Calibration::BEND_RATE;
    plant.at(rate * (1.13 * run(0) - 1.43 * run(1) + 0.93 * run(2)))
}

/// At top speed, and once gamma has settled a little slower and back within a sample, again and again: in each of some periods of travel,
/// then in one alone. The loop catches up by a tenth of a radian and more, in lock. Later so far at once that it is out of the lock window,
/// then that the estimate is across the signal, then that it points away from it, with all of the signal there. At last the signal is
/// small, and gone for two samples.
pub(crate) fn jolts(plant: &Plant, k: usize) -> Codes {
    let (design, rows, top) = (plant.design, plant.rows, plant.top);
    let spec = &design.spec;
    let slower = 0.4 * spec.tracking.bandwidth_hz / spec.adc.sample_rate_hz;
    let run = ((1.3 / top) as usize).max(1);
    let slow = |n: usize| n / (2 * run) * run + (n % (2 * run)).min(run);
    let busy = 8 * run;
    let since = k.saturating_sub(2 * rows / 5);
    let alone = since.saturating_sub(busy + 8 * run).min(4 * run);
    let slowly = slow(since.min(busy)) + alone;
    // Small for two samples, across the estimate: a little more than the least radius in lock, and what the loop leaves of that.
    let least = 19 * rows / 20;
    let (jump, gain) = match k {
        k if 5 * k < 4 * rows => (0.0, 1.0),
        k if 20 * k < 17 * rows => (0.14, 1.0),
        k if 20 * k < 18 * rows => (0.44, 1.0),
        k if k < least => (0.89, 1.0),
        k if k < least + 2 => {
            let radius = design.constants.lock_radius.value();
            (1.14, if k == least { radius + 0.03 } else { radius })
        }
        k if k < least + 4 => (0.89, 0.0),
        _ => (0.89, 1.0),
    };
    let turns = top * k as f64 - slower.min(top / 2.0) * slowly as f64 + jump;
    plant.faded(turns, gain)
}
