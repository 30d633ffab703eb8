//! What depends on the channel or on the angle alone.

use std::f64::consts::TAU;

use rand::Rng;

use super::{Draw, Law};
use crate::effect::Effect;

/// Shares of the two channels, so that one or the other or both have it.
pub(crate) fn shares(draw: &mut Draw) -> [f64; 2] {
    let angle = draw.random.random_range(0.0..TAU);
    [angle.cos(), angle.sin()]
}

/// y + k y²; wild: a cosh, as of a diode.
pub(crate) fn even(draw: &mut Draw) -> Box<dyn Effect> {
    let wild = draw.wild;
    bent(draw, "even_nonlinearity", move |u| {
        if wild {
            2.0 * ((1.1 * u).cosh() - 1.0) / 1.21
        } else {
            u * u
        }
    })
}

/// y + k y³; wild: a hyperbolic tangent, as of a bipolar pair.
pub(crate) fn odd(draw: &mut Draw) -> Box<dyn Effect> {
    let wild = draw.wild;
    bent(draw, "odd_nonlinearity", move |u| {
        if wild {
            3.0 * (u - (0.9 * u).tanh() / 0.9)
        } else {
            u.powi(3)
        }
    })
}

/// Each channel bent by its share; only a textbook's bend has the library's parameters.
fn bent(
    draw: &mut Draw,
    name: &'static str,
    bend: impl Fn(f64) -> f64 + Send + Sync + 'static,
) -> Box<dyn Effect> {
    let (shares, wild) = (shares(draw), draw.wild);
    Law::new(name, 0.2, move |m, _, u| {
        [0, 1].map(|c| u[c] + m * shares[c] * bend(u[c]))
    })
    .with(!wild, move |m| {
        vec![
            ("k_cos", m * shares[0], false),
            ("k_sin", m * shares[1], false),
        ]
    })
    .boxed()
}

/// One order of the period; wild: a fifth of the next order with it, as of a pole that is no sine.
pub(crate) fn harmonic(draw: &mut Draw) -> Box<dyn Effect> {
    let (shares, wild) = (shares(draw), draw.wild);
    let order = f64::from(draw.random.random_range(2..=7));
    let phase = [(); 4].map(|()| draw.random.random_range(0.0..TAU));
    Law::new("spatial_harmonic", 0.2, move |m, at, u| {
        [0, 1].map(|c| {
            let mut wave = (order * at.alpha + phase[c]).cos();
            if wild {
                wave += 0.2 * ((order + 1.0) * at.alpha + phase[c + 2]).cos();
            }
            u[c] + m * shares[c] * wave
        })
    })
    .with(!wild, move |m| {
        vec![
            ("order", order, false),
            ("amplitude_cos", m * shares[0].abs(), false),
            ("amplitude_sin", m * shares[1].abs(), false),
        ]
    })
    .boxed()
}

/// Compression beyond a threshold; wild: with a soft knee.
pub(crate) fn saturation(draw: &mut Draw) -> Box<dyn Effect> {
    let wild = draw.wild;
    let threshold = draw.random.random_range(0.7..0.93);
    let rails: [bool; 2] =
        [[true, false], [false, true], [true, true]][draw.random.random_range(0..3)];
    let channels: [bool; 2] =
        [[true, false], [false, true], [true, true]][draw.random.random_range(0..3)];
    let over = move |u: f64| {
        let x = u - threshold;
        if wild {
            // A knee as wide as a twentieth of the amplitude.
            0.05 * (x / 0.05).exp().ln_1p()
        } else {
            x.max(0.0)
        }
    };
    Law::new("saturation", 1.0, move |m, _, u| {
        [0, 1].map(|c| {
            if !channels[c] {
                return u[c];
            }
            let mut y = u[c];
            if rails[0] {
                y -= m * over(u[c]);
            }
            if rails[1] {
                y += m * over(-u[c]);
            }
            y
        })
    })
    .boxed()
}
