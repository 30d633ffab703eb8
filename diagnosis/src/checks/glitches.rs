//! Glitches: isolated samples far from what their neighbours say.

use nonius_quantity::{agree, counted};
use nonius_recording::Recording;
use statrs::distribution::{ContinuousCDF, Normal};

use crate::checks::edges::{Edges, edges};
use crate::checks::sides::{column, powers};
use crate::checks::timebase::GAP;
use crate::checks::turning::Turning;
use crate::checks::{Checked, NINTH, magnitudes, ninth, repeats};
use crate::finding::units;
use crate::finding::{Cause, Finding, Parameter, Place};
use crate::numerics::correlate::sums;
use crate::numerics::ends::ends;
use crate::numerics::solve::{weights_of, without};

/// Samples on either side of the curve through the neighbours.
const REACH: usize = 3;
/// The same of a longer curve.
const MORE: usize = 10;
/// How often noise may have a sample that is far off, by recordings.
const FAR_BY_CHANCE: f64 = 1e-5;
/// Ranges of values in each of which noise may have a size of its own.
const RANGES: usize = 16;
/// Samples on either side that tell how large the noise is just there.
const AROUND: usize = 100;
/// So many times larger the ninth decile of so few may be by chance: two standard deviations.
const BY_CHANCE: f64 = 1.2;

/// So many times the ninth decile of Gaussian noise is far off among so many samples of two channels: 6.3 standard deviations of
/// 20 000, 6.9 of a million.
pub(crate) fn far_among(samples: usize) -> f64 {
    let on_one_side = FAR_BY_CHANCE / (2 * 2 * samples.max(1)) as f64;
    -Normal::standard().inverse_cdf(on_one_side) / NINTH
}

/// How far a sample is off the fifth-order curve through its three neighbours on either side: motion leaves the sixth power
/// of its share of a period per sample.
fn off_the_curve(values: &[f64], k: usize) -> f64 {
    if k < REACH || k + REACH >= values.len() {
        return 0.0;
    }
    let both = |j: usize| values[k - j] + values[k + j];
    values[k] - (15.0 * both(1) - 6.0 * both(2) + both(3)) / 20.0
}

/// A function of the place among a sample and `side` neighbours on either side.
fn around(side: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    column(2 * side + 1, f)
}

/// The functions of a fifth-order curve through them.
fn curve(side: usize) -> Vec<Vec<f64>> {
    powers(2 * side + 1, 5)
}

/// What belongs to the samples that have so many neighbours on either side.
fn with_neighbours(values: &[f64], reach: usize) -> &[f64] {
    values
        .get(reach..values.len().saturating_sub(reach))
        .unwrap_or_default()
}

/// How far each sample of a channel is off a fifth-order curve through more of its neighbours: on axes that are slow beside the
/// noise that leaves less, for the curve through three on either side has more noise itself than the sample.
fn off_the_longer_curve(values: &[f64]) -> Vec<f64> {
    let weights = weights_of(&around(MORE, |x| f64::from(x == 0.0)), &curve(MORE));
    let mut long = vec![0.0; MORE.min(values.len())];
    long.extend(sums(values, &weights));
    long.resize(values.len(), 0.0);
    long
}

/// Where the neighbours say that each sample is.
fn expected(values: &[f64], off: &[f64]) -> Vec<f64> {
    values.iter().zip(off).map(|(v, o)| v - o).collect()
}

/// How large that is, where there are so many neighbours on either side: the ninth decile.
fn typical(off: &[f64], reach: usize) -> f64 {
    ninth(&magnitudes(with_neighbours(off, reach)))
}

