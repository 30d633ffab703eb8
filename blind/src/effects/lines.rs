//! Lines in the spectrum: hum, switching supplies, lamps.

use std::f64::consts::TAU;

use rand::Rng;

use super::{Draw, Law};
use crate::effect::Effect;

/// A frequency between a few cycles of the recording and a tenth of the rate, Hz; half of them mains.
fn frequency(draw: &mut Draw) -> f64 {
    let slowest = 12.0 / draw.world.seconds();
    let mains = [50.0, 60.0, 100.0, 120.0, 150.0, 180.0, 300.0, 400.0];
    let may: Vec<f64> = mains.into_iter().filter(|f| *f > slowest).collect();
    if !may.is_empty() && draw.random.random_bool(0.5) {
        return may[draw.random.random_range(0..may.len())];
    }
    let fastest: f64 = 0.1 * draw.world.rate;
    slowest * (fastest / slowest).powf(draw.random.random())
}

/// A line added to both channels; wild: the pulses of a rectifier.
pub(crate) fn interference(draw: &mut Draw) -> Box<dyn Effect> {
    let (wild, f) = (draw.wild, frequency(draw));
    let shares = super::statics::shares(draw);
    let phase = [(); 2].map(|()| draw.random.random_range(0.0..TAU));
    Law::new("interference", 0.2, move |m, at, u| {
        [0, 1].map(|c| {
            let turn = TAU * f * at.t + phase[c];
            let wave = if wild {
                turn.cos() + 0.5 * (3.0 * turn + 0.4).cos() + 0.3 * (5.0 * turn + 1.0).cos()
            } else {
                turn.cos()
            };
            u[c] + m * shares[c] * wave
        })
    })
    .with(!wild, move |m| {
        vec![
            ("frequency_hz", f, false),
            ("amplitude_cos", m * shares[0].abs(), false),
            ("amplitude_sin", m * shares[1].abs(), false),
        ]
    })
    .boxed()
}

/// Light that flickers; wild: as a triangle.
pub(crate) fn ripple(draw: &mut Draw) -> Box<dyn Effect> {
    let (wild, f) = (draw.wild, frequency(draw));
    let phase = draw.random.random_range(0.0..TAU);
    Law::new("amplitude_ripple", 0.2, move |m, at, u| {
        let turn = TAU * f * at.t + phase;
        let wave = if wild {
            turn.cos().asin() * 4.0 / TAU
        } else {
            turn.cos()
        };
        u.map(|u| u * (1.0 + m * wave))
    })
    .with(!wild, move |m| {
        vec![("frequency_hz", f, false), ("depth", m, true)]
    })
    .boxed()
}
