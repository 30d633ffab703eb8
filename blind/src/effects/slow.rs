//! What changes slowly, and what changes with the direction.

use std::f64::consts::TAU;

use rand::Rng;

use super::{Draw, Law};
use crate::effect::Effect;

type Course = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// A course over the recording, about one in size: a parabola; wild: warming up, or a slow sway of no one frequency.
/// With a temperature column it follows the temperature.
fn course(draw: &mut Draw) -> Course {
    let seconds = draw.world.seconds();
    if let Some(warming) = draw.world.temperature {
        let half = warming.at(seconds / 2.0);
        return Box::new(move |t| (warming.at(t) - half) / warming.rise);
    }
    let random = &mut draw.random;
    if !draw.wild {
        let bend = random.random_range(-0.7..0.7);
        return Box::new(move |t| {
            let x = 2.0 * t / seconds - 1.0;
            x + bend * x * x
        });
    }
    if random.random() {
        let tau = seconds * random.random_range(0.08..0.5);
        let begins = seconds * random.random_range(0.0..0.3);
        return Box::new(move |t| -((begins - t).min(0.0) / tau).exp());
    }
    let waves: Vec<(f64, f64, f64)> = (1..6)
        .map(|j| {
            let rate = TAU * (f64::from(j) * 0.6 + random.random_range(-0.2..0.2)) / seconds;
            (
                random.random_range(0.3..1.0) / f64::from(j),
                rate,
                random.random_range(0.0..TAU),
            )
        })
        .collect();
    Box::new(move |t| waves.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum())
}

/// Offsets that wander.
pub(crate) fn offset(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = super::statics::shares(draw);
    let course = course(draw);
    Law::new("offset_drift", 0.2, move |m, at, u| {
        let now = m * course(at.t);
        [0, 1].map(|c| u[c] + shares[c] * now)
    })
    .boxed()
}

/// Gains that wander.
pub(crate) fn gain(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = super::statics::shares(draw);
    let course = course(draw);
    Law::new("gain_drift", 0.2, move |m, at, u| {
        let now = m * course(at.t);
        [0, 1].map(|c| u[c] * (1.0 + shares[c] * now))
    })
    .boxed()
}

/// Points in time at which the last direction is remembered.
const POINTS: usize = 2000;

/// An offset with the sign of the speed, the last one at standstill; wild: it takes some way to turn over.
pub(crate) fn hysteresis(draw: &mut Draw) -> Box<dyn Effect> {
    let (shares, wild) = (super::statics::shares(draw), draw.wild);
    let seconds = draw.world.seconds();
    // A magnet or a spring at rest stays on the side that it came to.
    let mut side = 1.0;
    let last: Vec<f64> = (0..=POINTS)
        .map(|k| {
            let t = seconds * k as f64 / POINTS as f64;
            let speed = draw.world.motion.at(t).speed;
            if speed != 0.0 {
                side = speed.signum();
            }
            side
        })
        .collect();
    let speeds = (0..200).map(|k| draw.world.motion.at(seconds * f64::from(k) / 200.0).speed);
    let [least, most] = speeds.fold([0.0f64; 2], |[least, most], v| [v.min(least), v.max(most)]);
    let peak = most.max(-least);
    // In one direction it never turns over, however slow it goes.
    let turns = least < 0.0 && most > 0.0;
    Law::new("hysteresis", 0.2, move |m, at, u| {
        let side = if wild && turns {
            (at.speed / (0.05 * peak)).tanh()
        } else if at.speed == 0.0 {
            let point = (at.t / seconds * POINTS as f64).clamp(0.0, POINTS as f64);
            last[point as usize]
        } else {
            at.speed.signum()
        };
        [0, 1].map(|c| u[c] + m * shares[c] * side)
    })
    .with(!wild, move |m| {
        vec![
            ("offset_cos", m * shares[0], false),
            ("offset_sin", m * shares[1], false),
        ]
    })
    .boxed()
}
