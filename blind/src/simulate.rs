//! From the axis to the samples, stage by stage, with causes on the way.

use std::f64::consts::TAU;

use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::effect::{At, Hidden};
use crate::rows::Rows;
use crate::vibration::cubic;
use crate::world::World;

/// More samples than asked for, as some may get lost.
pub(crate) const SPARE: usize = 64;
/// Steps per sample where a circuit has memory.
const FINE: usize = 8;

/// How true to life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Finish {
    /// Nothing random, nothing rounded (but by a cause that works on codes).
    Clean,
    /// Noise from this seed, ADC and all: as recorded.
    Recorded(u64),
    /// Noise from this seed and codes, without the noise of the hidden causes: what a code becomes depends on both.
    Codes(u64),
}

/// Simulates a recording.
#[must_use]
pub(crate) fn simulate(world: &World, hidden: &[Hidden], finish: Finish) -> Rows {
    let n = world.samples + SPARE;
    let channels = analogue(world, hidden, n);
    let mut rows = Rows {
        time: (0..n).map(|k| k as f64 / world.rate).collect(),
        alpha: (0..n)
            .map(|k| angle(world, hidden, k as f64 / world.rate))
            .collect(),
        noise: [vec![0.0; n], vec![0.0; n]],
        ..Rows::default()
    };
    let seed = match finish {
        Finish::Clean => None,
        Finish::Recorded(seed) | Finish::Codes(seed) => Some(seed),
    };
    if let Some(seed) = seed {
        let mut random = StdRng::seed_from_u64(seed);
        let [cos, sin] = &mut rows.noise;
        for k in 0..n {
            for (channel, noise) in [&mut *cos, &mut *sin].into_iter().enumerate() {
                let normal: f64 = StandardNormal.sample(&mut random);
                noise[k] = world.noise * normal;
                if matches!(finish, Finish::Recorded(_)) {
                    let own: f64 = hidden
                        .iter()
                        .map(|(e, m)| e.noise(*m, channel, k, channels[channel][k]))
                        .sum();
                    noise[k] += own * world.amplitude[channel];
                }
            }
        }
        instruments(world, &mut rows, &mut random);
    }
    rows.volts = converted(world, hidden, &channels, &rows.noise, finish);
    for (effect, m) in hidden {
        effect.damage(*m, &mut rows, world);
    }
    rows.truncate(world.samples);
    rows
}

/// Reference and thermometer.
fn instruments(world: &World, rows: &mut Rows, random: &mut StdRng) {
    let mut normal = || -> f64 { StandardNormal.sample(random) };
    rows.reference = world.reference.map(|r| {
        let shown = rows.alpha.iter().map(|alpha| {
            let shown = r.sign * alpha + r.offset + r.noise * normal();
            if r.wrapped {
                shown.rem_euclid(TAU)
            } else {
                shown
            }
        });
        shown.collect()
    });
    rows.temperature = world.temperature.map(|warming| {
        let shown = rows.time.iter().map(|t| warming.at(*t) + 0.02 * normal());
        shown.collect()
    });
}

/// The true angle with what moves it.
fn angle(world: &World, hidden: &[Hidden], t: f64) -> f64 {
    let alpha = world.axis(t).alpha;
    let phi = alpha / f64::from(world.periods_per_revolution);
    alpha
        + hidden
            .iter()
            .map(|(e, m)| e.motion(*m, t, phi))
            .sum::<f64>()
}

/// The two channels before any memory, in amplitudes, and the time's state.
fn head(world: &World, hidden: &[Hidden], t: f64) -> (At, [f64; 2]) {
    let state = world.motion.at(t);
    let alpha = angle(world, hidden, t);
    let mut at = At {
        t,
        alpha,
        phi: alpha / f64::from(world.periods_per_revolution),
        speed: state.speed,
        acceleration: state.acceleration,
    };
    at.alpha += hidden.iter().map(|(e, m)| e.scale(*m, &at)).sum::<f64>();
    let mut pair = world.pair(at.alpha);
    for (effect, m) in hidden {
        pair = effect.channels(*m, &at, pair);
    }
    (at, pair)
}

/// With what couples over from before.
fn coupled(world: &World, hidden: &[Hidden], t: f64) -> (At, [f64; 2]) {
    let (at, mut pair) = head(world, hidden, t);
    for (effect, m) in hidden {
        if let Some(echo) = effect.echo(*m) {
            let (_, old) = head(world, hidden, t - echo.delay);
            pair[0] += echo.share[0] * old[1];
            pair[1] += echo.share[1] * old[0];
        }
    }
    (at, pair)
}

/// Both channels at the sampling instants, in amplitudes.
fn analogue(world: &World, hidden: &[Hidden], n: usize) -> [Vec<f64>; 2] {
    let instant = |channel: usize, k: usize| {
        let late: f64 = hidden.iter().map(|(e, m)| e.late(*m, channel, k)).sum();
        k as f64 / world.rate + late
    };
    let mut circuits = vec![];
    let mut before = 0.0f64;
    for (effect, m) in hidden {
        if let Some((circuit, memory)) = effect.circuit(*m, world) {
            circuits.push(circuit);
            before = before.max(memory);
        }
    }
    if circuits.is_empty() {
        return [0, 1].map(|channel| {
            (0..n)
                .map(|k| coupled(world, hidden, instant(channel, k)).1[channel])
                .collect()
        });
    }
    // Some samples more at both ends, for sampling that is late or early.
    let early = (before * world.rate).ceil() as usize + 8;
    let dt = 1.0 / (world.rate * FINE as f64);
    let begins = early as f64 / world.rate;
    let mut table = [vec![], vec![]];
    for j in 0..(early + n + 8) * FINE {
        let (at, mut pair) = coupled(world, hidden, j as f64 * dt - begins);
        for circuit in &mut circuits {
            pair = circuit.step(dt, &at, pair);
        }
        table[0].push(pair[0]);
        table[1].push(pair[1]);
    }
    [0, 1].map(|channel| {
        let table: &Vec<f64> = &table[channel];
        let read = |k: usize| {
            let place = (instant(channel, k) + begins) / dt;
            let at = (place.floor() as usize).clamp(1, table.len() - 3);
            cubic(
                [table[at - 1], table[at], table[at + 1], table[at + 2]],
                place - at as f64,
            )
        };
        (0..n).map(read).collect()
    })
}

/// Volts as the ADC shows them; not rounded if clean and no cause works on codes.
fn converted(
    world: &World,
    hidden: &[Hidden],
    channels: &[Vec<f64>; 2],
    noise: &[Vec<f64>; 2],
    finish: Finish,
) -> [Vec<f64>; 2] {
    let n = channels[0].len();
    let lsb = world.lsb();
    let half = 1i64 << (world.bits - 1);
    let volts =
        |channel: usize, k: usize| world.volts(channel, channels[channel][k]) + noise[channel][k];
    let convert = |channel: usize, k: usize| {
        let before = [0, 1].map(|c| volts(c, k.saturating_sub(1)) / lsb);
        let mut x = volts(channel, k) / lsb;
        let added: f64 = hidden
            .iter()
            .map(|(e, m)| e.transfer(*m, channel, k, x, before))
            .sum();
        x += added;
        if finish == Finish::Clean {
            return x * lsb;
        }
        let mut code = (x.round() as i64).clamp(-half, half - 1);
        for (effect, m) in hidden {
            code = effect.code(*m, channel, code);
        }
        code as f64 * lsb
    };
    [0, 1].map(|channel| (0..n).map(|k| convert(channel, k)).collect())
}
