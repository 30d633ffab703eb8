//! What flicker noise makes shapes explain: it is slow, and so is what goes with the speed or the revolution. Records of such
//! noise are drawn and seen as the recording is, so what a shape explains of them is what it explains of noise.

use std::f64::consts::FRAC_1_SQRT_2;
use std::rc::Rc;

use nonius_fourier::Complex;
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::beside::Beside;
use crate::block::Block;
use crate::library::Shape;
use crate::model::{System, atoms_of};
use crate::statistics::{after_trials, log_tail};

/// Records that are drawn.
const RECORDS: u64 = 16;
/// Values of a record in a period of the corner frequency: faster parts are lost in the white noise.
const PER_PERIOD: f64 = 16.0;
/// Standard deviations of what shapes explain of them that do not count against a name.
const FAR: f64 = 2.0;

/// Records of the noise, as functions of the library.
pub(crate) struct Records(Vec<Shape>);

impl Records {
    /// Of the flicker noise of a recording, if there is any.
    pub(crate) fn draw(system: &mut System) -> Option<Self> {
        let flicker = system.flicker.clone()?;
        let context = system.context;
        let noise = [flicker.density[0], flicker.corner];
        let library = &mut system.samples.library;
        let shapes = (0..RECORDS).map(|seed| {
            let record = Rc::new(Record::draw(context.samples(), context.rate, noise, seed));
            library.pair(move |block: &Block, c, s| {
                for (k, (c, s)) in c.iter_mut().zip(s).enumerate() {
                    [*c, *s] = record.at(block.start + k);
                }
            })
        });
        Some(Self(shapes.collect()))
    }

    /// Log-likelihood that shapes explain of each record beside known ones.
    fn explained(&self, system: &mut System, known: &[Shape], shapes: &[Shape]) -> Vec<f64> {
        let atoms = atoms_of(&[known, shapes, &self.0].concat());
        let whole = system.among(&atoms);
        let among =
            |list: &[Shape]| -> Vec<Shape> { list.iter().map(|s| s.among(&atoms)).collect() };
        let beside = Beside::new(&whole, &among(known));
        let shapes = among(shapes);
        let records = among(&self.0);
        records
            .iter()
            .map(|record| beside.gain_of(record, &shapes))
            .collect()
    }

    /// What shapes explain of such noise does not count against a name: log-likelihood.
    pub(crate) fn allowed(&self, system: &mut System, known: &[Shape], shapes: &[Shape]) -> f64 {
        let all = self.explained(system, known, shapes);
        let n = all.len() as f64;
        let mean = all.iter().sum::<f64>() / n;
        let square = all.iter().map(|g| (g - mean).powi(2)).sum::<f64>() / (n - 1.0);
        mean + FAR * square.sqrt()
    }

    /// So many times the variance of white noise alone, the amounts of shapes have in it.
    pub(crate) fn inflation(&self, system: &mut System, known: &[Shape], shapes: &[Shape]) -> f64 {
        let all = self.explained(system, known, shapes);
        let numbers = (all.len() * shapes.len().max(1)) as f64;
        1.0 + 2.0 * all.iter().sum::<f64>() / numbers
    }
}

/// Log of the probability that so many numbers explain so much by chance where noise inflates it, after so many trials.
pub(crate) fn by_chance(gain: f64, inflation: f64, freedom: usize, trials: f64) -> f64 {
    after_trials(log_tail(2.0 * gain / inflation, freedom), trials)
}

/// Noise of cosine and sine, in amplitudes, at every so many samples.
#[derive(Debug)]
struct Record {
    pairs: Vec<[f32; 2]>,
    step: usize,
}

impl Record {
    /// Of a density in amplitudes per √Hz at 1 Hz, which white noise exceeds above a corner frequency.
    fn draw(samples: usize, rate: f64, [density, corner]: [f64; 2], seed: u64) -> Self {
        let step = (rate / (PER_PERIOD * corner)).max(1.0) as usize;
        let count = samples / step + 2;
        // Slower parts than the recording is long are in it.
        let length = 4 * count;
        let mut random = StdRng::seed_from_u64(seed);
        let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
        // Of either side of the spectrum of the pair, the power of one channel over one side.
        let per = rate / (length * step) as f64;
        let mut pairs: Vec<Complex<f64>> = (0..length)
            .map(|k| {
                if k == 0 {
                    return Complex::default();
                }
                let hertz = k.min(length - k) as f64 * per;
                let rms = density * (per / hertz).sqrt() * FRAC_1_SQRT_2;
                Complex::new(rms * normal(), rms * normal())
            })
            .collect();
        nonius_fourier::inverse(&mut pairs);
        let few = pairs[..count].iter();
        Self {
            pairs: few.map(|p| [p.re as f32, p.im as f32]).collect(),
            step,
        }
    }

    /// The pair at a sample, on the line between two.
    fn at(&self, k: usize) -> [f64; 2] {
        let (first, part) = (k / self.step, (k % self.step) as f64 / self.step as f64);
        let [from, to] = [self.pairs[first], self.pairs[first + 1]];
        [0, 1].map(|i| f64::from(from[i]) * (1.0 - part) + f64::from(to[i]) * part)
    }
}

#[cfg(test)]
mod tests {
    use super::{Record, by_chance};

    /// The mean square between two frequencies is that of the density there: differences of averages over 1024 and 4096 samples see
    /// the octaves between.
    #[test]
    fn records_have_the_spectrum_of_the_noise() {
        let (samples, rate) = (1 << 16, 1000.0);
        let noise = [0.01, 100.0];
        // Haar's wavelet of width w sees the same of 1/f at every width: ln 2 of the density squared in each half.
        let of_width = |w: usize| {
            let squares = (0..40).flat_map(|seed| {
                let record = Record::draw(samples, rate, noise, seed);
                let half = move |from: usize, i: usize| {
                    (from..from + w).map(|k| record.at(k)[i]).sum::<f64>() / w as f64
                };
                (0..samples - 2 * w)
                    .step_by(2 * w)
                    .flat_map(move |k| [0, 1].map(|i| (half(k, i) - half(k + w, i)).powi(2)))
                    .collect::<Vec<_>>()
            });
            let squares: Vec<f64> = squares.collect();
            squares.iter().sum::<f64>() / squares.len() as f64
        };
        for w in [64, 512, 4096] {
            let (seen, asked) = (of_width(w), 4.0 * 2f64.ln() * 0.01 * 0.01);
            assert!((seen / asked - 1.0).abs() < 0.1, "{w}: {seen} of {asked}");
        }
    }

    #[test]
    fn inflated_noise_explains_more_by_chance() {
        let white = by_chance(20.0, 1.0, 2, 1.0);
        assert!((white + 20.0).abs() < 1e-9, "{white}");
        assert!((by_chance(20.0, 4.0, 2, 1.0) + 5.0).abs() < 1e-9);
    }
}
