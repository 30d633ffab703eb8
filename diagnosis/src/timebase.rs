//! The time base: samples that are missing from it or doubled in it, whether its clock shows them or not.

use std::f64::consts::PI;

use nonius_calibration::{Method, Options, calibrate};
use nonius_recording::Recording;

use crate::checks::{Checked, ninth};
use crate::context::unwrapped;
use crate::finding::{Finding, Parameter, Place};

/// Samples on either side of a jump that are compared, and the order of the curve through them; on slow axes more of them
/// show it.
const SIDES: [(usize, i32); 4] = [(8, 3), (24, 3), (64, 5), (200, 5)];
/// So many times the ninth decile of what the curve leaves is a jump: eight standard deviations.
const FAR: f64 = 4.9;
/// A jump is so near a whole number of samples, beside what noise makes of it.
const WHOLE: f64 = 0.15;
/// Most samples lost at one place that are believed without a clock.
const MOST: f64 = 32.0;
/// So many times the samples on a side, to either side, tell how large the noise is just there.
const AROUND: usize = 8;
/// Most samples that the ellipse is fitted to.
const ENOUGH: usize = 8192;

/// Samples on either side whose slope tells how far the scale moves.
const LINE: usize = 8;
/// Samples over which steps are about as uneven.
const BLOCK: usize = 256;
/// Samples on either side whose steps are compared with the one behind a sample.
const NEAR: usize = 4;
/// Repeated samples that chance may make of a recording.
const BY_CHANCE: f64 = 0.01;

/// The smallest step between two values of a channel, at least a code.
fn step(values: &[f64], lsb: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let steps = sorted.windows(2).map(|w| w[1] - w[0]);
    let smallest = steps.filter(|s| *s > 0.5 * lsb).fold(f64::MAX, f64::min);
    if smallest < f64::MAX { smallest } else { lsb }
}

/// Noise of a channel, rms, from its third differences: motion hardly shows in them.
fn noise(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values
        .windows(4)
        .map(|w| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs())
        .collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    median / 0.6745 / 20f64.sqrt()
}

/// How fast a channel changes about sample `k`, per sample, whether that sample was put in or not: the middle of the slopes
/// of straight lines through the samples before it and from it on.
fn slope(values: &[f64], k: usize) -> f64 {
    let line = |values: &[f64]| -> f64 {
        let middle = (values.len() - 1) as f64 / 2.0;
        let along = |(i, v): (usize, &f64)| (i as f64 - middle) * v;
        let square: f64 = (0..values.len()).map(|i| (i as f64 - middle).powi(2)).sum();
        values.iter().enumerate().map(along).sum::<f64>() / square
    };
    (line(&values[k - LINE..k]) + line(&values[k..k + LINE])) / 2.0
}

/// How far the step to the next sample is off the slope about it, rms over √2, block by block: by noise, by an axis that
/// shakes, and by the bend of fast motion.
fn uneven(values: &[f64]) -> Vec<f64> {
    let range = LINE..values.len().saturating_sub(LINE);
    let off = range.map(|k| (values[k] - values[k - 1] - slope(values, k)).abs());
    let off: Vec<f64> = off.collect();
    let rms = |block: &[f64]| ninth(block) / 1.645 / 2f64.sqrt();
    off.chunks(BLOCK).map(rms).collect()
}

/// A channel, and how its samples scatter; all in the unit of its values.
struct Channel<'a> {
    values: &'a [f64],
    /// The smallest step between two values.
    step: f64,
    /// Of each sample by itself, rms.
    noise: f64,
    /// See [`uneven`].
    uneven: Vec<f64>,
}

impl Channel<'_> {
    /// How likely chance takes the channel back to the code before at a sample, over what the scale moves: a Gaussian of both
    /// samples' noise, no narrower than a step. Less than by its own noise below what the samples next to it or the slopes
    /// on either side say, it moves hardly ever.
    fn chance(&self, k: usize) -> f64 {
        let chord = (self.values[k + 1] - self.values[k - 2]).abs() / 3.0 - self.noise;
        let block = (k - LINE) / BLOCK;
        let near = &self.uneven[block.saturating_sub(1)..(block + 2).min(self.uneven.len())];
        let uneven = near.iter().copied().fold(self.noise, f64::max);
        let along = slope(self.values, k).abs() - uneven / 4.0;
        let wide = self.noise.hypot(self.step);
        let far = (chord / wide).max(along / uneven.hypot(self.step)) / 2.0;
        let far = far.max(0.0);
        (self.step / (wide * (4.0 * PI).sqrt())).min(1.0) * (-far * far).exp()
    }
}

