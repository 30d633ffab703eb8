//! The time base: samples that are missing from it or doubled in it, whether its clock shows them or not.

use std::f64::consts::PI;

use nonius_quantity::{agree, counted};
use nonius_recording::Recording;

use crate::checks::jumps::jumps;
use crate::checks::late::late;
use crate::checks::{Checked, NINTH, TimeBase, ninth, repeats};
use crate::finding::{Cause, Finding, Parameter, Place};

/// Samples on either side whose slope tells how far the scale moves.
const LINE: usize = 8;
/// Samples over which steps are about as uneven.
const BLOCK: usize = 256;
/// Samples on either side whose steps are compared with the one behind a sample.
const NEAR: usize = 4;
/// Of so many samples not one has the codes of the one before where each that has is looked at.
const SELDOM: usize = 500;
/// A time from one sample to the next of more than so many usual ones is a gap.
pub(crate) const GAP: f64 = 1.5;
/// Repeated samples that chance may make of a recording.
pub(crate) const BY_CHANCE: f64 = 0.003;

/// The smallest step between two values of a channel, at least a code.
fn step(values: &[f64], lsb: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let steps = sorted.windows(2).map(|w| w[1] - w[0]);
    let smallest = steps.filter(|s| *s > 0.5 * lsb).fold(f64::MAX, f64::min);
    if smallest < f64::MAX { smallest } else { lsb }
}

/// Noise of a channel, rms, from its eighth differences: motion of ten samples per period and more hardly shows in them.
fn noise(values: &[f64]) -> f64 {
    const BINOMIAL: [f64; 9] = [1.0, -8.0, 28.0, -56.0, 70.0, -56.0, 28.0, -8.0, 1.0];
    let difference = |w: &[f64]| -> f64 { w.iter().zip(BINOMIAL).map(|(v, b)| v * b).sum() };
    let windows = values.windows(BINOMIAL.len());
    let mut sizes: Vec<f64> = windows.map(|w| difference(w).abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    let white: f64 = BINOMIAL.iter().map(|b| b * b).sum();
    median / 0.6745 / white.sqrt()
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

/// The middle one of each value and its two neighbours: a wild sample by itself is no motion.
fn without_spikes(values: &[f64]) -> Vec<f64> {
    let mut calm = values.to_vec();
    for (k, w) in values.windows(3).enumerate() {
        let (low, high) = (w[0].min(w[1]), w[0].max(w[1]));
        calm[k + 1] = w[2].clamp(low, high);
    }
    calm
}

/// How far the step to the next sample is off the slope about it, rms over √2, block by block: by noise, by an axis that
/// shakes, and by the bend of fast motion.
fn uneven(values: &[f64]) -> Vec<f64> {
    let range = LINE..values.len().saturating_sub(LINE);
    let off = range.map(|k| (values[k] - values[k - 1] - slope(values, k)).abs());
    let off: Vec<f64> = off.collect();
    let rms = |block: &[f64]| ninth(block) / NINTH / 2f64.sqrt();
    off.chunks(BLOCK).map(rms).collect()
}

/// A channel, and how its samples scatter; all in the unit of its values.
struct Channel<'a> {
    values: &'a [f64],
    /// See [`without_spikes`].
    calm: Vec<f64>,
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
        let chord = (self.calm[k + 1] - self.calm[k - 2]).abs() / 3.0 - self.noise;
        let block = (k - LINE) / BLOCK;
        let near = &self.uneven[block.saturating_sub(1)..(block + 2).min(self.uneven.len())];
        let uneven = near.iter().copied().fold(self.noise, f64::max);
        let along = slope(&self.calm, k).abs() - uneven / 4.0;
        let wide = self.noise.hypot(self.step);
        let far = (chord / wide).max(along / uneven.hypot(self.step)) / 2.0;
        let far = far.max(0.0);
        (self.step / (wide * (4.0 * PI).sqrt())).min(1.0) * (-far * far).exp()
    }
}

