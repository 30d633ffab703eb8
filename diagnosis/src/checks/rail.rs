//! Channels that are clipped: at the end of the ADC's range, or where an amplifier's output goes no further. Their highest or
//! lowest code comes far more often than the ones beside it, every time that the signal passes there. What is clipped says
//! nothing but where the rail is: it is left out, the angle is the other channel's there, and the rest of the signals is as it was.

use nonius_calibration::Ellipse;
use nonius_quantity::{agree, counted};
use nonius_recording::{AdcPair, Recording};

use crate::checks::{Checked, first};
use crate::clipped::{AtRail, By, Clipped, KNOWS};
use crate::finding::{Cause, Finding, Parameter, Place};
use crate::numerics::ends::{ends, span};

/// So many times as often as each of the codes beside it, a rail's code comes: the top of a sine at most 3.2 times.
const PLATEAU: f64 = 8.0;
/// Codes beside it, of those that come at all: steps may be coarse.
const BESIDE: usize = 4;
/// Part of its range that the other channel moves over meanwhile: where it does not, the axis stands still there.
const MOVES: f64 = 0.03;
/// Fewest times that the signal passes there, and fewest samples there.
const PASSES: usize = 4;
const SAMPLES: usize = 20;
/// Share of the samples that may be left out: what is clipped more is seen by its shape.
const MOST: f64 = 0.75;
/// Part of its width by which more is left out on either side of what is clipped.
const WIDER: f64 = 0.05;
/// Single rails, as the catalogue calls them.
const RAILS: [[&str; 2]; 2] = [["cos_upper", "cos_lower"], ["sin_upper", "sin_lower"]];

/// A channel that is clipped.
pub(crate) struct Rail {
    channel: usize,
    /// The lower one.
    lower: bool,
    /// Its code.
    code: i64,
    /// Samples that have it.
    clipped: Vec<usize>,
    /// Number of samples that are left out for it.
    left_out: usize,
}

/// The signal at the top of a channel, from one time in the other half to the next.
#[derive(Default)]
struct Pass {
    /// Samples of the highest code.
    at: Vec<usize>,
    /// Number of samples of the codes beside it.
    beside: usize,
}

/// A rail of a channel, looked at with its sign turned where it is the lower one, and the samples there; `moves` says whether the other
/// channel does at some samples.
fn rail(
    codes: &[i64],
    sound: &[usize],
    lower: bool,
    moves: &dyn Fn(&[usize]) -> bool,
) -> Option<(i64, Vec<usize>)> {
    let up = |k: usize| if lower { -codes[k] } else { codes[k] };
    let mut all: Vec<i64> = sound.iter().map(|k| up(*k)).collect();
    all.sort_unstable();
    all.dedup();
    let (bottom, top) = (*all.first()?, *all.last()?);
    let beside = *all.get(all.len().checked_sub(1 + BESIDE)?)?;
    let middle = bottom + (top - bottom) / 2;
    // Samples at the rail and beside it, pass by pass: between two passes the signal has been in the other half.
    let mut passes: Vec<Pass> = vec![];
    let mut inside = false;
    for k in sound {
        let code = up(*k);
        if code < middle {
            inside = false;
        } else if code >= beside {
            if !inside {
                passes.push(Pass::default());
                inside = true;
            }
            let Some(pass) = passes.last_mut() else {
                continue;
            };
            if code == top {
                pass.at.push(*k);
            } else {
                pass.beside += 1;
            }
        }
    }
    let clipped: Vec<usize> = passes.iter().flat_map(|p| &p.at).copied().collect();
    // An axis that stands still just there is at no rail.
    passes.retain(|p| p.at.len() < SAMPLES || moves(&p.at));
    // Neither may one be that moves a little.
    let longest = passes.iter().enumerate().max_by_key(|(_, p)| p.at.len())?.0;
    passes.remove(longest);
    let [at, beside] = passes
        .iter()
        .fold([0, 0], |[a, b], p| [a + p.at.len(), b + p.beside]);
    let passing = passes.iter().filter(|p| !p.at.is_empty()).count();
    let plateau = at as f64 > PLATEAU * beside as f64 / BESIDE as f64;
    (plateau && passing >= PASSES && at >= SAMPLES)
        .then_some((if lower { -top } else { top }, clipped))
}

/// Leaves out what is clipped, by the other channel, so that noise has no say in it: the samples there, and those beside them.
fn leave_out(recording: &Recording, rail: &Rail, weight: &mut [f64]) -> Vec<usize> {
    let own = [&recording.cos, &recording.sin][rail.channel];
    let other = [&recording.sin, &recording.cos][rail.channel];
    let mut values: Vec<f64> = rail.clipped.iter().map(|k| other[*k]).collect();
    values.sort_unstable_by(f64::total_cmp);
    let (Some(low), Some(high)) = (values.first(), values.last()) else {
        return vec![];
    };
    let wider = WIDER * (high - low);
    let range = low - wider..=high + wider;
    let sound: Vec<usize> = (0..weight.len()).filter(|k| weight[*k] > 0.0).collect();
    let [low, high] = ends(sound.iter().map(|k| own[*k]));
    let middle = (low + high) / 2.0;
    let near = |k: &usize| range.contains(&other[*k]) && (own[*k] < middle) == rail.lower;
    let left_out: Vec<usize> = sound.into_iter().filter(near).collect();
    left_out.iter().for_each(|k| weight[*k] = 0.0);
    left_out
}

