//! Digital checks on the codes and the time base, before anything is fitted.

mod delays;
mod edges;
pub(crate) mod first;
mod glitches;
mod jumps;
mod late;
mod matched;
mod missing;
mod rail;
pub(crate) mod reference;
pub(crate) mod repair;
mod sides;
pub(crate) mod silent;
pub(crate) mod slips;
pub(crate) mod timebase;
mod turning;

use std::cell::OnceCell;

use nonius_calibration::Ellipse;
use nonius_recording::{AdcSource, Recording};

use crate::checks::rail::Rail;
use crate::clipped::Clipped;
use crate::finding::units;
use crate::finding::{Cause, Finding, Parameter, Place};

/// What the checks found, and which samples do not count.
pub(crate) struct Checked {
    pub(crate) findings: Vec<Finding>,
    /// 1 or 0 per sample.
    pub(crate) weight: Vec<f64>,
    /// Samples that are missing before a sample of the recording: index, how many.
    pub(crate) gaps: Vec<(usize, usize)>,
    /// Samples that repeat the one before while the scale moves.
    pub(crate) repeated: Vec<usize>,
    /// Those of them that were put in: what follows is late by one each.
    pub(crate) extra: Vec<usize>,
    /// Samples that are left out where a channel is clipped.
    pub(crate) clipped: Vec<Clipped>,
    /// Channels that are clipped.
    pub(crate) rails: Vec<Rail>,
    /// The ellipse of all samples, where one can be fitted; made when it is asked for.
    ellipse: OnceCell<Option<Ellipse>>,
}

impl Checked {
    /// The angle of the recording, continuous, radians, bridged where its samples do not count.
    pub(crate) fn angle(&self, recording: &Recording) -> Option<Vec<f64>> {
        let ellipse = self.ellipse(recording)?;
        Some(jumps::angle(recording, ellipse, &self.weight))
    }

    /// The ellipse of all samples, where one can be fitted.
    fn ellipse(&self, recording: &Recording) -> Option<&Ellipse> {
        let made = self.ellipse.get_or_init(|| first::of_all(recording));
        made.as_ref()
    }
}

const CHANNELS: [&str; 2] = ["cos", "sin"];

/// Whether samples that are lost or put in are looked for where the clock shows nothing of it.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum TimeBase {
    Searched,
    AsItIs,
}

/// Checks a recording; `weight` is 0 for samples that are known to hold no signal.
pub(crate) fn check(recording: &Recording, weight: Vec<f64>, time_base: TimeBase) -> Checked {
    let mut checked = Checked {
        findings: vec![],
        weight,
        gaps: vec![],
        repeated: vec![],
        extra: vec![],
        clipped: vec![],
        rails: vec![],
        ellipse: OnceCell::new(),
    };
    if time_base == TimeBase::Searched {
        timebase::repeated(recording, &mut checked);
    }
    glitches::find(recording, &mut checked);
    rail::rails(recording, &mut checked);
    // A sample that is wrong holds any code.
    let weight = &checked.weight;
    let sound = || recording.codes().zip(weight).filter(|(_, w)| **w > 0.0);
    let codes: (Vec<i64>, Vec<i64>) = sound().map(|(codes, _)| codes).unzip();
    let mut digital = vec![];
    let adc = recording.metadata.adc;
    let coded = adc.cos.source != AdcSource::Assumed;
    // Decimals that volts were rounded to are no codes, and most of them are missing.
    let whole = adc.cos.source == AdcSource::Described || units::are_counts(recording);
    for (name, codes, bits) in [
        (CHANNELS[0], &codes.0, adc.cos.bits),
        (CHANNELS[1], &codes.1, adc.sin.bits),
    ] {
        if coded {
            let channel = usize::from(name == CHANNELS[1]);
            let of_channel = |f: Finding| {
                let largest = f.parameters.first().map_or(0.0, |p| p.value);
                let step = if f.cause == Cause::StuckBit {
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
            let missing = if whole && found.is_empty() {
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
    timebase::dropped(recording, &mut checked, time_base);
    checked
}

/// Fewest codes that tell a step between all of them.
const FEWEST: usize = 8;
/// And so rare, as a power of two, that they all are by chance a whole number of steps apart.
const RARE: f64 = 18.0;

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

/// Whether sorted codes, some steps apart, come to so many places that a bit changes: to many spans in which it is the same, or to most
/// of the places within those. A speed of a few samples a period shows few places again and again, and there a bit may be the same by
/// chance.
fn sweeps(distinct: &[i64], step: i64, bit: u32) -> bool {
    /// Spans in all of which a bit is the same by chance once in a million.
    const MANY: usize = 20;
    /// Places in a span, as a power of two.
    const PLACES: u32 = 4;
    let count = |size: u32| {
        let mut all: Vec<i64> = distinct.iter().map(|c| c >> size).collect();
        all.dedup();
        all.len()
    };
    let spans = count(bit);
    // Between two steps there is no place.
    let finest = bit.saturating_sub(PLACES).max(step.max(1).ilog2()).min(bit);
    spans >= MANY || 4 * count(finest) >= 3 * (spans << (bit - finest))
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
        .filter(|bit| (2i64 << bit) <= span / 2 && sweeps(&distinct, step, *bit))
        .filter(|bit| {
            let mut ones = distinct.iter().map(|c| (c + offset) >> bit & 1);
            let first = ones.next();
            ones.all(|b| Some(b) == first)
        })
        .collect();
    let lowest: Vec<u32> = (0..bits).take_while(|b| constant.contains(b)).collect();
    // All codes lie a whole number of steps apart: the steps are coarse, or one last bit is stuck.
    let by_chance = (distinct.len() as f64 - 1.0) * (step as f64).log2();
    if distinct.len() >= FEWEST && step > 1 && by_chance > RARE {
        let bit = step == 2 && lowest.len() == 1;
        found.push(Finding::digital(
            if bit {
                Cause::StuckBit
            } else {
                Cause::CoarseQuantisation
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
            Cause::StuckBit,
            vec![Parameter::exact("bit", f64::from(*stuck), "1")],
            format!(
                "bit {stuck} of the {channel} channel never changes while its codes sweep over {span}"
            ),
        ));
    }
    found
}

/// Whether both channels have the code of the sample before.
pub(crate) fn repeats(recording: &Recording, k: usize) -> bool {
    recording.cos[k] == recording.cos[k - 1] && recording.sin[k] == recording.sin[k - 1]
}

/// Values without their signs.
pub(crate) fn magnitudes(values: &[f64]) -> Vec<f64> {
    values.iter().map(|v| v.abs()).collect()
}

/// Ninth decile of the sizes of normal values about 0, in their standard deviation.
pub(crate) const NINTH: f64 = 1.645;

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
