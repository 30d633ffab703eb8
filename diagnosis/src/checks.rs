//! Digital checks on the codes and the time base, before anything is fitted.

use nonius_quantity::{agree, counted};
use nonius_recording::Recording;

use crate::edges::{Edges, edges};
use crate::finding::{Finding, Parameter, Place};
use crate::missing;
use crate::rail;
use crate::timebase;
use crate::units;

/// What the checks found, and which samples do not count.
pub(crate) struct Checked {
    pub(crate) findings: Vec<Finding>,
    /// 1 or 0 per sample.
    pub(crate) weight: Vec<f64>,
    /// Samples that are missing before a sample of the recording: index, how many.
    pub(crate) gaps: Vec<(usize, usize)>,
    /// Samples that were put in: what follows is late by one each.
    pub(crate) extra: Vec<usize>,
}

const CHANNELS: [&str; 2] = ["cos", "sin"];

/// Checks a recording; `weight` is 0 for samples that are known to hold no signal.
pub(crate) fn check(recording: &Recording, weight: Vec<f64>) -> Checked {
    let mut checked = Checked {
        findings: vec![],
        weight,
        gaps: vec![],
        extra: vec![],
    };
    timebase::repeated(recording, &mut checked);
    glitches(recording, &mut checked);
    let clipped = rail::rails(recording, &mut checked.weight);
    checked.findings.extend(clipped);
    // A sample that is wrong holds any code.
    let weight = &checked.weight;
    let sound = || recording.codes().zip(weight).filter(|(_, w)| **w > 0.0);
    let codes: (Vec<i64>, Vec<i64>) = sound().map(|(codes, _)| codes).unzip();
    let mut digital = vec![];
    let adc = recording.metadata.adc;
    let described = adc.cos.source == nonius_recording::AdcSource::Described;
    for (name, codes, bits) in [
        (CHANNELS[0], &codes.0, adc.cos.bits),
        (CHANNELS[1], &codes.1, adc.sin.bits),
    ] {
        if described {
            let channel = usize::from(name == CHANNELS[1]);
            let of_channel = |f: Finding| {
                let largest = f.parameters.first().map_or(0.0, |p| p.value);
                let step = if f.cause == "stuck_bit" {
                    2f64.powf(largest + 1.0)
                } else {
                    largest
                };
                f.at(Place::Code {
                    channel,
                    step: step as i64,
                })
            };
            let found = bits_and_steps(name, codes, bits);
            // Where codes lie on a grid, those between are missing.
            let missing = if found.is_empty() {
                missing::codes(codes)
            } else {
                vec![]
            };
            digital.extend(found.into_iter().map(of_channel));
            if !missing.is_empty() {
                digital.push(missing::finding(name, channel, &missing));
            }
        }
    }
    checked.findings.splice(..0, digital);
    timebase::dropped(recording, &mut checked);
    checked
}

/// Fewest codes that tell a step between all of them.
const FEWEST: usize = 8;

/// The greatest common divisor.
fn divisor(mut a: i64, mut b: i64) -> i64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The steps that codes lie apart, few of them left out: a sample that is wrong by a little holds any code. The sorted codes
/// without repetition; empty where nothing is to be told.
fn on_a_grid(codes: &[i64]) -> (i64, Vec<i64>) {
    /// Share of samples that may lie elsewhere.
    const ELSEWHERE: f64 = 1e-3;
    let distinct = |mut codes: Vec<i64>| {
        codes.sort_unstable();
        codes.dedup();
        codes
    };
    let steps = |d: &[i64]| d.windows(2).fold(0, |g, w| divisor(g, w[1] - w[0]));
    let all = distinct(codes.to_vec());
    let step = steps(&all);
    let mut apart: Vec<i64> = all.windows(2).map(|w| w[1] - w[0]).collect();
    if step > 1 || apart.is_empty() {
        return (step, all);
    }
    let middle = apart.len() / 2;
    let usual = *apart.select_nth_unstable(middle).1;
    // Between two steps of codes, those few that are wrong hold one.
    if usual < 4 {
        return (step, all);
    }
    let mut places: Vec<i64> = codes.iter().map(|c| c.rem_euclid(usual)).collect();
    let middle = places.len() / 2;
    let place = *places.select_nth_unstable(middle).1;
    let on: Vec<i64> = (codes.iter().copied())
        .filter(|c| c.rem_euclid(usual) == place)
        .collect();
    if (codes.len() - on.len()) as f64 > ELSEWHERE * codes.len() as f64 {
        return (step, all);
    }
    let on = distinct(on);
    (steps(&on), on)
}

