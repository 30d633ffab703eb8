//! Whether the scale stands still: a few codes of the ADC about one place, and nothing that goes round.
//!
//! At rest the codes flicker about one place, and a handful of codes looks like whatever one searches for: a line where
//! one channel hardly flickers, a few places of the period, even an ellipse. What a scale that turns does and white noise
//! does not: its channels are large in turns, so that their squares go against each other, and the pair goes round.

/// Codes beyond which a channel is no flicker.
const MOST: usize = 16;
/// Samples per code that tell codes from values that happen to repeat.
const REPEATS: usize = 8;
/// Standard deviation, in steps of the ADC, of a flicker. A sine of 1.8 steps has that.
const FLICKER: f64 = 1.25;
/// Standard deviations, and the step that rounding adds, beyond which a sample is no flicker: a short motion amid a long rest.
const FAR: f64 = 5.0;
/// Consecutive parts of a recording, and samples in each that make its mean a place.
const PARTS: usize = 32;
const PART: usize = 64;
/// Steps between the places of two parts that are a motion and no drift of the ADC.
const WANDERED: f64 = 1.5;
/// Correlation of the channels that is one common motion.
const COMMON: f64 = 0.5;
/// Correlation of the squares, −1 on a ring and −0.25 where noise is 0.4 of its radius: more noise leaves no ellipse.
const RING: f64 = -0.25;
/// Area swept from one sample to the next, in products of standard deviations; a pair that steps by δ has 2 sin δ.
const SWEPT: f64 = 0.5;

/// Index of the first sample after the zeros in both channels that are an ADC that had not begun yet; all zeros are a
/// recording.
pub(crate) fn start(cos: &[f64], sin: &[f64]) -> usize {
    let rows = cos.iter().zip(sin);
    let zeros = rows.take_while(|(c, s)| **c == 0.0 && **s == 0.0).count();
    if zeros == cos.len() { 0 } else { zeros }
}

/// True where both channels are constant, or flicker about one place by a few steps of the ADC.
#[must_use]
pub fn at_rest(cos: &[f64], sin: &[f64]) -> bool {
    let start = start(cos, sin);
    let (cos, sin) = (&cos[start..], &sin[start..]);
    let (Some(cos), Some(sin)) = (flicker(cos), flicker(sin)) else {
        return false;
    };
    !moves(&cos, &sin)
}

/// The values in steps from their mean, where they are a few codes and stray by about one step.
fn flicker(values: &[f64]) -> Option<Vec<f64>> {
    let mut codes: Vec<f64> = vec![];
    for value in values {
        if !codes.contains(value) {
            codes.push(*value);
            if codes.len() > MOST || codes.len() * REPEATS > values.len() {
                return None;
            }
        }
    }
    codes.sort_by(f64::total_cmp);
    let gaps = || codes.windows(2).map(|w| w[1] - w[0]);
    let step = gaps().fold(f64::INFINITY, f64::min);
    let whole = |gap: f64| (gap / step - (gap / step).round()).abs() < 0.02;
    if !gaps().all(whole) {
        return None;
    }
    let n = values.len() as f64;
    // Sums of offsets are nearer to zero than sums of codes.
    let first = codes.first()?;
    let mean = values.iter().map(|v| (v - first) / step).sum::<f64>() / n;
    let strays: Vec<f64> = values.iter().map(|v| (v - first) / step - mean).collect();
    let size = (strays.iter().map(|x| x * x).sum::<f64>() / n).sqrt();
    let near = |stray: &f64| stray.abs() <= 1.0 + FAR * size;
    (size <= FLICKER && strays.iter().all(near)).then_some(strays)
}

/// Signs of motion that white noise about one place does not have.
fn moves(cos: &[f64], sin: &[f64]) -> bool {
    let n = cos.len() as f64;
    let along = correlation(cos, sin);
    if along.abs() > COMMON || wanders(cos) || wanders(sin) {
        return true;
    }
    let size = |x: &[f64]| (x.iter().map(|x| x * x).sum::<f64>() / n).sqrt();
    let (size_c, size_s) = (size(cos), size(sin));
    if size_c == 0.0 || size_s == 0.0 {
        return false;
    }
    // Phase errors lean a ring, which hides it from the squares: upright again.
    let upright = cos
        .iter()
        .zip(sin)
        .map(|(c, s)| s / size_s - along * c / size_c);
    let upright: Vec<f64> = upright.collect();
    let squares = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| x * x).collect() };
    let ring = correlation(&squares(cos), &squares(&upright));
    let pairs = cos.windows(2).zip(sin.windows(2));
    let area: f64 = pairs.map(|(c, s)| c[0] * s[1] - s[0] * c[1]).sum();
    let swept = area / (n * size_c * size_s);
    ring < RING.min(-4.0 / n.sqrt()) || swept.abs() > SWEPT.max(5.0 * (2.0 / n).sqrt())
}

