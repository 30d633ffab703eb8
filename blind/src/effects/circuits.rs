//! Filters and times: what needs speed to be seen.

use rand::Rng;

use super::Draw;
use crate::effect::{At, Circuit, Echo, Effect, Twins};
use crate::world::World;

/// First-order low pass, exact for inputs that are parabolas between the steps.
#[derive(Clone, Debug)]
pub(crate) struct LowPass {
    tau: f64,
    inputs: [f64; 2],
    output: Option<f64>,
}

impl LowPass {
    /// Of time constant `tau` seconds; settled on the first input.
    pub(crate) fn new(tau: f64) -> Self {
        Self {
            tau,
            inputs: [0.0; 2],
            output: None,
        }
    }

    /// Output `dt` seconds later, when the input is `x`.
    pub(crate) fn step(&mut self, dt: f64, x: f64) -> f64 {
        let Some(output) = self.output else {
            self.inputs = [x, x];
            self.output = Some(x);
            return x;
        };
        let [older, old] = self.inputs;
        let bend = (x - 2.0 * old + older) / (2.0 * dt * dt);
        let slope = (x - older) / (2.0 * dt);
        let tau = self.tau;
        // y = p0 - p1 τ + 2 p2 τ² + (p1 - 2 p2 τ) u + p2 u² solves τ y' + y = p0 + p1 u + p2 u².
        let begin = old - slope * tau + 2.0 * bend * tau * tau;
        let forced = begin + (slope - 2.0 * bend * tau) * dt + bend * dt * dt;
        let decay = if tau > 0.0 { (-dt / tau).exp() } else { 0.0 };
        let y = forced + (output - begin) * decay;
        self.inputs = [old, x];
        self.output = Some(y);
        y
    }
}

/// Low passes one after the other in each channel.
struct LowPasses([Vec<LowPass>; 2]);

impl Circuit for LowPasses {
    fn step(&mut self, dt: f64, _at: &At, mut pair: [f64; 2]) -> [f64; 2] {
        for (value, chain) in pair.iter_mut().zip(&mut self.0) {
            for filter in chain {
                *value = filter.step(dt, *value);
            }
        }
        pair
    }
}

const MISMATCH: &str = "bandwidth_mismatch";
const COMMON: &str = "common_bandwidth";
const SKEW: &str = "channel_skew";
const LATENCY: &str = "latency";

/// Bandwidth; time constants of the two channels as shares of the magnitude, s.
#[derive(Clone)]
struct Bandwidth {
    name: &'static str,
    shares: [Vec<f64>; 2],
    limit: f64,
}

impl Effect for Bandwidth {
    fn name(&self) -> &'static str {
        self.name
    }
    fn limit(&self) -> f64 {
        self.limit
    }
    fn circuit(&self, m: f64, _world: &World) -> Option<(Box<dyn Circuit>, f64)> {
        if m <= 0.0 {
            return None;
        }
        let chain = |shares: &Vec<f64>| shares.iter().map(|s| LowPass::new(s * m)).collect();
        let chains = [chain(&self.shares[0]), chain(&self.shares[1])];
        Some((Box::new(LowPasses(chains)), 20.0 * m))
    }
    fn delays_both(&self) -> bool {
        self.shares[0] == self.shares[1]
    }
    fn brings(&self) -> &'static [&'static str] {
        let both = self.shares.iter().all(|of| !of.is_empty());
        if both && !self.delays_both() {
            &[COMMON]
        } else {
            &[]
        }
    }
    fn twins(&self, motion_known: bool) -> Option<Twins> {
        // Low passes one after the other delay slow signals by the sum of their time constants.
        let [cos, sin] = [0, 1].map(|c: usize| self.shares[c].iter().sum::<f64>());
        let (name, shares, alike) = match (self.delays_both(), motion_known) {
            (true, true) => (LATENCY, [-1.0, -1.0], cos),
            // A delay of both is motion to who does not know the motion.
            (true, false) => return None,
            (false, true) => (SKEW, [0.0, -1.0], sin - cos),
            (false, false) => (SKEW, [-cos, -sin], 1.0),
        };
        Some(Twins {
            own: Box::new(self.clone()),
            other: Box::new(Late {
                name,
                shares,
                limit: self.limit,
                sign: 1.0,
            }),
            alike,
        })
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        // A common pole shows as the square of its magnitude: value over SNR is no bound then.
        match (&*self.shares[0], &*self.shares[1]) {
            ([_], [_]) if self.shares[0] == self.shares[1] => vec![("tau_s", m, false)],
            ([], [_]) => vec![("tau_sin_s", m, true)],
            ([_], []) => vec![("tau_cos_s", m, true)],
            _ => vec![],
        }
    }
}

/// A pole in one channel; wild: one in each, not the same.
pub(crate) fn mismatch(draw: &mut Draw) -> Box<dyn Effect> {
    let mut shares = if draw.wild {
        [vec![0.4], vec![1.0]]
    } else {
        [vec![], vec![1.0]]
    };
    if draw.random.random() {
        shares.swap(0, 1);
    }
    Box::new(Bandwidth {
        name: MISMATCH,
        shares,
        limit: 4.0 / draw.world.rate,
    })
}