/// Bits that never change while the codes sweep; steps of several codes.
fn bits_and_steps(channel: &str, codes: &[i64], bits: u32) -> Vec<Finding> {
    let (step, distinct) = on_a_grid(codes);
    let (Some(low), Some(high)) = (distinct.first(), distinct.last()) else {
        return vec![];
    };
    let span = high - low;
    if span < 16 {
        return vec![];
    }
    let mut found = vec![];
    let offset = 1i64 << (bits - 1);
    let constant: Vec<u32> = (0..bits)
        .filter(|bit| (2i64 << bit) <= span / 2)
        .filter(|bit| {
            let mut ones = distinct.iter().map(|c| (c + offset) >> bit & 1);
            let first = ones.next();
            ones.all(|b| Some(b) == first)
        })
        .collect();
    let lowest: Vec<u32> = (0..bits).take_while(|b| constant.contains(b)).collect();
    // All codes lie a whole number of steps apart: the steps are coarse, or one last bit is stuck.
    if distinct.len() >= FEWEST && step > 1 {
        let bit = step == 2 && lowest.len() == 1;
        found.push(Finding::digital(
            if bit {
                "stuck_bit"
            } else {
                "coarse_quantisation"
            },
            vec![if bit {
                Parameter::exact("bit", 0.0, "1")
            } else {
                Parameter::exact("step_lsb", step as f64, "LSB")
            }],
            if bit {
                format!("the last bit of the {channel} channel never changes while its codes sweep over {span}")
            } else {
                format!("the {channel} channel moves in steps of {step} codes while its codes sweep over {span}")
            },
        ));
    }
    if let Some(stuck) = constant.iter().find(|b| !lowest.contains(b)) {
        found.push(Finding::digital(
            "stuck_bit",
            vec![Parameter::exact("bit", f64::from(*stuck), "1")],
            format!(
                "bit {stuck} of the {channel} channel never changes while its codes sweep over {span}"
            ),
        ));
    }
    found
}

/// Samples on either side of the curve through the neighbours.
const REACH: usize = 3;
/// So many times the ninth decile is far off: six standard deviations of Gaussian noise, which not one sample in 10⁸ is.
pub(crate) const FAR: f64 = 3.65;
/// Ranges of values in each of which noise may have a size of its own.
const RANGES: usize = 16;
/// Samples on either side that tell how large the noise is just there.
const AROUND: usize = 100;
/// So many times larger the ninth decile of so few may be by chance: two standard deviations.
const BY_CHANCE: f64 = 1.2;

/// How far a sample is off the fifth-order curve through its three neighbours on either side: motion leaves the sixth power
/// of its share of a period per sample.
fn off_the_curve(values: &[f64], k: usize) -> f64 {
    if k < REACH || k + REACH >= values.len() {
        return 0.0;
    }
    let both = |j: usize| values[k - j] + values[k + j];
    values[k] - (15.0 * both(1) - 6.0 * both(2) + both(3)) / 20.0
}

/// Whether what stands out at a sample is that sample, and no step of the signal before or after it: a code that the ADC
/// gets wrong, or a time base that jumps, which either channel shows. The next sample may ring.
fn isolated(channels: &[Vec<f64>; 2], which: usize, k: usize) -> bool {
    /// What one sample does to the ones around it, and what a step does.
    const ONE: [f64; 7] = [-1.0, 6.0, -15.0, 20.0, -15.0, 6.0, -1.0];
    const STEP: [f64; 6] = [-1.0, 5.0, -10.0, 10.0, -5.0, 1.0];
    /// A step looks like one sample by 0.917; one whose next rings back by four tenths is as much like either.
    const AS_MUCH: f64 = 0.96;
    let off = &channels[which];
    if off[k].abs() < off[k - 1].abs().max(off[k + 1].abs()) {
        return false;
    }
    // The share of the square that a pattern holds.
    let like = |pattern: &[f64], from: usize| {
        let along = |off: &Vec<f64>| -> f64 {
            let pairs = pattern.iter().zip(off.iter().skip(from));
            pairs.map(|(p, o)| p * o).sum()
        };
        let squares = channels.iter().map(|off| along(off).powi(2));
        squares.sum::<f64>() / pattern.iter().map(|p| p * p).sum::<f64>()
    };
    let one = like(&ONE, k - REACH);
    let step = like(&STEP, k - REACH).max(like(&STEP, k + 1 - REACH));
    one > AS_MUCH * step
}