/// How often the reference repeats itself about a sample where the channels do not, if it repeats itself there: the more
/// seldom, the more it says. One that goes on says nothing.
fn repeats_alone(recording: &Recording) -> impl Fn(usize) -> f64 + use<> {
    /// Samples on either side.
    const ABOUT: usize = 2000;
    let n = recording.samples();
    let with_it: Vec<bool> = recording.reference_rad.as_deref().map_or(vec![], |r| {
        std::iter::once(false)
            .chain(r.windows(2).map(|w| w[0] == w[1]))
            .collect()
    });
    // How many are alone up to each sample.
    let mut alone = vec![0];
    for k in 0..n {
        let one = k > 0 && with_it.get(k) == Some(&true) && !repeats(recording, k);
        alone.push(alone[k] + usize::from(one));
    }
    move |k| {
        if with_it.get(k) != Some(&true) {
            return 1.0;
        }
        let (from, to) = (k.saturating_sub(ABOUT), (k + ABOUT).min(n));
        (alone[to] - alone[from] + 1) as f64 / (to - from + 1) as f64
    }
}

/// Samples that repeat the one before while the scale moves.
pub(crate) fn repeated(recording: &Recording, checked: &mut Checked) {
    let n = recording.samples();
    let same = |k: usize| repeats(recording, k);
    let adc = recording.metadata.adc;
    let channels = [(&recording.cos, adc.cos.lsb), (&recording.sin, adc.sin.lsb)];
    let channels = channels.map(|(v, lsb)| Channel {
        values: v,
        calm: without_spikes(v),
        step: step(v, lsb),
        noise: noise(v),
        uneven: uneven(v),
    });
    let of_reference = repeats_alone(recording);
    let chance = |k: usize| -> f64 {
        let of_channels: f64 = channels.iter().map(|c| c.chance(k)).product();
        of_channels * of_reference(k)
    };
    let alike: Vec<usize> = (LINE..n.saturating_sub(LINE))
        .filter(|&k| same(k) && !same(k - 1) && !same(k + 1))
        .collect();
    let seldom = |k: &usize| chance(*k) * (n as f64) < BY_CHANCE;
    let mut twins: Vec<usize> = alike.iter().copied().filter(seldom).collect();
    if twins.is_empty() && alike.len() * SELDOM < n {
        // On a slow axis with noise the codes alone say too little; that all that follows is late says more.
        twins = late(recording, checked, &alike);
    }
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
    checked.repeated.clone_from(&twins);
    let (count, first) = (twins.len(), twins[0]);
    let evidence = format!(
        "{} {} the one before while the scale moves{} sample {first}",
        counted(count, "sample"),
        agree(count, "repeats", "repeat"),
        agree(count, ":", "; the first is"),
    );
    let parameters = vec![Parameter::exact("count", count as f64, "samples")];
    let place = Place::Repeat {
        sample: first,
        inserted: !checked.extra.is_empty(),
    };
    let finding = Finding::digital(Cause::RepeatedSamples, parameters, evidence);
    checked.findings.push(finding.at(place).repairing(count));
}

/// Samples that are missing: where the clock shows a gap, and where the angle jumps by what it moves in whole samples.
pub(crate) fn dropped(recording: &Recording, checked: &mut Checked, time_base: TimeBase) {
    let (time, rate) = (&recording.time_s, recording.metadata.sample_rate_hz);
    let n = time.len();
    let gaps: Vec<(usize, f64)> = (1..n)
        .map(|k| (k, (time[k] - time[k - 1]) * rate))
        .filter(|g| g.1 > GAP)
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
    if gaps.is_empty() && time_base == TimeBase::Searched {
        gaps = jumps(recording, checked);
    }
    if gaps.is_empty() {
        return;
    }
    let lost: usize = gaps.iter().map(|g| g.1).sum();
    let (count, (first, missing)) = (gaps.len(), gaps[0]);
    let where_ = if in_time > 0 {
        format!("in {} of the time base", counted(count, "gap"))
    } else {
        format!(
            "at {} where the angle jumps by what it moves in whole samples",
            counted(count, "place")
        )
    };
    let evidence = format!(
        "{} {} missing {where_}{} before sample {first}",
        counted(lost, "sample"),
        agree(lost, "is", "are"),
        agree(count, ",", "; the first is"),
    );
    let parameters = vec![Parameter::exact("count", lost as f64, "samples")];
    let place = Place::Gap {
        sample: first,
        missing,
    };
    let mut finding = Finding::digital(Cause::DroppedSamples, parameters, evidence).at(place);
    // A long pause is no loss of samples that anything could bridge.
    if lost < n / 10 {
        checked.gaps = gaps;
        finding = finding.repairing(lost);
    }
    checked.findings.push(finding);
}
