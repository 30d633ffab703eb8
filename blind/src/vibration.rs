//! Broadband vibration of the axis: real motion that no drive commands.
//!
//! White force on a structure of one to three damped modes: displacement is flat below the modes and falls with f⁻⁴
//! above them. A stationary Gaussian process, not a sum of lines.

use rand::Rng;

use crate::spectrum;

/// Points of the table per sample of the recording.
const FINE: usize = 4;

/// One realisation, and the spectrum that it was drawn from.
#[derive(Clone, Debug)]
pub struct Vibration {
    /// Rms, radians.
    pub rms: f64,
    /// Frequency (Hz), quality and share of each mode.
    modes: Vec<(f64, f64, f64)>,
    /// One-sided density over `shape`, rad².
    density: f64,
    table: Vec<f64>,
    begins: f64,
    step: f64,
}

impl Vibration {
    /// Draws one of this rms (radians) for a recording of so many samples at `rate` Hz.
    pub fn draw(random: &mut impl Rng, rms: f64, samples: usize, rate: f64) -> Self {
        let modes = (0..random.random_range(1..=3)).map(|_| {
            let frequency = rate * 10f64.powf(random.random_range(-2.6..-1.0));
            let quality = random.random_range(2.0..12.0);
            (frequency, quality, random.random_range(0.2..1.0))
        });
        let modes: Vec<_> = modes.collect();
        // Longer than the recording, so that its ends do not meet in it.
        let window = samples * 3 / 2;
        let seconds = window as f64 / rate;
        let lines = window / 2;
        let power: f64 = (1..lines).map(|j| shape(&modes, j as f64 / seconds)).sum();
        let scale = rms * rms / power;
        let table = spectrum::wave(random, window * FINE, lines, |j| {
            scale * shape(&modes, j as f64 / seconds)
        });
        Self {
            rms,
            density: scale * seconds,
            modes,
            table,
            begins: -0.25 * samples as f64 / rate,
            step: 1.0 / (rate * FINE as f64),
        }
    }

    /// One-sided power density at a frequency in Hz, rad²/Hz.
    #[must_use]
    pub fn power(&self, frequency: f64) -> f64 {
        self.density * shape(&self.modes, frequency)
    }

    /// Angle at time `t` (s), radians: the cubic through four points of the table.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let place = (t - self.begins) / self.step;
        let (whole, x) = (place.floor(), place - place.floor());
        let point = |offset: i64| {
            let index = (whole as i64 + offset).rem_euclid(self.table.len() as i64);
            self.table[index as usize]
        };
        cubic([point(-1), point(0), point(1), point(2)], x)
    }
}

/// Power of the displacement at a frequency, of unit force.
fn shape(modes: &[(f64, f64, f64)], frequency: f64) -> f64 {
    let response = |(f0, quality, share): &(f64, f64, f64)| {
        let x = frequency / f0;
        share / f0 / ((1.0 - x * x).powi(2) + (x / quality).powi(2))
    };
    modes.iter().map(response).sum()
}

/// The cubic through four values at −1, 0, 1, 2, at `x`.
pub(crate) fn cubic(p: [f64; 4], x: f64) -> f64 {
    let (a, b, c) = (x + 1.0, x - 1.0, x - 2.0);
    -p[0] * x * b * c / 6.0 + p[1] * a * b * c / 2.0 - p[2] * a * x * c / 2.0
        + p[3] * a * x * b / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{SeedableRng, rngs::StdRng};

    #[test]
    fn rms_is_the_one_drawn_and_the_spectrum_integrates_to_it() {
        let mut random = StdRng::seed_from_u64(9);
        let vibration = Vibration::draw(&mut random, 0.002, 20_000, 5e4);
        let power: f64 = (0..20_000)
            .map(|k| vibration.at(f64::from(k) / 5e4).powi(2))
            .sum::<f64>()
            / 2e4;
        assert!((power.sqrt() / 0.002 - 1.0).abs() < 0.3, "{}", power.sqrt());
        let integral: f64 = (1..25_000).map(|f| vibration.power(f64::from(f))).sum();
        assert!((integral.sqrt() / 0.002 - 1.0).abs() < 0.02);
    }

    #[test]
    fn cubics_are_exact() {
        let f = |x: f64| 1.0 - 2.0 * x + 3.0 * x * x - 0.5 * x.powi(3);
        assert!((cubic([f(-1.0), f(0.0), f(1.0), f(2.0)], 0.3) - f(0.3)).abs() < 1e-12);
    }
}
