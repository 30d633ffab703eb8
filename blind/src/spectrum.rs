//! Random waves of a given spectrum, and weighting by one.

use nonius_fourier::Complex;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// A Gaussian wave of `length` points, periodic in them: line `j` (cycles in the length) has variance `variance(j)`.
pub(crate) fn wave(
    random: &mut impl Rng,
    length: usize,
    lines: usize,
    variance: impl Fn(usize) -> f64,
) -> Vec<f64> {
    let mut bins = vec![Complex::new(0.0, 0.0); length];
    let filled = lines.min(length / 2);
    for (j, bin) in bins.iter_mut().enumerate().take(filled).skip(1) {
        let size = variance(j).sqrt();
        let (re, im): (f64, f64) = (StandardNormal.sample(random), StandardNormal.sample(random));
        *bin = Complex::new(re * size, im * size);
    }
    // Real part of an analytic signal: each line has the variance asked for.
    nonius_fourier::inverse(&mut bins);
    bins.iter().map(|b| b.re).collect()
}

/// Multiplies line `j` of `values` by `gain[j]`, `gain` from zero to half the length.
pub(crate) fn weighted(values: &[f64], gain: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mut bins: Vec<Complex<f64>> = values.iter().map(|v| Complex::new(*v, 0.0)).collect();
    nonius_fourier::forward(&mut bins);
    for (j, bin) in bins.iter_mut().enumerate() {
        *bin *= gain[j.min(n - j)] / n as f64;
    }
    nonius_fourier::inverse(&mut bins);
    bins.iter().map(|b| b.re).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{SeedableRng, rngs::StdRng};

    #[test]
    fn a_wave_has_the_variance_asked_for() {
        let mut random = StdRng::seed_from_u64(4);
        let wave = wave(&mut random, 8192, 2001, |_| 1.0 / 2000.0);
        let power: f64 = wave.iter().map(|w| w * w).sum::<f64>() / 8192.0;
        assert!((power - 1.0).abs() < 0.1, "{power}");
    }

    #[test]
    fn weighting_by_one_changes_nothing() {
        let values: Vec<f64> = (0..300).map(|k| f64::from(k * k % 17)).collect();
        for (a, b) in values.iter().zip(weighted(&values, &[1.0; 151])) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}
