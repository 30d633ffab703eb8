//! The experiment that a cause is hidden in: axis, sensor, converter, reference instrument.

use std::f64::consts::TAU;

use rand::Rng;

use crate::motion::{Drive, Motion, State};
use crate::vibration::Vibration;

/// What an experiment must have.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    /// Samples of the recording.
    pub samples: usize,
    /// How the axis is driven.
    pub drive: Drive,
    /// A reference column.
    pub reference: bool,
    /// The recording says how many periods a revolution has.
    pub revolution: bool,
    /// Real broadband vibration of the axis.
    pub vibration: bool,
    /// A temperature column.
    pub temperature: bool,
}

/// The better instrument beside the sensor.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// +1, or −1 where it counts the other way.
    pub sign: f64,
    /// Where its zero is, radians.
    pub offset: f64,
    /// It shows 0 … 2π only.
    pub wrapped: bool,
    /// Its noise, radians rms.
    pub noise: f64,
}

/// Warming up.
#[derive(Clone, Copy, Debug)]
pub struct Warming {
    /// Rise in the end, K.
    pub rise: f64,
    /// Time constant, s.
    pub tau: f64,
}

impl Warming {
    /// °C at a time.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        24.0 + self.rise * (1.0 - (-t / self.tau).exp())
    }
}

/// An experiment.
#[derive(Clone, Debug)]
pub struct World {
    /// Samples of the recording.
    pub samples: usize,
    /// Per second.
    pub rate: f64,
    /// Amplitudes of cos and sin channel, V.
    pub amplitude: [f64; 2],
    /// Offsets, V.
    pub offset: [f64; 2],
    /// β of equation (4), radians.
    pub beta: f64,
    /// Of the ADC, which spans −1 … +1 V.
    pub bits: u32,
    /// White noise of each channel before the ADC, V rms.
    pub noise: f64,
    /// Scale periods of a revolution.
    pub periods_per_revolution: u32,
    /// Whether the recording says so.
    pub revolution_known: bool,
    /// What the drive does.
    pub motion: Motion,
    /// What the machine adds.
    pub vibration: Option<Vibration>,
    /// The better instrument.
    pub reference: Option<Reference>,
    /// A temperature column.
    pub temperature: Option<Warming>,
}

impl World {
    /// Draws an experiment.
    pub fn draw(random: &mut impl Rng, wish: &Wish) -> Self {
        // A hand takes seconds for what a drive does in parts of one.
        let rates = match wish.drive {
            Drive::Hand => [2e3, 5e3, 1e4],
            _ => [2e4, 5e4, 1e5],
        };
        let rate = rates[random.random_range(0..3)];
        let seconds = wish.samples as f64 / rate;
        let fastest = TAU * rate * random.random_range(0.006..0.03);
        let motion = Motion::draw(random, wish.drive, seconds, fastest);
        let bits = if random.random_bool(0.7) { 14 } else { 16 };
        // 0.03 to 0.3 % of the amplitude.
        let noise_share = 10f64.powf(random.random_range(-3.523..-2.523));
        let amplitude = [(); 2].map(|()| random.random_range(0.65..0.9));
        let mean = (amplitude[0] + amplitude[1]) / 2.0;
        let vibration = wish.vibration.then(|| {
            let rms = noise_share * 10f64.powf(random.random_range(-0.5..1.0));
            Vibration::draw(random, rms, wish.samples, rate)
        });
        let far = way(&motion, seconds) / TAU;
        // So that two revolutions and more are seen.
        let most = ((far / 2.2) as u32).clamp(5, 40);
        let periods_per_revolution = random.random_range(5..=most);
        Self {
            samples: wish.samples,
            rate,
            amplitude,
            offset: [(); 2].map(|()| random.random_range(-0.05..0.05)),
            beta: random.random_range(-0.07..0.07),
            bits,
            noise: noise_share * mean,
            periods_per_revolution,
            revolution_known: wish.revolution,
            motion,
            vibration,
            reference: wish.reference.then(|| Reference {
                sign: if random.random() { 1.0 } else { -1.0 },
                offset: random.random_range(-3.0..3.0),
                wrapped: random.random(),
                noise: 0.1 * noise_share,
            }),
            temperature: wish.temperature.then(|| Warming {
                rise: random.random_range(2.0..15.0),
                tau: seconds * random.random_range(0.2..3.0),
            }),
        }
    }

    /// Seconds of the recording.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.samples as f64 / self.rate
    }

    /// Mean of the two amplitudes, V.
    #[must_use]
    pub fn mean_amplitude(&self) -> f64 {
        (self.amplitude[0] + self.amplitude[1]) / 2.0
    }

    /// One step of the ADC, V.
    #[must_use]
    pub fn lsb(&self) -> f64 {
        2.0 / 2f64.powi(self.bits as i32)
    }

    /// Noise that a recording has at the least, quantisation included, V rms.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.noise.hypot(self.lsb() / 12f64.sqrt())
    }

    /// The drive and the machine, no cause: state with the vibration in its angle.
    #[must_use]
    pub fn axis(&self, t: f64) -> State {
        let mut state = self.motion.at(t);
        if let Some(vibration) = &self.vibration {
            state.alpha += vibration.at(t);
        }
        state
    }

    /// Channels without any cause, in amplitudes.
    #[must_use]
    pub fn pair(&self, alpha: f64) -> [f64; 2] {
        [alpha.cos(), (alpha - self.beta).sin()]
    }

    /// Volts without the offsets as multiples of cos and sin of an angle.
    #[must_use]
    pub fn upright(&self, volts: [f64; 2]) -> [f64; 2] {
        let [c, s] = [0, 1].map(|c: usize| volts[c] / self.amplitude[c]);
        [c, (s + c * self.beta.sin()) / self.beta.cos()]
    }

    /// The angle at which the channels without any cause have these volts, up to their common size, radians.
    #[must_use]
    pub fn angle(&self, volts: [f64; 2]) -> f64 {
        let [c, s] = self.upright([0, 1].map(|c: usize| volts[c] - self.offset[c]));
        s.atan2(c)
    }

    /// Amplitudes to volts.
    #[must_use]
    pub fn volts(&self, channel: usize, u: f64) -> f64 {
        self.amplitude[channel] * u + self.offset[channel]
    }
}

/// Largest less smallest angle, radians: revolutions seen, not way travelled.
fn way(motion: &Motion, seconds: f64) -> f64 {
    let at = |k: u32| motion.at(seconds * f64::from(k) / 500.0).alpha;
    let (low, high) = (0..=500).fold((f64::MAX, f64::MIN), |(low, high), k| {
        (low.min(at(k)), high.max(at(k)))
    });
    high - low
}

/// For tests: an axis that goes to and fro, always the same.
#[cfg(test)]
pub(crate) fn to_and_fro(reference: bool, vibration: bool) -> World {
    use rand::SeedableRng;
    let wish = Wish {
        samples: 4000,
        drive: Drive::Reversing,
        reference,
        revolution: false,
        vibration,
        temperature: false,
    };
    World::draw(&mut rand::rngs::StdRng::seed_from_u64(3), &wish)
}