/// Samples that repeat the one before while the scale moves.
pub(crate) fn repeated(recording: &Recording, checked: &mut Checked) {
    let n = recording.samples();
    let same = |k: usize| {
        recording.cos[k] == recording.cos[k - 1] && recording.sin[k] == recording.sin[k - 1]
    };
    let adc = recording.metadata.adc;
    let channels = [(&recording.cos, adc.cos.lsb), (&recording.sin, adc.sin.lsb)];
    let channels = channels.map(|(v, lsb)| Channel {
        values: v,
        step: step(v, lsb),
        noise: noise(v),
        uneven: uneven(v),
    });
    let chance = |k: usize| -> f64 { channels.iter().map(|c| c.chance(k)).product() };
    let twins: Vec<usize> = (LINE..n.saturating_sub(LINE))
        .filter(|&k| same(k) && !same(k - 1) && !same(k + 1))
        .filter(|&k| chance(k) * (n as f64) < BY_CHANCE)
        .collect();
    if twins.is_empty() || twins.len() >= n / 10 {
        return;
    }
    for &k in &twins {
        checked.weight[k] = 0.0;
    }
    // A sample that was put in makes all others late; one that stands in another's place does not, and the way to the next
    // is twice as long. Whatever puts them in does so every time.
    let square = |k: usize| {
        let way = |c: &Channel| (c.values[k + 1] - c.values[k]).powi(2);
        channels.iter().map(way).sum::<f64>()
    };
    let noisy: f64 = channels.iter().map(|c| 2.0 * c.noise.powi(2)).sum();
    let (mut next, mut usual) = (0.0, 0.0);
    for &k in &twins {
        next += square(k) - noisy;
        let near = (k - NEAR..k - 1).chain(k + 1..k + NEAR);
        usual += near.clone().map(square).sum::<f64>() / near.count() as f64 - noisy;
    }
    if next < 1.5f64.powi(2) * usual {
        checked.extra.clone_from(&twins);
    }
    checked.findings.push(
        Finding::digital(
            "repeated_samples",
            vec![Parameter::exact("count", twins.len() as f64, "samples")],
            format!(
                "{} samples repeat the one before while the scale moves; the first is sample {}",
                twins.len(),
                twins[0]
            ),
        )
        .at(Place::Sample(twins[0])),
    );
}

/// Samples that are missing: where the clock shows a gap, and where the angle jumps by what it moves in whole samples.
pub(crate) fn dropped(recording: &Recording, checked: &mut Checked) {
    let (time, rate) = (&recording.time_s, recording.metadata.sample_rate_hz);
    let n = time.len();
    let gaps: Vec<(usize, f64)> = (1..n)
        .map(|k| (k, (time[k] - time[k - 1]) * rate))
        .filter(|g| g.1 > 1.5)
        .collect();
    // More than a few gaps of odd lengths are a time base that is not regular.
    let whole = gaps
        .iter()
        .filter(|g| (g.1 - g.1.round()).abs() < 0.2)
        .count();
    if whole * 10 < gaps.len() * 9 || gaps.len() > n / 20 + 1 {
        return;
    }
    let in_time = gaps.len();
    let mut gaps: Vec<(usize, usize)> = gaps
        .iter()
        .map(|g| (g.0, g.1.round() as usize - 1))
        .collect();
    if gaps.is_empty() {
        gaps = jumps(recording, checked);
    }
    if gaps.is_empty() {
        return;
    }
    let lost: usize = gaps.iter().map(|g| g.1).sum();
    let (count, first) = (gaps.len(), gaps[0].0);
    let seen = if in_time > 0 {
        format!(
            "{lost} samples are missing in {count} gaps of the time base; the first gap is before sample {first}"
        )
    } else {
        format!(
            "{lost} samples are missing at {count} places, where the angle jumps by what it moves in whole samples; the first is before sample {first}"
        )
    };
    checked.findings.push(
        Finding::digital(
            "dropped_samples",
            vec![Parameter::exact("count", lost as f64, "samples")],
            seen,
        )
        .at(Place::Sample(first)),
    );
    // A long pause is no loss of samples that anything could bridge.
    if lost < n / 10 {
        checked.gaps = gaps;
    }
}

