//! Which samples to use, and an ellipse to start from.
//!
//! A glitch or a row of zeros before the ADC began would bend every estimate, so samples far off the ellipse are left
//! out, for every method alike.

use std::collections::{HashMap, HashSet};

use nonius_recording::{Ellipse, FitMethod};

use crate::curve::Curve;

/// Residual, in robust standard deviations, from which a sample is far off. White noise gets there once in 5·10⁸.
const FAR: f64 = 6.0;
/// Smallest residual that is far off, in fractions of the amplitude.
const FLOOR: f64 = 1e-6;
/// Radial residual, in fractions of the amplitude, of samples that draw no ellipse.
pub(crate) const ROUND: f64 = 0.25;
/// Sectors of the period in which the residual's size is found apart.
const SECTORS: usize = 32;

/// The samples that are used.
pub(crate) struct Samples {
    pub(crate) cos: Vec<f64>,
    pub(crate) sin: Vec<f64>,
    /// A rough ellipse.
    pub(crate) start: Ellipse,
    /// How many were left out.
    pub(crate) outliers: usize,
}

impl Samples {
    /// `None` where they draw no ellipse.
    pub(crate) fn of(cos: &[f64], sin: &[f64]) -> Option<Self> {
        Self::without_repeated(cos, sin).or_else(|| Self::of_all(cos, sin))
    }

    /// Where some samples are one pair to the last digit, far off the ellipse that the others draw: nothing was connected then.
    fn without_repeated(cos: &[f64], sin: &[f64]) -> Option<Self> {
        /// Share of the samples, fewer of which are glitches like others.
        const SOME: f64 = 0.005;
        /// More of them are no accident of a recording that else is sound.
        const MANY: f64 = 0.25;
        let repeated = Repeated::of(cos, sin)?;
        let share = repeated.count as f64 / cos.len() as f64;
        if !(SOME..=MANY).contains(&share) || repeated.cos.len() < nonius_recording::MIN_SAMPLES {
            return None;
        }
        let mut others = Self::of_all(&repeated.cos, &repeated.sin)?;
        let [c, s] = repeated.pair;
        let limit = limit(&others.start, &others.cos, &others.sin);
        others.outliers += repeated.count;
        (others.start.radial_residual(c, s).abs() > limit).then_some(others)
    }

    fn of_all(cos: &[f64], sin: &[f64]) -> Option<Self> {
        let quick = Ellipse::fit(cos, sin);
        // The quick fit wants half a period; a shorter arc is enough to try.
        let start = if quick.method == FitMethod::Conic {
            quick.ellipse
        } else {
            Ellipse::of_arc(cos, sin).filter(Curve::is_sound)?
        };
        let limit = limit(&start, cos, sin);
        let near = |(c, s): &(&f64, &f64)| start.radial_residual(**c, **s).abs() <= limit;
        let pairs = cos.iter().zip(sin).filter(near);
        let (kept_cos, kept_sin): (Vec<f64>, Vec<f64>) = pairs.unzip();
        let rho = kept_cos.iter().zip(&kept_sin);
        let square: f64 = rho
            .map(|(c, s)| start.radial_residual(*c, *s).powi(2))
            .sum();
        let rms = (square / kept_cos.len() as f64).sqrt();
        (rms <= ROUND).then(|| Self {
            outliers: cos.len() - kept_cos.len(),
            cos: kept_cos,
            sin: kept_sin,
            start,
        })
    }
}

/// The pair that more samples are to the last digit than any other.
pub(crate) struct Repeated {
    pub(crate) pair: [f64; 2],
    pub(crate) count: usize,
    /// The other samples.
    pub(crate) cos: Vec<f64>,
    pub(crate) sin: Vec<f64>,
}

impl Repeated {
    pub(crate) fn of(cos: &[f64], sin: &[f64]) -> Option<Self> {
        let mut counts: HashMap<[u64; 2], usize> = HashMap::new();
        let pairs = || cos.iter().zip(sin).map(|(c, s)| [*c, *s]);
        // 0 and -0 are one.
        let bits = |pair: [f64; 2]| pair.map(|y| (y + 0.0).to_bits());
        for pair in pairs() {
            *counts.entry(bits(pair)).or_default() += 1;
        }
        let most = counts.into_iter().max_by_key(|(bits, n)| (*n, *bits));
        let (most, count) = most?;
        let others = pairs().filter(|pair| bits(*pair) != most);
        let (cos, sin) = others.map(|[c, s]| (c, s)).unzip();
        Some(Self {
            pair: most.map(f64::from_bits),
            count,
            cos,
            sin,
        })
    }
}

/// Sector by sector, so that a standstill at one angle does not set the scale for all others.
fn limit(start: &Ellipse, cos: &[f64], sin: &[f64]) -> f64 {
    let mut sectors = vec![vec![]; SECTORS];
    for (c, s) in cos.iter().zip(sin) {
        let sector = ((start.angle(*c, *s) + 0.5) * SECTORS as f64) as usize;
        sectors[sector.min(SECTORS - 1)].push(start.radial_residual(*c, *s).abs());
    }
    let filled = sectors.iter_mut().filter(|sector| sector.len() >= 5);
    let mut sizes: Vec<f64> = filled.map(|sector| median(sector)).collect();
    if sizes.is_empty() {
        return f64::INFINITY;
    }
    sizes.sort_unstable_by(f64::total_cmp);
    let upper = sizes[sizes.len() * 3 / 4];
    f64::max(FAR * 1.4826 * upper, FLOOR)
}

fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The step of the codes that the values are; `None` where they are none, or so fine that few values are alike.
pub(crate) fn code_step(values: &[f64]) -> Option<f64> {
    /// Values of each code.
    const ALIKE: f64 = 2.0;
    let step = nonius_recording::code_step(values)?;
    let first = values.first()?;
    let codes = values.iter().map(|v| ((v - first) / step).round() as i64);
    let codes: HashSet<i64> = codes.collect();
    (ALIKE * codes.len() as f64 <= values.len() as f64).then_some(step)
}

#[cfg(test)]
mod tests {
    use rand::rngs::StdRng;
    use rand::{Rng, SeedableRng};

    use super::*;

    const SENSOR: Ellipse = Ellipse {
        a_c: 1.0,
        b_c: 0.3,
        a_s: 0.8,
        b_s: -0.2,
        beta: 0.1,
    };

    fn turning(n: usize, turns: f64) -> (Vec<f64>, Vec<f64>) {
        let angle = |k: usize| std::f64::consts::TAU * turns * k as f64 / n as f64;
        // A deterministic wobble in place of noise.
        let at = |k: usize| SENSOR.point(angle(k)) * (1.0 + 0.003 * (k as f64 * 2.4).sin());
        (0..n).map(|k| (at(k).x, at(k).y)).unzip()
    }

    /// One sample in twenty is part of the bulk that a first fit goes by, and all to one side they made an ellipse of five amplitudes.
    #[test]
    fn many_glitches_to_one_side_are_left_out() {
        let cases = [(20, 2.0), (20, 5.0), (10, 1.0), (10, 5.0)];
        for (seed, (every, size)) in (0..8).flat_map(|seed| cases.map(|case| (seed, case))) {
            let mut random = StdRng::seed_from_u64(seed);
            let (mut cos, sin) = turning(4000, 9.3);
            let off: Vec<usize> = (0..4000)
                .filter(|_| random.random_ratio(1, every))
                .collect();
            off.iter().for_each(|k| cos[*k] += size);
            let samples = Samples::of(&cos, &sin).expect("an ellipse");
            // Some come to lie on the ellipse.
            assert!(samples.outliers * 10 >= off.len() * 9, "{every} {size}");
            assert!(
                (samples.start.a_c - SENSOR.a_c).abs() < 1e-3,
                "{every} {size}"
            );
        }
    }

    #[test]
    fn glitches_and_zeros_are_left_out_and_nothing_else() {
        let (mut cos, mut sin) = turning(2000, 3.3);
        for k in [0, 1, 700, 1500] {
            (cos[k], sin[k]) = (0.0, 0.0);
        }
        sin[900] = 40.0;
        let samples = Samples::of(&cos, &sin).expect("two channels");
        assert_eq!(samples.outliers, 5);
        assert_eq!(samples.cos.len(), 1995);
    }

    /// Beside offsets of more than an amplitude as beside none; at a place of the ellipse it is a standstill.
    #[test]
    fn one_pair_that_is_no_place_of_the_ellipse_is_left_out() {
        for offset in [0.0, 1.5, 5.0] {
            for share in [100, 50, 20, 10, 4] {
                let (mut cos, mut sin) = turning(2000, 3.3);
                cos.iter_mut().chain(&mut sin).for_each(|y| *y += offset);
                let zeros = 2000 / share;
                cos[..zeros].fill(0.0);
                sin[..zeros].fill(0.0);
                let samples = Samples::of(&cos, &sin).expect("an ellipse");
                assert_eq!(samples.outliers, zeros, "{offset}");
                let place = (cos[1900], sin[1900]);
                cos[..zeros].fill(place.0);
                sin[..zeros].fill(place.1);
                let samples = Samples::of(&cos, &sin).expect("an ellipse");
                assert_eq!(samples.outliers, 0, "{offset}");
            }
        }
    }

    #[test]
    fn a_long_standstill_does_not_push_the_rest_out() {
        let (mut cos, mut sin) = turning(2000, 3.0);
        // Nine tenths of the record at one angle, without any noise.
        let still = (cos[77], sin[77]);
        cos.extend(vec![still.0; 18_000]);
        sin.extend(vec![still.1; 18_000]);
        assert_eq!(Samples::of(&cos, &sin).expect("two channels").outliers, 0);
    }

    #[test]
    fn a_cloud_draws_no_ellipse() {
        use rand::{Rng, SeedableRng, rngs::StdRng};
        let mut random = StdRng::seed_from_u64(1);
        let mut cloud = || -> f64 { (0..12).map(|_| random.random_range(-0.5..0.5)).sum() };
        let (cos, sin): (Vec<f64>, Vec<f64>) = (0..4000).map(|_| (cloud(), cloud())).unzip();
        assert!(Samples::of(&cos, &sin).is_none());
    }
}
