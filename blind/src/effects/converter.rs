//! What the ADC gets wrong.

use rand::Rng;

use super::Draw;
use crate::effect::Effect;

/// Error by the code.
struct Nonlinearity {
    /// Bit (from the top, 0 is the sign) and weight error in units of the magnitude, for each channel.
    weights: [Vec<(u32, f64)>; 2],
    /// A bow over the range.
    bow: f64,
    bits: u32,
}

impl Effect for Nonlinearity {
    fn name(&self) -> &'static str {
        "adc_nonlinearity"
    }
    fn limit(&self) -> f64 {
        // LSB.
        400.0
    }
    fn transfer(&self, m: f64, channel: usize, _k: usize, x: f64, _before: [f64; 2]) -> f64 {
        let code = x.round() as i64 + (1i64 << (self.bits - 1));
        let steps: f64 = self.weights[channel]
            .iter()
            .map(|(bit, weight)| {
                let set = code >> (self.bits - 1 - bit) & 1 == 1;
                if set { weight / 2.0 } else { -weight / 2.0 }
            })
            .sum();
        let range = x / 2f64.powi(self.bits as i32 - 1);
        m * (steps + self.bow * range * (1.0 - range * range))
    }
}

/// One bit's weight; wild: several bits' and a bow.
pub(crate) fn nonlinearity(draw: &mut Draw) -> Box<dyn Effect> {
    let random = &mut draw.random;
    let count = if draw.wild { 3 } else { 1 };
    let both = random.random_bool(0.5);
    let one = random.random_range(0..2);
    let weights = [0, 1].map(|channel| {
        if !both && channel != one {
            return vec![];
        }
        let bits = (0..count).map(|_| {
            let sign = if random.random() { 1.0 } else { -1.0 };
            (
                random.random_range(0..6),
                sign * random.random_range(0.5..1.0),
            )
        });
        bits.collect()
    });
    Box::new(Nonlinearity {
        weights,
        bow: if draw.wild { 0.5 } else { 0.0 },
        bits: draw.world.bits,
    })
}

/// A bit that never changes; the magnitude is its number plus one.
struct StuckBit {
    channel: usize,
    value: bool,
    bits: u32,
}

impl Effect for StuckBit {
    fn name(&self) -> &'static str {
        "stuck_bit"
    }
    fn limit(&self) -> f64 {
        f64::from(self.bits) - 4.0
    }
    fn choices(&self) -> Option<Vec<f64>> {
        Some((1..=self.bits - 5).map(f64::from).collect())
    }
    fn works_on_codes(&self) -> bool {
        true
    }
    fn code(&self, m: f64, channel: usize, code: i64) -> i64 {
        if channel != self.channel || m < 1.0 {
            return code;
        }
        let half = 1i64 << (self.bits - 1);
        let bit = 1i64 << (m as i64 - 1);
        let natural = code + half;
        let stuck = if self.value {
            natural | bit
        } else {
            natural & !bit
        };
        stuck - half
    }
}

pub(crate) fn stuck_bit(draw: &mut Draw) -> Box<dyn Effect> {
    Box::new(StuckBit {
        channel: draw.random.random_range(0..2),
        value: draw.random.random(),
        bits: draw.world.bits,
    })
}

/// Steps of several LSB; the magnitude is the step.
struct Coarse {
    channels: [bool; 2],
    steps: Vec<f64>,
}

impl Effect for Coarse {
    fn name(&self) -> &'static str {
        "coarse_quantisation"
    }
    fn limit(&self) -> f64 {
        64.0
    }
    fn choices(&self) -> Option<Vec<f64>> {
        Some(self.steps.clone())
    }
    fn works_on_codes(&self) -> bool {
        true
    }
    fn code(&self, m: f64, channel: usize, code: i64) -> i64 {
        let step = m as i64;
        if self.channels[channel] && step > 1 {
            code.div_euclid(step) * step
        } else {
            code
        }
    }
}

/// Steps of a power of two; wild: of any number, as after a digital gain.
pub(crate) fn coarse(draw: &mut Draw) -> Box<dyn Effect> {
    let both = draw.random.random_bool(0.5);
    let one = draw.random.random_range(0..2);
    Box::new(Coarse {
        channels: [0, 1].map(|c| both || c == one),
        steps: if draw.wild {
            vec![3.0, 5.0, 7.0, 11.0, 13.0, 20.0]
        } else {
            vec![4.0, 8.0, 16.0, 32.0]
        },
    })
}
