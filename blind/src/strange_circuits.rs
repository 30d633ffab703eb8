//! Strangers with a memory, and those of converter and clock.

use rand::Rng;

use crate::effect::{Circuit, Effect};
use crate::effects::Draw;
use crate::simulate::SPARE;
use crate::strangers::{Both, One, peaks};
use crate::world::World;

/// An amplifier that cannot follow: the magnitude is the part of the steepest slope that it does not reach.
struct Slew {
    steepest: f64,
}

struct Follower {
    limit: f64,
    output: Option<f64>,
}

impl One for Follower {
    fn step(&mut self, dt: f64, x: f64) -> f64 {
        let y = self.output.unwrap_or(x);
        let y = y + (x - y).clamp(-self.limit * dt, self.limit * dt);
        self.output = Some(y);
        y
    }
}

impl Effect for Slew {
    fn name(&self) -> &'static str {
        "slew_limit"
    }
    fn limit(&self) -> f64 {
        0.6
    }
    fn circuit(&self, m: f64, world: &World) -> Option<(Box<dyn Circuit>, f64)> {
        let follower = || Follower {
            limit: (1.0 - m) * self.steepest,
            output: None,
        };
        let memory = 100.0 / world.rate;
        (m > 0.0).then(|| -> (Box<dyn Circuit>, f64) {
            (Box::new(Both([follower(), follower()])), memory)
        })
    }
}

pub(crate) fn slew(draw: &mut Draw) -> Box<dyn Effect> {
    let (steepest, _) = peaks(draw);
    Box::new(Slew { steepest })
}

/// A capacitor that remembers: a slow share of the signal comes back, over two time constants.
struct Dielectric {
    taus: [f64; 2],
}

struct Soaked {
    share: f64,
    taus: [f64; 2],
    soaked: [f64; 2],
}

impl One for Soaked {
    fn step(&mut self, dt: f64, x: f64) -> f64 {
        for (soaked, tau) in self.soaked.iter_mut().zip(self.taus) {
            *soaked += (x - *soaked) * (1.0 - (-dt / tau).exp());
        }
        x + self.share * (self.soaked[0] - 0.6 * self.soaked[1])
    }
}

impl Effect for Dielectric {
    fn name(&self) -> &'static str {
        "dielectric_absorption"
    }
    fn limit(&self) -> f64 {
        0.5
    }
    fn circuit(&self, m: f64, world: &World) -> Option<(Box<dyn Circuit>, f64)> {
        let soaked = || Soaked {
            share: m,
            taus: self.taus,
            soaked: [0.0; 2],
        };
        Some((Box::new(Both([soaked(), soaked()])), 0.2 * world.seconds()))
    }
}

pub(crate) fn dielectric(draw: &mut Draw) -> Box<dyn Effect> {
    let rate = draw.world.rate;
    Box::new(Dielectric {
        taus: [
            draw.random.random_range(10.0..40.0) / rate,
            draw.random.random_range(60.0..300.0) / rate,
        ],
    })
}

/// Codes with many ones draw on the reference and disturb the next conversion.
struct Kickback;

impl Effect for Kickback {
    fn name(&self) -> &'static str {
        "reference_kickback"
    }
    fn limit(&self) -> f64 {
        100.0
    }
    fn transfer(&self, m: f64, channel: usize, _k: usize, x: f64, before: [f64; 2]) -> f64 {
        // Bits that the other channel's conversion changed.
        let other = 1 - channel;
        let changed = (before[other].round() as i64) ^ (x.round() as i64);
        m * (f64::from((changed & 0xfff).count_ones()) - 6.0)
    }
}

pub(crate) fn kickback(_draw: &mut Draw) -> Box<dyn Effect> {
    Box::new(Kickback)
}

/// A multiplexer that, every fourth time, has not settled from the channel before.
struct Memory {
    phase: usize,
}

impl Effect for Memory {
    fn name(&self) -> &'static str {
        "multiplexer_memory"
    }
    fn limit(&self) -> f64 {
        0.2
    }
    fn transfer(&self, m: f64, channel: usize, k: usize, x: f64, before: [f64; 2]) -> f64 {
        let late = channel == 1 && k % 4 == self.phase;
        if late { m * (before[0] - x) } else { 0.0 }
    }
}

pub(crate) fn memory(draw: &mut Draw) -> Box<dyn Effect> {
    Box::new(Memory {
        phase: draw.random.random_range(0..4),
    })
}

/// A clock whose frequency is swept to and fro to please the radio test: sampling times on a triangle.
struct SpreadClock {
    period: usize,
    limit: f64,
}

impl Effect for SpreadClock {
    fn name(&self) -> &'static str {
        "spread_clock"
    }
    fn limit(&self) -> f64 {
        self.limit
    }
    fn late(&self, m: f64, _channel: usize, k: usize) -> f64 {
        let x = ((k + SPARE) % self.period) as f64 / self.period as f64;
        m * ((2.0 * x - 1.0).abs() - 0.5)
    }
}

pub(crate) fn spread_clock(draw: &mut Draw) -> Box<dyn Effect> {
    Box::new(SpreadClock {
        period: draw.random.random_range(20..120),
        limit: 2.0 / draw.world.rate,
    })
}
