//! Lines in a spectrum.

use std::f64::consts::TAU;

use nonius_fourier::Complex;

/// Power spectrum of values, zero-padded to twice a power of two: frequency in cycles per sample is index / length.
pub(crate) fn spectrum(values: &[f64]) -> (Vec<f64>, usize) {
    let length = (values.len() * 2).next_power_of_two();
    let mut buffer: Vec<Complex<f64>> = values.iter().map(|v| Complex::new(*v, 0.0)).collect();
    buffer.resize(length, Complex::new(0.0, 0.0));
    nonius_fourier::forward(&mut buffer);
    let power = buffer[..=length / 2].iter().map(|z| z.norm_sqr());
    (power.collect(), length)
}

/// The transforms of two real signals at the frequencies of [`spectrum`], both by one transform.
pub(crate) fn two_transforms(a: &[f64], b: &[f64]) -> (Vec<[Complex<f64>; 2]>, usize) {
    let length = (a.len() * 2).next_power_of_two();
    let pairs = a.iter().zip(b);
    let mut buffer: Vec<Complex<f64>> = pairs.map(|(a, b)| Complex::new(*a, *b)).collect();
    buffer.resize(length, Complex::new(0.0, 0.0));
    nonius_fourier::forward(&mut buffer);
    // Of real signals, the transform at −f is the conjugate of that at f.
    let parts = (0..=length / 2).map(|k| {
        let (now, mirrored) = (buffer[k], buffer[(length - k) % length].conj());
        [
            0.5 * (now + mirrored),
            Complex::new(0.0, -0.5) * (now - mirrored),
        ]
    });
    (parts.collect(), length)
}

/// The spectra of two real signals.
pub(crate) fn two_spectra(a: &[f64], b: &[f64]) -> ([Vec<f64>; 2], usize) {
    let (transforms, length) = two_transforms(a, b);
    let powers = transforms.iter().map(|[a, b]| (a.norm_sqr(), b.norm_sqr()));
    let (first, second) = powers.unzip();
    ([first, second], length)
}

/// The sum of the spectra of two signals.
pub(crate) fn pair_spectrum(a: &[f64], b: &[f64]) -> (Vec<f64>, usize) {
    let ([x, y], length) = two_spectra(a, b);
    (x.iter().zip(&y).map(|(x, y)| x + y).collect(), length)
}

/// The window of a record of `n` values at the k-th: a squared sine (Hann).
pub(crate) fn window(k: usize, n: usize) -> f64 {
    (std::f64::consts::PI * (k as f64 + 0.5) / n as f64)
        .sin()
        .powi(2)
}

/// The median; of an even number, the upper of the two in the middle. 0 of nothing.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// A spectrum without what stands out of it: values above `times` the median of those at most `reach` beside them are cut
/// down to that.
pub(crate) fn cut(power: &[f64], reach: usize, times: f64) -> Vec<f64> {
    (0..power.len())
        .map(|k| {
            let near = k.saturating_sub(reach)..(k + reach + 1).min(power.len());
            let median = median(&power[near]);
            if power[k] > times * median {
                median
            } else {
                power[k]
            }
        })
        .collect()
}

/// A spectrum over the median of what is near in it.
pub(crate) fn flattened(power: &[f64]) -> Vec<f64> {
    // Frequencies that are near: closer to each other than to zero.
    let mut flat = Vec::with_capacity(power.len());
    while flat.len() < power.len() {
        let start = flat.len();
        let end = (start + (start / 4).clamp(16, 512)).min(power.len());
        let median = median(&power[start..end]).max(f64::MIN_POSITIVE);
        flat.extend(power[start..end].iter().map(|p| p / median));
    }
    flat
}

/// Frequency in cycles per sample of the highest peak between two frequencies.
pub(crate) fn peak(power: &[f64], length: usize, low: f64, high: f64) -> Option<f64> {
    let index = |f: f64| ((f * length as f64) as usize).min(power.len() - 1);
    let (low, high) = (index(low).max(1), index(high));
    let best = (low..=high).max_by(|a, b| power[*a].total_cmp(&power[*b]))?;
    Some(refined(power, best) / length as f64)
}

/// Index of a peak between the points of a spectrum, not the first: that of a parabola through three of them.
pub(crate) fn refined(power: &[f64], best: usize) -> f64 {
    let at = |k: usize| power.get(k).copied().unwrap_or(0.0);
    let (left, middle, right) = (at(best.saturating_sub(1)), at(best), at(best + 1));
    let bend = left - 2.0 * middle + right;
    let shift = if bend < 0.0 {
        0.5 * (left - right) / bend
    } else {
        0.0
    };
    best as f64 + shift.clamp(-0.5, 0.5)
}

/// cos and sin of a frequency in hertz at the given times.
pub(crate) fn wave(time: &[f64], hertz: f64) -> [Vec<f64>; 2] {
    cos_and_sin(time, TAU * hertz)
}

/// cos and sin of so many times these.
pub(crate) fn cos_and_sin(of: &[f64], by: f64) -> [Vec<f64>; 2] {
    let (sin, cos) = of.iter().map(|v| (by * v).sin_cos()).unzip();
    [cos, sin]
}

/// Frequency of the strongest line in cycles per sample, and `values` without it.
pub(crate) fn strongest(values: &[f64]) -> (f64, Vec<f64>) {
    let (power, length) = spectrum(values);
    let Some(f) = peak(&power, length, 2.0 / values.len() as f64, 0.5) else {
        return (0.0, values.to_vec());
    };
    let time: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
    (f, crate::numerics::solve::without(values, &wave(&time, f)))
}
