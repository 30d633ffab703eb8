//! Whether what everything leaves of the radius is white noise: what is not, lives there without a name.

use std::f64::consts::TAU;

use nonius_fourier::Complex;
use nonius_quantity::{Quantity, Unit};

use crate::context::Context;
use crate::finding::Cause;
use crate::numerics::lines::median;
use crate::numerics::statistics::after_trials;
use crate::select::score::SHOWN;
use crate::unnamed::unexplained::{Unnamed, What, like};

/// Questions that are asked of it.
const TRIALS: f64 = 2.0;
/// Noise of less than so many codes is the ADC's, which follows the signal.
const CODES: f64 = 0.5;
/// Standard deviations from which on a sample stands out: not one in 10⁸ of noise does.
const FAR: f64 = 6.0;
/// Share of all samples from which on those that stand out are no tail of a noise.
const SINGLE: f64 = 0.005;
/// Sectors of the period in each of which the noise has a size of its own, and fewest samples that tell it.
const SECTORS: usize = 16;
const IN_A_SECTOR: usize = 50;
/// So many times the error of the codes, that and noise of its size do not leave.
const MORE: f64 = 1.5;
/// Fewest samples that stand out and are no chance.
const FEWEST: usize = 3;

/// Bartlett's test of a cumulated spectrum: for white noise it rises evenly.
pub(crate) struct Bartlett {
    /// Share of the power up to each line.
    pub(crate) shares: Vec<f64>,
    /// Largest distance from the even rise.
    pub(crate) distance: f64,
    /// Where that is, as a share of half the sample rate; whether there is more power below than above.
    at: f64,
    low: bool,
    /// Of a distance as large as this in white noise.
    pub(crate) p_value: f64,
}

impl Bartlett {
    /// Of these values.
    pub(crate) fn of(values: &[f64]) -> Self {
        let n = values.len();
        let mut buffer: Vec<Complex<f64>> = values.iter().map(|v| Complex::new(*v, 0.0)).collect();
        nonius_fourier::forward(&mut buffer);
        let mut sum = 0.0;
        let mut shares: Vec<f64> = buffer
            .get(1..n.div_ceil(2))
            .unwrap_or_default()
            .iter()
            .map(|z| {
                sum += z.norm_sqr();
                sum
            })
            .collect();
        shares
            .iter_mut()
            .for_each(|s| *s /= sum.max(f64::MIN_POSITIVE));
        let m = shares.len().max(1) as f64;
        let even = (1..).map(|i| f64::from(i) / m);
        let off = shares.iter().zip(even).map(|(s, e)| (s - e, e));
        let (off, at) = off.fold((0.0, 0.0), |far: (f64, f64), one| {
            if one.0.abs() > far.0.abs() { one } else { far }
        });
        let distance = off.abs();
        Self {
            shares,
            distance,
            at,
            low: off > 0.0,
            p_value: kolmogorov(distance * m.sqrt()),
        }
    }

    /// How the spectrum differs from that of white noise, for so many samples per second.
    pub(crate) fn words(&self, rate: f64) -> String {
        let hertz = Quantity::rounded(self.at * rate / 2.0, 2, Unit::Prefixed("Hz"));
        let side = if self.low { "below" } else { "above" };
        format!(
            "{} more of its power is {side} {} than of white noise",
            Quantity::rounded(self.distance, 2, Unit::Percent).brief(),
            hertz.brief()
        )
    }
}

/// Probability that the supremum of a Brownian bridge exceeds x (Kolmogorov).
fn kolmogorov(x: f64) -> f64 {
    if x < 0.2 {
        return 1.0;
    }
    let term = |j: i32| {
        let sign = if j % 2 == 1 { 1.0 } else { -1.0 };
        sign * (-2.0 * f64::from(j * j) * x * x).exp()
    };
    (2.0 * (1..=20).map(term).sum::<f64>()).clamp(0.0, 1.0)
}

/// Which sector of the period a sample lies in.
fn sector(context: &Context, k: usize) -> usize {
    let turns = context.alpha[k].rem_euclid(TAU) / TAU;
    ((turns * SECTORS as f64) as usize).min(SECTORS - 1)
}

/// Standard deviation of normal noise of these sizes.
fn spread(sizes: &[f64]) -> f64 {
    median(sizes) / 0.674_489_75
}

