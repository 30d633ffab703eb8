//! Noise with a 1/f spectrum: white noise, shaped line by line.

use nonius_fourier::Complex;
use rand::{Rng, rngs::StdRng};
use rand_distr::StandardNormal;

/// `n` samples at `rate` per second of noise whose one-sided amplitude density is `density` at a hertz and falls with the
/// root of the frequency; nothing slower than the recording.
pub(crate) fn noise(n: usize, rate: f64, density: f64, random: &mut StdRng) -> Vec<f64> {
    let mut buffer: Vec<Complex<f64>> = (0..n)
        .map(|_| Complex::new(random.sample::<f64, _>(StandardNormal), 0.0))
        .collect();
    nonius_fourier::forward(&mut buffer);
    for (k, line) in buffer.iter_mut().enumerate() {
        let hertz = k.min(n - k) as f64 * rate / n as f64;
        // White noise of mean square one has the density sqrt(2 / rate).
        *line *= if k == 0 {
            0.0
        } else {
            density / hertz.sqrt() / (2.0 / rate).sqrt() / n as f64
        };
    }
    nonius_fourier::inverse(&mut buffer);
    buffer.iter().map(|z| z.re).collect()
}