/// Whether a sample is far out of the noise near it along the radius and along the circle, which may be of different sizes: a
/// jitter of the clock moves both channels along the circle.
fn out_of_either(
    off: &[Vec<f64>; 2],
    reach: usize,
    angle: impl Fn(usize) -> [f64; 2],
    k: usize,
) -> bool {
    /// The ninth decile of so few samples is known to a tenth.
    const SURELY: f64 = 1.1;
    let parts = |j: usize| {
        let [c, s] = angle(j);
        [off[0][j] * c + off[1][j] * s, off[1][j] * c - off[0][j] * s]
    };
    let near = k.saturating_sub(AROUND).max(reach)..(k + AROUND + 1).min(off[0].len() - reach);
    let near: Vec<[f64; 2]> = near.map(parts).collect();
    let far = |which: usize| {
        let sizes: Vec<f64> = near.iter().map(|p| p[which].abs()).collect();
        parts(k)[which] / ninth(&sizes)
    };
    far(0).hypot(far(1)) > SURELY * far_among(off[0].len())
}

/// Whether what stands out at a sample is that sample, and no step of the signal before or after it: a code that the ADC
/// gets wrong, or a time base that jumps, which either channel shows. The next sample may ring.
fn isolated(off: &[Vec<f64>; 2], turning: Option<&Turning>, which: usize, k: usize) -> bool {
    /// What one sample does to the ones around it, and what a step does.
    const ONE: [f64; 7] = [-1.0, 6.0, -15.0, 20.0, -15.0, 6.0, -1.0];
    const STEP: [f64; 6] = [-1.0, 5.0, -10.0, 10.0, -5.0, 1.0];
    /// A step looks like one sample by 0.917; one whose next rings back by four tenths is as much like either.
    const AS_MUCH: f64 = 0.96;
    let turning = turning.filter(|turning| turning.is_fast(k));
    let seen = |j: usize| {
        let there = [off[0][j], off[1][j]];
        turning.map_or(there, |turning| turning.seen_from(k, j, there))
    };
    let near: Vec<[f64; 2]> = (k - REACH..=k + REACH).map(seen).collect();
    let size = |i: usize| near[i][which].abs();
    if size(REACH) < size(REACH - 1).max(size(REACH + 1)) {
        return false;
    }
    // The share of the square that a pattern holds.
    let like = |pattern: &[f64], from: usize| {
        let along = |channel: usize| -> f64 {
            let pairs = pattern.iter().zip(near.iter().skip(from));
            pairs.map(|(p, o)| p * o[channel]).sum()
        };
        let squares = along(0).powi(2) + along(1).powi(2);
        squares / pattern.iter().map(|p| p * p).sum::<f64>()
    };
    let one = like(&ONE, 0);
    let step = like(&STEP, 0).max(like(&STEP, 1));
    one > AS_MUCH * step
}

/// What a step of both channels before or after a sample, or a corner, leaves there, over what is left if the sample is off: of a
/// jump of the time base, or a step of the speed, the samples farther away tell.
fn step_over_one(recording: &Recording, turning: Option<&Turning>, k: usize) -> f64 {
    /// Samples on either side.
    const SIDE: usize = 8;
    if k < SIDE || k + SIDE >= recording.samples() {
        return 1.0;
    }
    let near = match turning.filter(|turning| turning.is_fast(k)) {
        Some(turning) => turning.around(k, SIDE),
        None => [&recording.cos, &recording.sin].map(|v| v[k - SIDE..=k + SIDE].to_vec()),
    };
    let left = |f: &dyn Fn(f64) -> f64| -> f64 {
        let shapes = [curve(SIDE), vec![around(SIDE, f)]].concat();
        let rest = near.each_ref().map(|v| without(v, &shapes));
        rest.iter().flatten().map(|r| r * r).sum()
    };
    let one = left(&|x| f64::from(x == 0.0));
    let step = left(&|x| f64::from(x >= 0.0)).min(left(&|x| f64::from(x > 0.0)));
    // A drive that is faster at once bends both.
    let sample = 1.0 / SIDE as f64;
    let corners = [-0.5, 0.0, 0.5].map(|at| left(&|x| (x - at * sample).max(0.0)));
    let corner = corners.into_iter().fold(f64::MAX, f64::min);
    step.min(corner) / one
}

