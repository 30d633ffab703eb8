//! What is noise: SNR²/2 is the log-likelihood that knowing its law would gain.

use rand_distr::{Distribution, StandardNormal};

use rand::Rng;

use super::Draw;
use crate::effect::Effect;
use crate::simulate::SPARE;
use crate::spectrum;
use crate::world::World;

/// Normal numbers, one for each sample.
pub(crate) fn normals(draw: &mut Draw) -> Vec<f64> {
    let count = draw.world.samples + SPARE;
    (0..count)
        .map(|_| StandardNormal.sample(draw.random))
        .collect()
}

/// SNR of variances against their mean: √(Σ (ln mean − ln each)).
fn unequal(variances: &[f64]) -> f64 {
    let count = variances.len() as f64;
    let mean = variances.iter().sum::<f64>() / count;
    let gain: f64 = variances.iter().map(|v| (mean / v).ln()).sum();
    gain.max(0.0).sqrt()
}

/// Random error of the common sampling clock, s rms.
struct Jitter {
    normals: Vec<f64>,
    limit: f64,
}

impl Effect for Jitter {
    fn name(&self) -> &'static str {
        "clock_jitter"
    }
    fn limit(&self) -> f64 {
        self.limit
    }
    fn late(&self, m: f64, _channel: usize, k: usize) -> f64 {
        m * self.normals[k]
    }
    fn noise_snr(&self, m: f64, world: &World) -> Option<f64> {
        let white = (world.sigma() / world.mean_amplitude()).powi(2);
        // At one speed it is noise along the motion like any other: only what changes with the speed tells.
        let along = (0..world.samples).map(|k| {
            let speed = world.motion.at(k as f64 / world.rate).speed;
            white + (m * speed).powi(2)
        });
        Some(unequal(&along.collect::<Vec<f64>>()))
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        vec![("rms_s", m, false)]
    }
}

pub(crate) fn jitter(draw: &mut Draw) -> Box<dyn Effect> {
    let limit = 0.3 / draw.world.rate;
    Box::new(Jitter {
        normals: normals(draw),
        limit,
    })
}

/// Noise proportional to the channel, of its amplitude, rms; wild: to its magnitude's root, as of shot noise.
struct AmplitudeNoise {
    normals: [Vec<f64>; 2],
    wild: bool,
}

impl AmplitudeNoise {
    fn size(&self, u: f64) -> f64 {
        if self.wild { u.abs().powf(0.7) } else { u }
    }
}

impl Effect for AmplitudeNoise {
    fn name(&self) -> &'static str {
        "amplitude_noise"
    }
    fn limit(&self) -> f64 {
        0.05
    }
    fn noise(&self, m: f64, channel: usize, k: usize, u: f64) -> f64 {
        m * self.size(u) * self.normals[channel][k]
    }
    fn noise_snr(&self, m: f64, world: &World) -> Option<f64> {
        let white = (world.sigma() / world.mean_amplitude()).powi(2);
        let mut variances = vec![];
        for k in 0..world.samples {
            for u in world.pair(world.axis(k as f64 / world.rate).alpha) {
                variances.push(white + (m * self.size(u)).powi(2));
            }
        }
        Some(unequal(&variances))
    }
    fn parameters(&self, m: f64, _world: &World) -> Vec<(&'static str, f64, bool)> {
        if self.wild {
            vec![]
        } else {
            vec![("rms", m, false)]
        }
    }
}

pub(crate) fn amplitude(draw: &mut Draw) -> Box<dyn Effect> {
    let wild = draw.wild;
    let normals = [normals(draw), normals(draw)];
    Box::new(AmplitudeNoise { normals, wild })
}

/// 1/f noise in each channel: the magnitude is its density at one cycle in the recording, as an rms of that line.
struct Flicker {
    waves: [Vec<f64>; 2],
    exponent: f64,
}

impl Effect for Flicker {
    fn name(&self) -> &'static str {
        "flicker_noise"
    }
    fn limit(&self) -> f64 {
        0.1
    }
    fn noise(&self, m: f64, channel: usize, k: usize, _u: f64) -> f64 {
        m * self.waves[channel][k]
    }
    fn noise_snr(&self, m: f64, world: &World) -> Option<f64> {
        // Per line of the spectrum: white noise spreads evenly over half as many lines as samples.
        let lines = world.samples / 2;
        let white = (world.sigma() / world.mean_amplitude()).powi(2) / lines as f64;
        let each: Vec<f64> = (1..lines)
            .map(|j| white + m * m * (j as f64).powf(-self.exponent))
            .collect();
        // Two numbers a line, two channels.
        let four: Vec<f64> = (0..4).flat_map(|_| each.clone()).collect();
        Some(unequal(&four))
    }
}

/// Exponent 1; wild: 0.8 to 1.2.
pub(crate) fn flicker(draw: &mut Draw) -> Box<dyn Effect> {
    let exponent = if draw.wild {
        draw.random.random_range(0.8..1.2)
    } else {
        1.0
    };
    let count = draw.world.samples + SPARE;
    let waves = [(); 2].map(|()| {
        spectrum::wave(draw.random, count, count / 2, |j| {
            (j as f64).powf(-exponent)
        })
    });
    Box::new(Flicker { waves, exponent })
}
