//! What flicker noise makes shapes explain: it is slow, and so is what goes with the speed or the revolution. Records of such
//! noise are drawn and seen as the recording is, so what a shape explains of them is what it explains of noise.

use std::f64::consts::FRAC_1_SQRT_2;
use std::rc::Rc;

use nonius_fourier::Complex;
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::model::{System, atoms_of};
use crate::select::beside::Beside;
use crate::shapes::block::Block;
use crate::shapes::library::Shape;

/// Records that are drawn.
const RECORDS: u64 = 16;
/// Values of a record in a period of the corner frequency: faster parts are lost in the white noise.
const PER_PERIOD: f64 = 16.0;
/// Standard deviations beyond the mean of what shapes explain of them that do not count against a name.
const ALLOWED: f64 = 2.0;

/// Records of the noise, as functions of the library.
pub(crate) struct Records(Vec<Shape>);

impl Records {
    /// Of the flicker noise of a recording, if there is any.
    pub(crate) fn of(system: &mut System) -> Option<Self> {
        let flicker = system.flicker.as_ref()?;
        let noise = [flicker.density[0], flicker.corner];
        let (samples, rate) = (system.context.samples(), system.context.rate);
        let drawn = system.records.get_or_insert_with(|| {
            let draw = |seed| Rc::new(Record::draw(samples, rate, noise, seed));
            (0..RECORDS).map(draw).collect()
        });
        let library = &mut system.samples.library;
        let shapes = drawn.iter().map(|record| {
            let record = Rc::clone(record);
            library.pair(move |block: &Block, c, s| {
                for (k, (c, s)) in c.iter_mut().zip(s).enumerate() {
                    [*c, *s] = record.at(block.start + k);
                }
            })
        });
        Some(Self(shapes.collect()))
    }

    /// Log-likelihood that shapes explain of each record beside known ones, and how many numbers they have for it.
    fn explained(
        &self,
        system: &mut System,
        known: &[Shape],
        shapes: &[Shape],
    ) -> Vec<(f64, usize)> {
        let atoms = atoms_of(&[known, shapes, &self.0].concat());
        let whole = system.among(&atoms);
        let among = |list: &[Shape]| Shape::all_among(list, &atoms);
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
        let mean = all.iter().map(|g| g.0).sum::<f64>() / n;
        let square = all.iter().map(|g| (g.0 - mean).powi(2)).sum::<f64>() / (n - 1.0);
        mean + ALLOWED * square.sqrt()
    }

    /// So many times the variance of white noise alone, the amounts of shapes have in it.
    pub(crate) fn inflation(&self, system: &mut System, known: &[Shape], shapes: &[Shape]) -> f64 {
        let all = self.explained(system, known, shapes);
        let numbers: usize = all.iter().map(|g| g.1).sum();
        let gain: f64 = all.iter().map(|g| g.0).sum();
        1.0 + 2.0 * gain / numbers.max(1) as f64
    }
}

/// Noise of cosine and sine, in amplitudes, at every so many samples.
#[derive(Debug)]
pub(crate) struct Record {
    pairs: Vec<[f32; 2]>,
    step: usize,
}

impl Record {
    /// Of a density in amplitudes per √Hz at 1 Hz, which white noise exceeds above a corner frequency.
    fn draw(samples: usize, rate: f64, [density, corner]: [f64; 2], seed: u64) -> Self {
        let step = (rate / (PER_PERIOD * corner)).max(1.0) as usize;
        let count = samples / step + 2;
        // Slower parts than the recording is long are in it.
        let length = (4 * count).next_power_of_two();
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
    use super::Record;

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
}