/// Samples that are left out, and what tells their angle.
fn told(recording: &Recording, rails: &[Rail], left_out: &[usize], e: &Ellipse) -> Vec<Clipped> {
    let mut at: Vec<Vec<AtRail>> = vec![vec![]; recording.samples()];
    for rail in rails {
        let (channel, lower) = (rail.channel, rail.lower);
        for k in &rail.clipped {
            at[*k].push(AtRail { channel, lower });
        }
    }
    let knows = |rail: &AtRail, k: usize| {
        let other = match rail.channel {
            0 => (recording.sin[k] - e.b_s) / e.a_s,
            _ => (recording.cos[k] - e.b_c) / e.a_c,
        };
        other.abs() < KNOWS
    };
    let by = |k: usize| match at[k][..] {
        [] => By::Both,
        [rail] if knows(&rail, k) => By::Other(rail),
        _ => By::Neighbours,
    };
    let all = left_out.iter().map(|sample| Clipped {
        sample: *sample,
        by: by(*sample),
    });
    all.collect()
}

impl Rail {
    /// What is said of it, by an ellipse: offset and amplitude of its channel.
    pub(crate) fn finding(&self, adc: &AdcPair, e: &Ellipse) -> Finding {
        let rail = self;
        let (adc, offset, amplitude) = match rail.channel {
            0 => (&adc.cos, e.b_c, e.a_c),
            _ => (&adc.sin, e.b_s, e.a_s),
        };
        let sense = if rail.lower { -1.0 } else { 1.0 };
        let threshold = sense * (adc.value(rail.code) - offset) / amplitude;
        let half = 0.5 * adc.lsb / amplitude;
        let mut parameters = vec![
            Parameter::measured("threshold", threshold, half, "amplitude"),
            Parameter::exact("compression", 1.0, "1"),
        ];
        for (channel, names) in RAILS.iter().enumerate() {
            for (name, lower) in names.iter().zip([false, true]) {
                let own = channel == rail.channel && lower == rail.lower;
                let value = f64::from(own);
                parameters.push(Parameter::exact(&format!("compression_{name}"), value, "1"));
            }
        }
        let ends = adc.codes();
        let end = rail.code == if rail.lower { ends.0 } else { ends.1 };
        let count = rail.clipped.len();
        let evidence = format!(
            "the {} channel is clipped at its {} rail, {} of the amplitude {} its offset: {} {} its {} code, {}{}",
            ["cos", "sin"][rail.channel],
            if rail.lower { "lower" } else { "upper" },
            parameters[0].brief(),
            if rail.lower { "below" } else { "above" },
            counted(count, "sample"),
            agree(count, "has", "have"),
            if rail.lower { "lowest" } else { "highest" },
            rail.code,
            if end {
                ", the end of the ADC's range"
            } else {
                ""
            },
        );
        let place = Place::Rail {
            channel: rail.channel,
            code: rail.code,
        };
        Finding::digital(Cause::Saturation, parameters, evidence)
            .at(place)
            .repairing(self.left_out)
    }

    /// Whether a finding is that of it.
    pub(crate) fn is_of(&self, finding: &Finding) -> bool {
        let own = Place::Rail {
            channel: self.channel,
            code: self.code,
        };
        finding.place == Some(own)
    }
}

/// Finds the rails of a recording and leaves out what is clipped; nothing where too little would be left.
pub(super) fn rails(recording: &Recording, checked: &mut Checked) {
    let weight = &checked.weight;
    let sound: Vec<usize> = (0..weight.len()).filter(|k| weight[*k] > 0.0).collect();
    let codes: (Vec<i64>, Vec<i64>) = recording.codes().unzip();
    let others = [&recording.sin, &recording.cos];
    let mut found = vec![];
    for (channel, codes) in [&codes.0, &codes.1].into_iter().enumerate() {
        let of = |places: &[usize]| span(places.iter().map(|k| others[channel][*k]));
        let whole = of(&sound);
        let moves = |clipped: &[usize]| of(clipped) > MOVES * whole;
        for lower in [false, true] {
            let rail = rail(codes, &sound, lower, &moves);
            if let Some((code, clipped)) = rail.filter(|(_, clipped)| moves(clipped)) {
                found.push(Rail {
                    channel,
                    lower,
                    code,
                    clipped,
                    left_out: 0,
                });
            }
        }
    }
    let mut without = weight.clone();
    let mut left_out = |rail| leave_out(recording, rail, &mut without);
    let left_out: Vec<Vec<usize>> = found.iter().map(&mut left_out).collect();
    let left = without.iter().filter(|w| **w > 0.0).count();
    if found.is_empty() || (left as f64) < (1.0 - MOST) * sound.len() as f64 {
        return;
    }
    let Ok(e) = first::ellipse(recording, &without) else {
        return;
    };
    checked.weight = without;
    let adc = recording.metadata.adc;
    for (rail, left_out) in found.iter_mut().zip(&left_out) {
        rail.left_out = left_out.len();
        checked.findings.push(rail.finding(&adc, &e));
    }
    checked.clipped = told(recording, &found, &left_out.concat(), &e);
    checked.rails = found;
}
