//! Causes that no line of the catalogue means. A name given to one of these is a wrong name.

use std::f64::consts::TAU;

use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::effect::{At, Circuit, Effect};
use crate::effects::{Draw, Law, shares};
use crate::simulate::SPARE;
use crate::spectrum;
use crate::strange_circuits::{dielectric, kickback, memory, slew, spread_clock};

/// How a stranger is drawn.
type Stranger = (&'static str, fn(&mut Draw) -> Box<dyn Effect>);

/// All of them.
pub(crate) const STRANGERS: [Stranger; 14] = [
    ("tilt_with_acceleration", tilt),
    ("slew_limit", slew),
    ("reference_kickback", kickback),
    ("multiplexer_memory", memory),
    ("dielectric_absorption", dielectric),
    ("popcorn_noise", popcorn),
    ("carrier_noise", carrier),
    ("stray_light_pulses", stray_light),
    ("fading_harmonic", fading),
    ("harmonic_with_speed", speeding),
    ("half_order", half_order),
    ("loose_dust", dust),
    ("spread_clock", spread_clock),
    ("stepping_gain", stepping),
];

/// Largest speed and acceleration of the drive.
pub(crate) fn peaks(draw: &Draw) -> (f64, f64) {
    let seconds = draw.world.seconds();
    (0..400).fold((1e-9f64, 1e-9f64), |(speed, acceleration), k| {
        let state = draw.world.motion.at(seconds * f64::from(k) / 400.0);
        (
            speed.max(state.speed.abs()),
            acceleration.max(state.acceleration.abs()),
        )
    })
}

/// A head on a soft mount: it tilts with acceleration and the air gap changes one channel more.
fn tilt(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = shares(draw);
    let (_, peak) = peaks(draw);
    Law::new("tilt_with_acceleration", 0.3, move |m, at, u| {
        [0, 1].map(|c| u[c] * (1.0 + m * shares[c] * at.acceleration / peak))
    })
    .boxed()
}

/// A transistor that switches between two offsets at random times.
fn popcorn(draw: &mut Draw) -> Box<dyn Effect> {
    let seconds = draw.world.seconds();
    let flips = draw.random.random_range(12..80);
    let mut times: Vec<f64> = (0..flips)
        .map(|_| draw.random.random_range(0.0..seconds))
        .collect();
    times.sort_by(f64::total_cmp);
    let channel = draw.random.random_range(0..2);
    Law::new("popcorn_noise", 0.2, move |m, at, mut u| {
        let up = times.partition_point(|t| *t < at.t) % 2 == 0;
        u[channel] += if up { m } else { 0.0 };
        u
    })
    .boxed()
}

/// A carrier whose amplitude is noisy within a band: both channels alike.
fn carrier(draw: &mut Draw) -> Box<dyn Effect> {
    let count = draw.world.samples + SPARE;
    let corner = count as f64 * 10f64.powf(draw.random.random_range(-2.3..-1.3));
    let lines = count / 2;
    let power: f64 = (1..lines).map(|j| hill(j as f64 / corner)).sum();
    let wave = spectrum::wave(draw.random, count, lines, |j| {
        hill(j as f64 / corner) / power
    });
    let rate = draw.world.rate;
    Law::new("carrier_noise", 0.1, move |m, at, u| {
        let k = (at.t * rate).round().rem_euclid(wave.len() as f64) as usize;
        u.map(|u| u * (1.0 + m * wave[k.min(wave.len() - 1)]))
    })
    .boxed()
}

/// A band: nothing slow, nothing fast.
fn hill(x: f64) -> f64 {
    x * x / (1.0 + x.powi(4))
}

/// A lamp on a dimmer whose frequency wanders: no steady line.
fn stray_light(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = shares(draw);
    let seconds = draw.world.seconds();
    let cycles = draw.random.random_range(30.0..200.0);
    let wander = draw.random.random_range(0.1..0.3);
    let duty = draw.random.random_range(-0.6..0.6);
    let slow = TAU * draw.random.random_range(1.0..3.0);
    Law::new("stray_light_pulses", 0.2, move |m, at, u| {
        let x = at.t / seconds;
        let turns = cycles * (x + wander * (slow * x).sin() / slow);
        let lit = f64::from((TAU * turns).sin() > duty);
        [0, 1].map(|c| u[c] + m * shares[c] * lit)
    })
    .boxed()
}

/// A harmonic that dies away while a lens warms up.
fn fading(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = shares(draw);
    let order = f64::from(draw.random.random_range(3..=6));
    let tau = draw.world.seconds() * draw.random.random_range(0.05..0.2);
    let swap = draw.world.seconds() * draw.random.random_range(0.3..0.7);
    Law::new("fading_harmonic", 0.3, move |m, at, u| {
        // Its sign turns over on the way, so that none is left on average.
        let size = -((at.t - swap) / tau).tanh();
        [0, 1].map(|c| u[c] + m * shares[c] * size * (order * at.alpha + c as f64).cos())
    })
    .boxed()
}

/// An amplifier whose distortion grows with frequency and changes sign with direction.
fn speeding(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = shares(draw);
    let (peak, _) = peaks(draw);
    let order = f64::from(draw.random.random_range(3..=5));
    Law::new("harmonic_with_speed", 0.3, move |m, at, u| {
        let size = (at.speed / peak).powi(3);
        [0, 1].map(|c| u[c] + m * shares[c] * size * (order * at.alpha).sin())
    })
    .boxed()
}

/// A scale whose lines were written two by two: a signal at half the order.
fn half_order(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = shares(draw);
    let phase = draw.random.random_range(0.0..TAU);
    let order = [0.5, 1.5, 2.5][draw.random.random_range(0..3)];
    Law::new("half_order", 0.2, move |m, at, u| {
        [0, 1].map(|c| u[c] + m * shares[c] * (order * at.alpha + phase).cos())
    })
    .boxed()
}

/// Crumbs that fall across the head now and then, wherever the scale is.
fn dust(draw: &mut Draw) -> Box<dyn Effect> {
    let seconds = draw.world.seconds();
    let count = draw.random.random_range(3..10);
    let crumbs: Vec<(f64, f64, f64)> = (0..count)
        .map(|_| {
            let random = &mut draw.random;
            (
                random.random_range(0.05..0.95) * seconds,
                random.random_range(0.001..0.01) * seconds,
                random.random_range(0.3..1.0),
            )
        })
        .collect();
    Law::new("loose_dust", 0.8, move |m, at, u| {
        let dark: f64 = crumbs
            .iter()
            .map(|(when, width, size)| size * (-0.5 * ((at.t - when) / width).powi(2)).exp())
            .sum();
        u.map(|u| u * (1.0 - m * dark))
    })
    .boxed()
}

/// An automatic gain that steps, at times that nothing else tells.
fn stepping(draw: &mut Draw) -> Box<dyn Effect> {
    let seconds = draw.world.seconds();
    let mut level = 0.0;
    let steps: Vec<(f64, f64)> = (0..draw.random.random_range(4..14))
        .map(|_| {
            let normal: f64 = StandardNormal.sample(draw.random);
            level += normal;
            (draw.random.random_range(0.0..seconds), level)
        })
        .collect();
    Law::new("stepping_gain", 0.2, move |m, at, u| {
        let now: f64 = steps
            .iter()
            .filter(|(t, _)| *t < at.t)
            .map(|(_, size)| size)
            .sum();
        u.map(|u| u * (1.0 + m * now))
    })
    .boxed()
}

/// A circuit in both channels alike, made of a law of one.
pub(crate) struct Both<T>(pub(crate) [T; 2]);

/// One channel's circuit.
pub(crate) trait One {
    /// Output after the input has gone on to `x` within `dt` seconds.
    fn step(&mut self, dt: f64, x: f64) -> f64;
}

impl<T: One> Circuit for Both<T> {
    fn step(&mut self, dt: f64, _at: &At, pair: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|c: usize| self.0[c].step(dt, pair[c]))
    }
}
