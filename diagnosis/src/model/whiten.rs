//! Whitening: what the noise keeps from sample to sample is predicted and taken off, from data and shapes alike.

/// Order of the prediction: enough for a few broad resonances of an axis, too short to swallow a line.
pub(crate) const ORDER: usize = 24;
const _: () = assert!(ORDER.is_multiple_of(8), "they are taken off by eights");
/// Reflections below so many of their standard errors are those of white noise.
const WHITE: f64 = 4.5;
/// Samples of a spectrum; several of them are averaged.
const SEGMENT: usize = 4096;
/// Above so many times what is near it in the spectrum, a line stands.
const STANDS_OUT: f64 = 3.0;

/// Lines of a spectrum on either side that are near: a line is narrower, a resonance of the axis wider.
const NEAR: usize = 8;

/// A linear prediction of noise from its past.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Whitener {
    coefficients: Vec<f64>,
    /// Rms of what cannot be predicted.
    pub sigma: f64,
}

impl Whitener {
    /// From a residual whose frequencies below `gone` (cycles per sample) were taken off with the motion: there the noise
    /// is taken to be what it is just above, for a hole in the spectrum must not be amplified. Lines are no noise and are
    /// cut off. There is at least white noise of an rms of `least`. Autocorrelation method (Levinson and Durbin).
    #[must_use]
    pub(crate) fn of(residual: &[f64], gone: f64, least: f64) -> Self {
        let (power, seen) = averaged(residual);
        let reach = (power.len() / 16).clamp(4, NEAR);
        let mut power = crate::numerics::lines::cut(&power, reach, STANDS_OUT);
        let length = 2 * (power.len() - 1);
        let index = |f: f64| ((f * length as f64).ceil() as usize).min(power.len() - 1);
        let (first, last) = (index(gone), index((2.0 * gone).min(0.5)));
        if first > 0 && last > first {
            let level = power[first..last].iter().sum::<f64>() / (last - first) as f64;
            power[..first].iter_mut().for_each(|p| *p = level);
        }
        power.iter_mut().for_each(|p| *p = p.max(least * least));
        // Back to the autocorrelation: the spectrum is even.
        let correlation: Vec<f64> = (0..=ORDER)
            .map(|lag| {
                let wave =
                    |k: usize| (std::f64::consts::TAU * (k * lag) as f64 / length as f64).cos();
                let ends = power[0] + power[power.len() - 1] * wave(power.len() - 1);
                let inner: f64 = (1..power.len() - 1).map(|k| 2.0 * power[k] * wave(k)).sum();
                (ends + inner) / length as f64
            })
            .collect();
        if correlation[0].is_nan() || correlation[0] <= 0.0 {
            return Self {
                coefficients: vec![],
                sigma: f64::MIN_POSITIVE.sqrt(),
            };
        }
        let mut error = correlation[0];
        let mut a: Vec<f64> = vec![];
        let mut coloured = false;
        for m in 0..ORDER {
            let predicted: f64 = (0..m).map(|i| a[i] * correlation[m - i]).sum();
            let reflection = (correlation[m + 1] - predicted) / error;
            coloured |= reflection.abs() > WHITE / seen.sqrt();
            let old = a.clone();
            for i in 0..m {
                a[i] = old[i] - reflection * old[m - 1 - i];
            }
            a.push(reflection);
            error *= 1.0 - reflection * reflection;
        }
        if !coloured {
            return Self {
                coefficients: vec![],
                sigma: correlation[0].sqrt(),
            };
        }
        Self {
            coefficients: a,
            sigma: error.max(1e-300).sqrt(),
        }
    }