/// How far each sample of either channel is off the curve through its neighbours; where the scale turns fast, as seen by somebody who
/// turns with it.
fn off_both(channels: &[Vec<f64>; 2], turning: Option<&Turning>) -> [Vec<f64>; 2] {
    let n = channels[0].len();
    let mut off = [0, 1].map(|which: usize| {
        let off = (0..n).map(|k| off_the_curve(&channels[which], k));
        off.collect::<Vec<f64>>()
    });
    let Some(turning) = turning else {
        return off;
    };
    for k in (REACH..n.saturating_sub(REACH)).filter(|k| turning.is_fast(*k)) {
        let near = turning.around(k, REACH);
        [off[0][k], off[1][k]] = near.map(|near| off_the_curve(&near, REACH));
    }
    off
}

/// What a channel's own codes leave of any curve, in the unit of the columns: what is no farther off is no glitch.
pub(crate) fn floors(recording: &Recording) -> [f64; 2] {
    let adc = recording.metadata.adc;
    [adc.cos, adc.sin].map(|adc| 6.0 * adc.lsb)
}

/// How far samples are off curves through so many neighbours on either side.
struct Curve<'a> {
    off: &'a [f64],
    reach: usize,
    /// How far codes are off it.
    floor: f64,
}

impl Curve<'_> {
    /// Samples of a channel that are farther off than noise is there, and how far.
    fn far_off(&self, values: &[f64], recording: &Recording, weight: &[f64]) -> Vec<(usize, f64)> {
        let (n, reach, floor) = (values.len(), self.reach, self.floor);
        let rate = recording.metadata.sample_rate_hz;
        let sizes = magnitudes(self.off);
        let typical = typical(self.off, reach);
        let far_off = far_among(n);
        // A glitch beyond the others would be alone in its range, and typical there.
        let expected = expected(values, self.off);
        let [low, high] = ends(expected.iter().copied());
        let range = |v: f64| (((v - low) / (high - low) * RANGES as f64) as usize).min(RANGES - 1);
        let mut alike: Vec<Vec<f64>> = vec![vec![]; RANGES];
        for (v, size) in expected.iter().zip(&sizes) {
            alike[range(*v)].push(*size);
        }
        let alike: Vec<f64> = alike.iter().map(|a| ninth(a) / typical).collect();
        let far = |k: &usize| {
            let k = *k;
            // Most samples need no look at their surroundings.
            if sizes[k] <= (far_off * typical).max(floor) {
                return false;
            }
            // Noise that grows with the signal, its slope or the speed is larger at some values and times than at others.
            let near = &sizes[k.saturating_sub(AROUND)..(k + AROUND + 1).min(n)];
            let there = (ninth(near) / typical / BY_CHANCE).max(1.0);
            let larger = there * alike[range(expected[k])].max(1.0);
            let limit = (far_off * typical * larger).max(floor);
            // A doubled sample is late, not wrong; a longer curve is bent by any that are wrong beside it.
            let beside = if reach > REACH { reach } else { 1 };
            let bad = (k - beside..=k + beside).any(|near| weight[near] == 0.0);
            let doubled = bad || repeats(recording, k) || repeats(recording, k + 1);
            // Across a gap in time there is no such curve.
            let step = |j: usize| recording.time_s[j] - recording.time_s[j - 1];
            let gap = (k + 1 - reach..=k + reach).any(|j| step(j) * rate > GAP);
            sizes[k] > limit && !doubled && !gap
        };
        let inside = reach..n.saturating_sub(reach);
        inside.filter(far).map(|k| (k, sizes[k])).collect()
    }
}