/// Whether the place of one part of the recording is not that of another.
fn wanders(values: &[f64]) -> bool {
    let size = values.len().div_ceil(PARTS).max(PART);
    let places = values.chunks_exact(size);
    let places = places.map(|part| part.iter().sum::<f64>() / size as f64);
    let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), place| {
        (low.min(place), high.max(place))
    });
    high - low > WANDERED
}

/// Of two channels; 0 where one is constant.
fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / n;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        let (a, b) = (a - mean_a, b - mean_b);
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    // Squares of two codes at equal distances differ by rounding alone.
    if aa.min(bb) > 1e-12 * n {
        ab / (aa * bb).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{SeedableRng, rngs::StdRng};
    use rand_distr::{Distribution, StandardNormal};

    /// Codes of `sigma` steps of noise about what `signal` gives.
    fn codes(
        seed: u64,
        sigma: f64,
        n: u32,
        signal: impl Fn(f64) -> (f64, f64),
    ) -> (Vec<f64>, Vec<f64>) {
        let mut random = StdRng::seed_from_u64(seed);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let one = |k: u32| {
            let (c, s) = signal(f64::from(k));
            (
                (c + sigma * draw()).round() + 1200.0,
                (s + sigma * draw()).round() - 500.0,
            )
        };
        (0..n).map(one).unzip()
    }

    #[test]
    fn noise_about_one_place_is_rest_wherever_the_codes_lie() {
        for sigma in [0.0, 0.15, 0.25, 0.35, 0.45, 0.7] {
            for seed in 0..100 {
                let place = (seed as f64 * 0.618 % 1.0, seed as f64 * 0.414 % 1.0);
                let (cos, sin) = codes(seed, sigma, 3000, |_| place);
                assert!(at_rest(&cos, &sin), "{sigma} {seed}");
                // In volts, after zeros.
                let volts = |v: &[f64]| -> Vec<f64> {
                    let after = v.iter().map(|v| v * 10.0 / 4096.0);
                    [0.0; 3].into_iter().chain(after).collect()
                };
                assert!(at_rest(&volts(&cos), &volts(&sin)), "{sigma} {seed}");
            }
        }
    }

    #[test]
    fn a_ring_of_one_and_a_half_steps_turns_at_any_speed_and_leaning() {
        for (amplitude, sigma) in [(1.5, 0.0), (1.5, 0.3), (5.0, 0.5)] {
            for periods in [1.0, 7.3, 500.0, 750.0, 1000.0, 1234.5] {
                for lean in [0.0, 0.4] {
                    for seed in 0..5 {
                        let turn = |k: f64| {
                            let alpha = 0.3 + std::f64::consts::TAU * periods * k / 3000.0;
                            (amplitude * alpha.cos(), amplitude * (alpha - lean).sin())
                        };
                        let (cos, sin) = codes(seed, sigma, 3000, turn);
                        assert!(
                            !at_rest(&cos, &sin),
                            "{amplitude} {sigma} {periods} {lean} {seed}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_short_turn_amid_a_long_rest_is_a_motion() {
        for share in [0.005, 0.03, 0.2] {
            for amplitude in [2.0, 5.0] {
                let turn = |k: f64| {
                    let alpha = std::f64::consts::TAU * (k / 3000.0 / share).min(1.0);
                    (amplitude * alpha.cos(), amplitude * alpha.sin())
                };
                let (cos, sin) = codes(1, 0.35, 3000, turn);
                assert!(!at_rest(&cos, &sin), "{share} {amplitude}");
            }
        }
    }

    #[test]
    fn values_without_steps_one_common_motion_and_a_wide_flicker_are_not_judged() {
        let (cos, sin) = codes(1, 0.4, 1000, |_| (0.3, 0.4));
        let fine: Vec<f64> = (0..).map(|k| f64::from(k).sin()).take(1000).collect();
        assert!(!at_rest(&fine, &sin));
        assert!(!at_rest(&cos, &cos));
        let (cos, sin) = codes(1, 3.0, 1000, |_| (0.3, 0.4));
        assert!(!at_rest(&cos, &sin));
    }
}
