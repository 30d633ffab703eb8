//! What repeats with the revolution.

use std::f64::consts::TAU;

use rand::Rng;

use super::{Draw, Law};
use crate::effect::{At, Effect};
use crate::world::World;

/// Amplitude at 1 to 3 per revolution; wild: a disc that is both eccentric and bent.
pub(crate) fn runout(draw: &mut Draw) -> Box<dyn Effect> {
    let wild = draw.wild;
    let order = f64::from(draw.random.random_range(1..=3));
    let phase = [(); 2].map(|()| draw.random.random_range(0.0..TAU));
    Law::new("runout", 0.2, move |m, at, u| {
        let mut wave = (order * at.phi + phase[0]).cos();
        if wild {
            let other = if order == 1.0 { 2.0 } else { 1.0 };
            wave += 0.5 * (other * at.phi + phase[1]).cos();
        }
        u.map(|u| u * (1.0 + m * wave))
    })
    .with(!wild, move |m| {
        vec![("order", order, false), ("depth", m, true)]
    })
    .boxed()
}

/// A Gaussian dip at one place; wild: a scratch with one steep and one flat side.
pub(crate) fn contamination(draw: &mut Draw) -> Box<dyn Effect> {
    let wild = draw.wild;
    let place = draw.random.random_range(0.0..TAU);
    let width = draw.random.random_range(0.04..0.2);
    Law::new("contamination", 0.8, move |m, at, u| {
        let off = (at.phi - place + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
        let dip = if wild {
            let (steep, flat) = (0.3 * width, 2.0 * width);
            let side = if off < 0.0 {
                1.0 + off / steep
            } else {
                1.0 - off / flat
            };
            side.max(0.0)
        } else {
            (-0.5 * (off / width).powi(2)).exp()
        };
        u.map(|u| u * (1.0 - m * dip))
    })
    .boxed()
}

/// The scale's own error, rad of the period; orders of the revolution with amplitude and phase.
struct Graduation(Vec<(f64, f64, f64)>);

impl Effect for Graduation {
    fn name(&self) -> &'static str {
        "graduation_error"
    }
    fn limit(&self) -> f64 {
        0.5
    }
    fn scale(&self, m: f64, at: &At) -> f64 {
        let wave = |(order, size, phase): &(f64, f64, f64)| size * (order * at.phi + phase).cos();
        m * self.0.iter().map(wave).sum::<f64>()
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        match &*self.0 {
            [(order, _, _)] => vec![("order", *order, false), ("amplitude", m, true)],
            _ => vec![],
        }
    }
}

/// One order up to 5; wild: eccentric, oval and a third, falling.
pub(crate) fn graduation(draw: &mut Draw) -> Box<dyn Effect> {
    let mut phase = || draw.random.random_range(0.0..TAU);
    let orders = if draw.wild {
        vec![
            (1.0, 1.0, phase()),
            (2.0, 0.4, phase()),
            (5.0, 0.2, phase()),
        ]
    } else {
        let phase = phase();
        vec![(f64::from(draw.random.random_range(1..=5)), 1.0, phase)]
    };
    Box::new(Graduation(orders))
}