/// How many times as loud as in the whole period the noise is in each sector of it, at least once: the noise of a weak channel
/// is large where that channel makes the radius.
fn by_angle(context: &Context, radial: &[f64], sigma: f64) -> Vec<f64> {
    let mut sizes: Vec<Vec<f64>> = vec![vec![]; SECTORS];
    for (k, r) in radial.iter().enumerate() {
        if context.weight[k] > 0.0 {
            sizes[sector(context, k)].push(r.abs());
        }
    }
    let louder = |sizes: &Vec<f64>| {
        if sizes.len() < IN_A_SECTOR {
            return 1.0;
        }
        (spread(sizes) / sigma).max(1.0)
    };
    sizes.iter().map(louder).collect()
}

/// Samples that stand out of the noise of their part of the period, whose standard deviation is `sigma` on the whole.
fn far_off(context: &Context, radial: &[f64], sigma: f64) -> Vec<usize> {
    let louder = by_angle(context, radial, sigma);
    let far = |k: &usize| {
        let sigma = sigma * louder[sector(context, *k)];
        radial[*k].abs() > FAR * sigma && context.weight[*k] > 0.0
    };
    (0..radial.len()).filter(far).collect()
}

/// Sizes of a radial residual where samples count.
fn sizes(context: &Context, radial: &[f64]) -> Vec<f64> {
    let pairs = radial.iter().zip(&context.weight);
    pairs
        .filter(|(_, w)| **w > 0.0)
        .map(|(r, _)| r.abs())
        .collect()
}

/// Samples that stand out of a radial residual, in amplitudes, each by itself, and are so many that noise which goes with the signal would be
/// made of them.
pub(crate) fn single_samples(context: &Context, radial: &[f64]) -> Option<Unnamed> {
    let sizes = sizes(context, radial);
    let sigma = spread(&sizes);
    if sigma.is_nan() || sigma <= CODES * context.code() {
        return None;
    }
    let far = far_off(context, radial, sigma);
    // Noise that is louder at times has them side by side.
    let beside = far.windows(2).filter(|pair| pair[1] == pair[0] + 1).count();
    let many = far.len() as f64 > SINGLE * sizes.len() as f64 && 3 * beside < far.len();
    many.then(|| unlikely(&far, radial.len(), "they are too many to be left out"))
        .flatten()
}

/// Samples that stand out, of so many: too many for chance. `but` says why they are no glitches.
fn unlikely(far: &[usize], samples: usize, but: &str) -> Option<Unnamed> {
    let first = far.first().filter(|_| far.len() >= FEWEST)?;
    // Each is less likely than one in 10⁸.
    let expected = 2e-9 * samples as f64;
    let p_value = expected.min(1.0).powi(FEWEST as i32);
    said(
        p_value,
        format!(
            "{} samples deviate in the radius by more than {FAR} standard deviations of the noise, the first is sample {first}; {}",
            far.len(),
            like(Cause::Glitches, but)
        ),
    )
}

/// What is told of what would be as far off in noise with this probability.
fn said(p_value: f64, sentence: String) -> Option<Unnamed> {
    let log_p = after_trials(p_value.max(f64::MIN_POSITIVE).ln(), TRIALS);
    (log_p < SHOWN.ln()).then_some(Unnamed {
        log_p,
        gain: 0.0,
        what: What::Said(sentence),
    })
}

/// What of a radial residual, in amplitudes, is no white noise; nothing where the ADC is coarser than the noise, or the codes err by
/// `coded` rms and no more is left than that may make.
pub(crate) fn no_noise(context: &Context, radial: &[f64], coded: f64) -> Vec<Unnamed> {
    let sizes = sizes(context, radial);
    if sizes.is_empty() {
        return vec![];
    }
    let sigma = spread(&sizes);
    if sigma.is_nan() || sigma <= CODES * context.code() {
        return vec![];
    }
    let square: f64 = radial.iter().map(|r| r * r).sum();
    let rms = (square / radial.len().max(1) as f64).sqrt();
    let made_by_codes = rms < MORE * coded;
    if made_by_codes {
        return vec![];
    }
    let but = "the samples beside them deviate, too";
    let far = unlikely(&far_off(context, radial, sigma), radial.len(), but);
    let bartlett = Bartlett::of(radial);
    let coloured = said(
        bartlett.p_value,
        format!(
            "the radial residual of {} of the amplitude rms is not white: {} (Bartlett's test)",
            Quantity::rounded(rms, 2, Unit::Percent).brief(),
            bartlett.words(context.rate)
        ),
    );
    [far, coloured].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kolmogorovs_distribution_agrees_with_tables() {
        assert!((kolmogorov(1.358_1) - 0.05).abs() < 1e-4);
        assert!((kolmogorov(1.949_5) - 0.001).abs() < 1e-5);
        assert!((kolmogorov(0.5) - 0.963_9).abs() < 1e-4);
    }
}