/// Whether a step of both channels before or after a sample, or a corner, explains clearly more than that the sample is off: of
/// a jump of the time base, or a step of the speed, the samples farther away tell.
fn steps(recording: &Recording, k: usize) -> bool {
    /// Samples on either side, and the order of the curve through them.
    const SIDE: usize = 8;
    const ORDER: i32 = 5;
    /// Share of what is left beside a sample that is off.
    const CLEARLY: f64 = 0.7;
    if k < SIDE || k + SIDE >= recording.samples() {
        return false;
    }
    let place = |i: usize| (i as f64 - SIDE as f64) / SIDE as f64;
    let column =
        |f: &dyn Fn(f64) -> f64| -> Vec<f64> { (0..=2 * SIDE).map(|i| f(place(i))).collect() };
    let left = |f: &dyn Fn(f64) -> f64| -> f64 {
        let curve = (0..=ORDER).map(|order| column(&|x| x.powi(order)));
        let shapes: Vec<Vec<f64>> = curve.chain([column(f)]).collect();
        let channels = [&recording.cos, &recording.sin];
        let rest = channels.map(|v| crate::solve::without(&v[k - SIDE..=k + SIDE], &shapes));
        rest.iter().flatten().map(|r| r * r).sum()
    };
    let one = left(&|x| f64::from(x == 0.0));
    let step = left(&|x| f64::from(x >= 0.0)).min(left(&|x| f64::from(x > 0.0)));
    // A drive that is faster at once bends both.
    let sample = 1.0 / SIDE as f64;
    let corners = [-0.5, 0.0, 0.5].map(|at| left(&|x| (x - at * sample).max(0.0)));
    let corner = corners.into_iter().fold(f64::MAX, f64::min);
    step.min(corner) < CLEARLY * one
}

/// Lowest and highest value.
fn ends(values: &[f64]) -> (f64, f64) {
    let start = (f64::MAX, f64::MIN);
    let fold = |(a, b): (f64, f64), v: &f64| (a.min(*v), b.max(*v));
    values.iter().fold(start, fold)
}

/// Whether both channels have the code of the sample before.
pub(crate) fn repeats(recording: &Recording, k: usize) -> bool {
    recording.cos[k] == recording.cos[k - 1] && recording.sin[k] == recording.sin[k - 1]
}

/// Ninth decile of sizes.
pub(crate) fn ninth(sizes: &[f64]) -> f64 {
    let mut sizes = sizes.to_vec();
    if sizes.is_empty() {
        return f64::MIN_POSITIVE;
    }
    let at = sizes.len() * 9 / 10;
    let (_, value, _) = sizes.select_nth_unstable_by(at, f64::total_cmp);
    value.max(f64::MIN_POSITIVE)
}

/// Isolated samples far from what their neighbours say.
fn glitches(recording: &Recording, checked: &mut Checked) {
    let n = recording.samples();
    let rate = recording.metadata.sample_rate_hz;
    let Edges {
        channels,
        far: mut found,
    } = edges(recording);
    let off = [0, 1].map(|which: usize| {
        let values = &channels[which];
        (0..n)
            .map(|k| off_the_curve(values, k))
            .collect::<Vec<f64>>()
    });
    for (which, values) in channels.iter().enumerate() {
        let sizes: Vec<f64> = off[which].iter().map(|o| o.abs()).collect();
        let typical = ninth(&sizes);
        // Where the neighbours say that it is: a glitch beyond the others would be alone in its range, and typical there.
        let expected: Vec<f64> = values.iter().zip(&off[which]).map(|(v, o)| v - o).collect();
        let (low, high) = ends(&expected);
        let range = |v: f64| (((v - low) / (high - low) * RANGES as f64) as usize).min(RANGES - 1);
        let mut alike: Vec<Vec<f64>> = vec![vec![]; RANGES];
        for (v, size) in expected.iter().zip(&sizes) {
            alike[range(*v)].push(*size);
        }
        let alike: Vec<f64> = alike.iter().map(|a| ninth(a) / typical).collect();
        let floor = 6.0 * recording.metadata.adc.cos.lsb;
        for k in REACH..n.saturating_sub(REACH) {
            // Most samples need no look at their surroundings.
            if sizes[k] <= (FAR * typical).max(floor) {
                continue;
            }
            // Noise that grows with the signal, its slope or the speed is larger at some values and times than at others.
            let near = &sizes[k.saturating_sub(AROUND)..(k + AROUND + 1).min(n)];
            let there = (ninth(near) / typical / BY_CHANCE).max(1.0);
            let larger = there * alike[range(expected[k])].max(1.0);
            let limit = (FAR * typical * larger).max(floor);
            // A doubled sample is late, not wrong.
            let bad = (k - 1..=k + 1).any(|near| checked.weight[near] == 0.0);
            let doubled = bad || repeats(recording, k) || repeats(recording, k + 1);
            // Across a gap in time there is no such curve.
            let step = |j: usize| recording.time_s[j] - recording.time_s[j - 1];
            let gap = (k + 1 - REACH..=k + REACH).any(|j| step(j) * rate > 1.5);
            let far = sizes[k] > limit && !doubled && !gap;
            if far && isolated(&off, which, k) && !steps(recording, k) {
                found.push((k, sizes[k]));
            }
        }
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
    let finding = Finding::digital("glitches", parameters, evidence);
    let finding = finding.at(Place::Sample(found[0].0)).repairing(left_out);
    checked.findings.push(finding);
}
