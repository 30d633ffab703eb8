//! Real motion that no sensor makes.

use std::f64::consts::TAU;

use rand::Rng;

use super::Draw;
use crate::effect::Effect;
use crate::world::World;

/// At a fixed frequency, rad/s; wild: it swells and fades.
struct Vibration {
    rate: f64,
    phase: f64,
    swell: Option<f64>,
}

impl Effect for Vibration {
    fn name(&self) -> &'static str {
        "vibration"
    }
    fn limit(&self) -> f64 {
        0.2
    }
    fn motion(&self, m: f64, t: f64, _phi: f64) -> f64 {
        let size = self.swell.map_or(1.0, |rate| 1.0 + 0.4 * (rate * t).sin());
        m * size * (self.rate * t + self.phase).sin()
    }
    fn is_motion(&self) -> bool {
        true
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        if self.swell.is_some() {
            return vec![];
        }
        vec![
            ("frequency_hz", self.rate / TAU, false),
            ("amplitude", m, true),
        ]
    }
}

pub(crate) fn vibration(draw: &mut Draw) -> Box<dyn Effect> {
    let share = 10f64.powf(draw.random.random_range(-2.3..-0.8));
    let swell = TAU * draw.random.random_range(0.7..2.0) / draw.world.seconds();
    Box::new(Vibration {
        rate: TAU * share * draw.world.rate,
        phase: draw.random.random_range(0.0..TAU),
        swell: draw.wild.then_some(swell),
    })
}

/// Locked to the revolution; wild: not a sine.
struct Cogging {
    order: f64,
    phase: f64,
    wild: bool,
}

impl Effect for Cogging {
    fn name(&self) -> &'static str {
        "cogging"
    }
    fn limit(&self) -> f64 {
        0.2
    }
    fn motion(&self, m: f64, _t: f64, phi: f64) -> f64 {
        let turn = self.order * phi + self.phase;
        let mut wave = turn.sin();
        if self.wild {
            wave += 0.3 * (2.0 * turn + 0.5).sin();
        }
        m * wave
    }
    fn is_motion(&self) -> bool {
        true
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        if self.wild {
            return vec![];
        }
        vec![("order", self.order, false), ("amplitude", m, true)]
    }
}

/// At a multiple of the poles that is no multiple of the periods: such would be the sensor's own error.
pub(crate) fn cogging(draw: &mut Draw) -> Box<dyn Effect> {
    let periods = draw.world.periods_per_revolution;
    let mut order = 0;
    while 2 * order % periods == 0 {
        order = draw.random.random_range(periods / 2 + 1..=7 * periods);
    }
    Box::new(Cogging {
        order: f64::from(order),
        phase: draw.random.random_range(0.0..TAU),
        wild: draw.wild,
    })
}