/// The same pole in both channels; wild: two poles.
pub(crate) fn common(draw: &mut Draw) -> Box<dyn Effect> {
    let poles = if draw.wild { vec![0.8, 0.6] } else { vec![1.0] };
    Box::new(Bandwidth {
        name: COMMON,
        shares: [poles.clone(), poles],
        limit: 8.0 / draw.world.rate,
    })
}

/// High pass of the same corner in both channels; the magnitude is the corner, rad/s.
struct AcCoupling;

struct HighPasses([LowPass; 2]);

impl Circuit for HighPasses {
    fn step(&mut self, dt: f64, _at: &At, pair: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|c: usize| pair[c] - self.0[c].step(dt, pair[c]))
    }
}

impl Effect for AcCoupling {
    fn name(&self) -> &'static str {
        "ac_coupling"
    }
    fn limit(&self) -> f64 {
        2e3
    }
    fn circuit(&self, m: f64, world: &World) -> Option<(Box<dyn Circuit>, f64)> {
        let tau = 1.0 / m.max(1e-9);
        // Discharged when the machine is switched on, a quarter of the recording before.
        let discharged = LowPass {
            tau,
            inputs: [0.0; 2],
            output: Some(0.0),
        };
        let both = [discharged.clone(), discharged];
        Some((Box::new(HighPasses(both)), 0.25 * world.seconds()))
    }
}

pub(crate) fn ac_coupling(_draw: &mut Draw) -> Box<dyn Effect> {
    Box::new(AcCoupling)
}

/// Sampling times; shares of the magnitude (s) in the two channels.
#[derive(Clone)]
struct Late {
    name: &'static str,
    shares: [f64; 2],
    limit: f64,
    sign: f64,
}

impl Effect for Late {
    fn name(&self) -> &'static str {
        self.name
    }
    fn limit(&self) -> f64 {
        self.limit
    }
    fn late(&self, m: f64, channel: usize, _k: usize) -> f64 {
        m * self.shares[channel]
    }
    fn twins(&self, motion_known: bool) -> Option<Twins> {
        let [cos, sin] = self.shares;
        let own = if motion_known {
            self.shares
        } else {
            // Who does not know the motion sees only how much later one is than the other.
            let later = cos.max(sin);
            [cos - later, sin - later]
        };
        let pole = |late: bool| if late { vec![1.0] } else { vec![] };
        let (name, shares) = match (cos < sin, sin < cos) {
            (false, false) => (COMMON, [vec![1.0], vec![1.0]]),
            (cos_late, sin_late) => (MISMATCH, [pole(cos_late), pole(sin_late)]),
        };
        Some(Twins {
            own: Box::new(Self {
                shares: own,
                ..self.clone()
            }),
            other: Box::new(Bandwidth {
                name,
                shares,
                limit: self.limit,
            }),
            alike: 1.0,
        })
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        vec![("delay_s", self.sign * m, true)]
    }
}

/// sin sampled later than cos, or earlier.
pub(crate) fn skew(draw: &mut Draw) -> Box<dyn Effect> {
    let sign = if draw.random.random() { 1.0 } else { -1.0 };
    Box::new(Late {
        name: SKEW,
        shares: [0.0, sign],
        limit: 2.0 / draw.world.rate,
        sign,
    })
}

/// What both channels show is that old.
pub(crate) fn latency(draw: &mut Draw) -> Box<dyn Effect> {
    Box::new(Late {
        name: LATENCY,
        shares: [-1.0, -1.0],
        limit: 4.0 / draw.world.rate,
        sign: 1.0,
    })
}

/// A fraction of the other channel, delayed.
struct Crosstalk {
    delay: f64,
    shares: [f64; 2],
}

impl Effect for Crosstalk {
    fn name(&self) -> &'static str {
        "delayed_crosstalk"
    }
    fn limit(&self) -> f64 {
        0.2
    }
    fn echo(&self, m: f64) -> Option<Echo> {
        Some(Echo {
            delay: self.delay,
            share: self.shares.map(|s| s * m),
        })
    }
}

pub(crate) fn crosstalk(draw: &mut Draw) -> Box<dyn Effect> {
    let shares = super::statics::shares(draw);
    Box::new(Crosstalk {
        delay: draw.random.random_range(0.5..6.0) / draw.world.rate,
        shares,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn the_low_pass_is_the_first_order_one() {
        let (rate, tau) = (4e5, 3e-6);
        let w = TAU * 1500.0;
        let mut filter = LowPass::new(tau);
        let mut worst = 0.0f64;
        for k in 0..4000 {
            let t = f64::from(k) / rate;
            let y = filter.step(1.0 / rate, (w * t).cos());
            let gain = 1.0 / (1.0 + (w * tau).powi(2)).sqrt();
            if k > 100 {
                worst = worst.max((y - gain * (w * t - (w * tau).atan()).cos()).abs());
            }
        }
        // A thousandth of the filter's own effect, which is 0.028.
        assert!(worst < 2e-5, "{worst}");
    }
}