/// What a step between two samples in the middle adds to a curve of that order through `side` samples on either side: the
/// weights of the samples that give its size, free of that curve.
fn step_weights(side: usize, order: i32) -> Vec<f64> {
    let middle = side as f64 - 0.5;
    let column = |f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        (0..2 * side)
            .map(|i| f((i as f64 - middle) / middle))
            .collect()
    };
    let curve: Vec<Vec<f64>> = (0..=order)
        .map(|degree| column(&|x| x.powi(degree)))
        .collect();
    let step = column(&|x| 0.5 * x.signum());
    let free = crate::solve::without(&step, &curve);
    let square: f64 = free.iter().map(|v| v * v).sum();
    free.iter().map(|v| v / square).collect()
}

/// Lays straight lines over samples that do not count.
fn bridge(values: &mut [f64], weight: &[f64]) {
    let mut last = 0;
    for (k, weight) in weight.iter().enumerate().skip(1) {
        if *weight == 0.0 {
            continue;
        }
        let (from, by) = (values[last], values[k] - values[last]);
        for (i, value) in values[last + 1..k].iter_mut().enumerate() {
            *value = from + by * (i + 1) as f64 / (k - last) as f64;
        }
        last = k;
    }
}

/// Places where the angle jumps by what it moves in whole samples: before which sample, how many are missing.
fn jumps(recording: &Recording, checked: &Checked) -> Vec<(usize, usize)> {
    let n = recording.samples();
    let every = n.div_ceil(ENOUGH).max(1);
    let kept = |values: &[f64]| -> Vec<f64> { values.iter().copied().step_by(every).collect() };
    let (cos, sin) = (kept(&recording.cos), kept(&recording.sin));
    let Ok(fit) = calibrate(&cos, &sin, Method::Unbiased, &Options::default()) else {
        return vec![];
    };
    let pairs = recording.cos.iter().zip(&recording.sin);
    let angle = pairs.map(|(c, s)| {
        let (c, s) = fit.ellipse.corrected(*c, *s);
        s.atan2(c)
    });
    let mut angle = unwrapped(angle.collect());
    bridge(&mut angle, &checked.weight);
    let mut found: Vec<(usize, usize)> = vec![];
    for (side, order) in SIDES {
        if n < 32 * side {
            break;
        }
        let weights = step_weights(side, order);
        let size = |k: usize| -> f64 {
            let near = &angle[k - side..k + side];
            near.iter().zip(&weights).map(|(a, w)| a * w).sum()
        };
        let sizes: Vec<f64> = (0..n)
            .map(|k| {
                if k < side || k + side > n {
                    0.0
                } else {
                    size(k)
                }
            })
            .collect();
        let plain: Vec<f64> = sizes.iter().map(|s| s.abs()).collect();
        let typical = ninth(&plain);
        let mut far = vec![];
        for k in side..=n - side {
            if plain[k] < FAR * typical {
                continue;
            }
            // A jump shows itself on either side of it.
            let before = &plain[k.saturating_sub(AROUND * side)..k - side];
            let after = &plain[(k + side).min(n)..(k + AROUND * side).min(n)];
            let noise = typical.max(ninth(before)).max(ninth(after));
            let near = &plain[k - side / 2..(k + side / 2 + 1).min(n)];
            let highest = near.iter().all(|p| *p <= plain[k]);
            if plain[k] > FAR * noise && highest {
                far.push((k, noise / 1.645));
            }
        }
        let mut whole = vec![];
        let mut others = 0;
        for (k, sigma) in far {
            // Whether a sample nearby does not count, or was found already.
            let known = |j: usize| k.abs_diff(j) <= side;
            let bad = (k - 2..k + 2).any(|j| checked.weight[j] == 0.0);
            let bad = bad || checked.extra.iter().any(|j| known(*j));
            if bad || found.iter().any(|f| known(f.0)) {
                continue;
            }
            let moves = (angle[k + side - 1] - angle[k - side] - sizes[k]) / (2 * side - 1) as f64;
            let samples = sizes[k] / moves;
            let error = sigma / moves.abs();
            let off = (samples - samples.round()).abs();
            if samples > 0.5 && samples < MOST && error < 0.15 && off < WHOLE + 3.0 * error {
                whole.push((k, samples.round() as usize));
            } else {
                others += 1;
            }
        }
        // Where the angle jumps by anything, a whole number is chance.
        if whole.len() > 4 * others {
            found.extend(whole);
        }
    }
    found.sort_unstable();
    found
}
