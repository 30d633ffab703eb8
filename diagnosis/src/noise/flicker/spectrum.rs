//! The spectrum of both channels as the radius shows it, and what flicker noise is expected to be in it.

use nonius_fourier::Complex;

use crate::context::Context;

/// Share of half the sample rate that is looked at.
const HIGHEST: f64 = 0.98;
/// Bands per octave into which lines are gathered.
const PER_OCTAVE: f64 = 6.0;
/// Above so many times the median near it, a line of the spectrum is hum.
const HUM: f64 = 6.0;
/// Lines of the spectrum on either side that are near.
const NEAR: usize = 8;

/// Lines of the spectrum that are near each other.
#[derive(Clone)]
pub(crate) struct Band {
    /// Middle, hertz.
    pub(crate) hertz: f64,
    /// Number of lines.
    pub(super) count: f64,
    /// Mean power of a channel in a line.
    pub(crate) power: f64,
    /// What noise of spectrum 1/f, one at a hertz, is expected to show there.
    pub(crate) flicker: f64,
    pub(super) octave: i64,
}

/// A line: hertz, mean power of a channel, what 1/f is expected to show there.
pub(super) type Line = (f64, f64, f64);

/// The window of a record, of unit mean square.
fn window(k: usize, n: usize) -> f64 {
    crate::numerics::lines::window(k, n) * (8.0f64 / 3.0).sqrt()
}

/// What noise of the two-sided spectrum 1/|f| is expected to show: itself, and its image about twice the angle.
fn expected(context: &Context, slowest: usize) -> Vec<f64> {
    let n = context.samples();
    let per = context.rate / n as f64;
    let mut image: Vec<Complex<f64>> = (0..n)
        .map(|k| {
            let once = Complex::new(context.cos[k], context.sin[k]);
            once * once * window(k, n)
        })
        .collect();
    nonius_fourier::forward(&mut image);
    let total: f64 = image.iter().map(Complex::norm_sqr).sum();
    for value in &mut image {
        *value = Complex::new(value.norm_sqr() / total, 0.0);
    }
    let own = |k: usize| {
        let cycles = k.min(n - k);
        // Slower parts were taken off with the polynomials of time.
        if cycles < slowest.div_ceil(2) {
            0.0
        } else {
            1.0 / (cycles as f64 * per)
        }
    };
    let mut spectrum: Vec<Complex<f64>> = (0..n).map(|k| Complex::new(own(k), 0.0)).collect();
    nonius_fourier::inverse(&mut image);
    nonius_fourier::inverse(&mut spectrum);
    for (a, b) in image.iter_mut().zip(&spectrum) {
        *a *= b;
    }
    nonius_fourier::forward(&mut image);
    (0..n).map(|k| own(k) + image[k].re / n as f64).collect()
}

/// Lines of the spectrum of both channels. Every second one, for neighbours share the window.
pub(super) fn spectrum(context: &Context, radial: &[f64], slowest: usize) -> Vec<Line> {
    let n = radial.len();
    let mut both: Vec<Complex<f64>> = (0..n)
        .map(|k| {
            let r = 2.0 * radial[k] * window(k, n);
            Complex::new(r * context.cos[k], r * context.sin[k])
        })
        .collect();
    nonius_fourier::forward(&mut both);
    let flicker = expected(context, slowest);
    let last = (HIGHEST * n as f64 / 2.0) as usize;
    let line = |k: usize| {
        // The two sides of the transform of the pair hold both channels.
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        let power = mean(both[k].norm_sqr(), both[n - k].norm_sqr()) / n as f64;
        (
            k as f64 * context.rate / n as f64,
            power,
            mean(flicker[k], flicker[n - k]),
        )
    };
    (slowest..=last).step_by(2).map(line).collect()
}

/// Lines gathered into bands.
pub(super) fn bands(lines: &[Line]) -> Vec<Band> {
    let octaves = |l: &Line| (l.0 / lines[0].0).log2();
    let number = |l: &Line| (octaves(l) * PER_OCTAVE) as i64;
    lines
        .chunk_by(|a, b| number(a) == number(b))
        .map(|part| {
            let count = part.len() as f64;
            Band {
                hertz: part.iter().map(|l| l.0).sum::<f64>() / count,
                count,
                power: part.iter().map(|l| l.1).sum::<f64>() / count,
                flicker: part.iter().map(|l| l.2).sum::<f64>() / count,
                octave: octaves(&part[0]) as i64,
            }
        })
        .collect()
}

/// Lines of the spectrum with hum cut down to what is near it.
pub(super) fn without_hum(lines: &mut [Line]) {
    let powers: Vec<f64> = lines.iter().map(|l| l.1).collect();
    let cut = crate::numerics::lines::cut(&powers, NEAR, HUM);
    lines.iter_mut().zip(cut).for_each(|(l, cut)| l.1 = cut);
}