/// Isolated samples far from what their neighbours say.
pub(crate) fn find(recording: &Recording, checked: &mut Checked) {
    /// Share of what is left beside a sample that is off, below which a step is there instead.
    const CLEARLY: f64 = 0.7;
    /// The same where only the longer curve shows it.
    const SURELY: f64 = 1.5;
    let n = recording.samples();
    let Edges {
        channels,
        far: mut found,
    } = edges(recording);
    let ellipse = checked.ellipse(recording);
    let turning = ellipse.map(|e| Turning::new(&channels, e));
    let turning = turning.as_ref();
    let off = off_both(&channels, turning);
    let longer = [0, 1].map(|which: usize| off_the_longer_curve(&channels[which]));
    let middles = [0, 1].map(|which: usize| {
        // A glitch may be beyond all others.
        let [low, high] = ends(expected(&channels[which], &off[which]));
        [0.5 * (low + high), 0.5 * (high - low)]
    });
    let angle = |k: usize| {
        let pair = [0, 1].map(|c: usize| (channels[c][k] - middles[c][0]) / middles[c][1]);
        let radius = pair[0].hypot(pair[1]).max(f64::MIN_POSITIVE);
        pair.map(|p| p / radius)
    };
    let floors = floors(recording);
    for (which, values) in channels.iter().enumerate() {
        let short = Curve {
            off: &off[which],
            reach: REACH,
            floor: floors[which],
        };
        let mut own = short.far_off(values, recording, &checked.weight);
        own.retain(|(k, _)| {
            isolated(&off, turning, which, *k) && step_over_one(recording, turning, *k) >= CLEARLY
        });
        own.retain(|(k, _)| out_of_either(&off, REACH, angle, *k));
        if typical(&longer[which], MORE) < typical(&off[which], MORE) {
            let long = Curve {
                off: &longer[which],
                reach: MORE,
                floor: floors[which],
            };
            let mut more = long.far_off(values, recording, &checked.weight);
            // Such a one is hardly a pattern on the short curve; and what is far off itself bends the long one near it.
            let size = |k: usize| longer[which][k].abs();
            let highest = |k: usize| size(k) >= size(k - 1).max(size(k + 1));
            let near = |k: usize| own.iter().any(|(known, _)| k.abs_diff(*known) <= MORE);
            more.retain(|(k, _)| {
                highest(*k) && !near(*k) && step_over_one(recording, None, *k) > SURELY
            });
            more.retain(|(k, _)| out_of_either(&longer, MORE, angle, *k));
            own.extend(more);
        }
        found.extend(own);
    }
    found.sort_by_key(|f| f.0);
    found.dedup_by_key(|f| f.0);
    // Many of them are no isolated samples.
    if found.is_empty() || found.len() > n / 50 {
        return;
    }
    let mut left_out = 0;
    for (k, _) in &found {
        for near in k.saturating_sub(1)..=(k + 1).min(n - 1) {
            left_out += usize::from(checked.weight[near] > 0.0);
            checked.weight[near] = 0.0;
        }
    }
    let largest = found.iter().map(|f| f.1).fold(0.0, f64::max);
    let largest = Parameter::exact("largest", largest, units::of_columns(recording));
    let share = found.len() as f64 / n as f64;
    let error = (found.len() as f64).sqrt() / n as f64;
    let n = found.len();
    let evidence = format!(
        "{} {} from the curve through {} neighbours by up to {}; {} sample {}",
        counted(n, "isolated sample"),
        agree(n, "deviates", "deviate"),
        agree(n, "its", "their"),
        match largest.unit.as_str() {
            "counts" => largest.brief(),
            _ => format!("{:.4} (unit of the columns)", largest.value),
        },
        agree(n, "it is", "the first is"),
        found[0].0
    );
    let parameters = vec![Parameter::measured("share", share, error, "1"), largest];
    let finding = Finding::digital(Cause::Glitches, parameters, evidence);
    let finding = finding.at(Place::Sample(found[0].0)).repairing(left_out);
    checked.findings.push(finding);
}

#[cfg(test)]
mod tests {
    use super::{NINTH, far_among};

    #[test]
    fn noise_of_a_longer_recording_has_larger_samples() {
        // The standard deviations that a table of the normal distribution gives for 1.25e-10 and 2.5e-12 on one side.
        for (samples, deviations) in [(20_000, 6.327), (1_000_000, 6.906)] {
            let far = far_among(samples) * NINTH;
            assert!((far - deviations).abs() < 0.002, "{samples} {far}");
        }
    }
}