    /// Nothing can be predicted.
    pub(crate) fn is_white(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// The unpredictable part of a whole record, in units of its rms; before it, nothing was.
    pub(crate) fn unpredictable(&self, values: &[f64]) -> Vec<f64> {
        let past = [vec![0.0; ORDER], values.to_vec()].concat();
        let mut white = past.clone();
        self.block(1, values.len(), &past, &mut white);
        white[ORDER..].iter().map(|w| w / self.sigma).collect()
    }

    /// What correlates with values as the likelihood does: their unpredictable part, of its own future.
    pub(crate) fn matched(&self, values: &[f64]) -> Vec<f64> {
        let mut once = self.unpredictable(values);
        once.reverse();
        let mut twice = self.unpredictable(&once);
        twice.reverse();
        twice
    }

    /// What of the power of white noise is left in common after whitening by either, in the same unit.
    pub(crate) fn of_white(&self, other: &Self) -> f64 {
        let pairs = self.coefficients.iter().zip(&other.coefficients);
        let sum: f64 = pairs.map(|(a, b)| a * b).sum();
        (1.0 + sum) / (self.sigma * other.sigma)
    }

    /// The unpredictable part of columns that have `ORDER` values of their past before them; in the unit of the values.
    pub(crate) fn block(&self, columns: usize, samples: usize, plain: &[f64], white: &mut [f64]) {
        if self.is_white() {
            return;
        }
        let stride = plain.len() / columns;
        for (from, to) in plain.chunks(stride).zip(white.chunks_mut(stride)) {
            predicted_off(
                &self.coefficients,
                &from[..ORDER + samples],
                &mut to[ORDER..ORDER + samples],
            );
        }
    }
}

/// Values without what their past predicts; `plain` are the values, `ORDER` of their past before them. For the widest registers
/// that the processor has, and fused by it or, on an old one, slowly: all find the same values.
#[multiversion::multiversion(targets("x86_64+avx512f+fma", "x86_64+avx2+fma"))]
fn predicted_off(coefficients: &[f64], plain: &[f64], white: &mut [f64]) {
    // Several at once: each sample is read and written less often.
    let (groups, _) = coefficients.as_chunks::<8>();
    for (group, i) in groups.iter().zip(0..) {
        let start = ORDER - 8 * i - 8;
        // The past of value k, the oldest of eight first.
        let past = plain[start..start + 7 + white.len()].windows(8);
        if i == 0 {
            for ((to, from), past) in white.iter_mut().zip(&plain[ORDER..]).zip(past) {
                *to = less(*from, group, past);
            }
        } else {
            for (to, past) in white.iter_mut().zip(past) {
                *to = less(*to, group, past);
            }
        }
    }
}

/// A value less what eight of its past predict of it, the oldest first.
#[inline(always)]
fn less(value: f64, coefficients: &[f64; 8], past: &[f64]) -> f64 {
    let pairs = coefficients.iter().zip(past.iter().rev());
    pairs.fold(value, |left, (a, p)| (-a).mul_add(*p, left))
}

/// Average spectrum of overlapping segments, per sample: its mean over all frequencies is the mean square. And the number
/// of samples that it is worth.
fn averaged(values: &[f64]) -> (Vec<f64>, f64) {
    let n = values.len();
    let segment = SEGMENT
        .min((n / 4).next_power_of_two())
        .clamp(16, n.max(16));
    let window: Vec<f64> = (0..segment)
        .map(|k| (std::f64::consts::PI * (k as f64 + 0.5) / segment as f64).sin())
        .collect();
    let scale = 1.0 / window.iter().map(|w| w * w).sum::<f64>();
    let mut sum = vec![0.0; segment + 1];
    let mut count: f64 = 0.0;
    // Enough of them, spread over the record.
    let step = (segment / 2).max(n / 64);
    for start in (0..=n.saturating_sub(segment)).step_by(step) {
        let part = values[start..].iter().zip(&window);
        let windowed: Vec<f64> = part.map(|(v, w)| v * w).collect();
        let (power, _) = crate::numerics::lines::spectrum(&windowed);
        sum.iter_mut().zip(power).for_each(|(s, p)| *s += p * scale);
        count += 1.0;
    }
    // Apart from each other, segments see what their windows let through.
    let seen = if step > segment / 2 {
        (count * segment as f64 * 2.0 / 3.0).min(n as f64)
    } else {
        n as f64
    };
    (sum.iter().map(|s| s / count.max(1.0)).collect(), seen)
}

#[cfg(test)]
mod tests {
    use rand::{SeedableRng, rngs::StdRng};
    use rand_distr::{Distribution, StandardNormal};

    use super::Whitener;

    /// Of a long record only a part is looked at, which says less than all of it would.
    #[test]
    fn white_noise_of_any_length_is_white() {
        let mut random = StdRng::seed_from_u64(5);
        for n in [5_000, 80_000, 1_500_000] {
            let noise: Vec<f64> = (0..n).map(|_| StandardNormal.sample(&mut random)).collect();
            let found = Whitener::of(&noise, 0.0, 0.0);
            assert!(found.is_white(), "{n}");
            assert!(
                (found.sigma - 1.0).abs() < 5.0 / (2.0 * n.min(170_000) as f64).sqrt(),
                "{n}: {}",
                found.sigma
            );
        }
    }
}
