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
    at: AtRail,
    /// Its code.
    code: i64,
    /// Samples that have it.
    clipped: Vec<usize>,
    /// Samples that are left out for it: these, and those beside them.
    left_out: Vec<usize>,
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

/// Samples that are left out, and what tells their angle.
fn told(recording: &Recording, rails: &[Rail], e: &Ellipse) -> Vec<Clipped> {
    let mut at: Vec<Vec<AtRail>> = vec![vec![]; recording.samples()];
    for rail in rails {
        rail.clipped.iter().for_each(|k| at[*k].push(rail.at));
    }
    let others = [&recording.sin, &recording.cos];
    let knows = |rail: &AtRail, k: usize| {
        let (offset, amplitude) = of_channel(e, 1 - rail.channel);
        ((others[rail.channel][k] - offset) / amplitude).abs() < KNOWS
    };
    let by = |k: usize| match at[k][..] {
        [] => By::Both,
        [rail] if knows(&rail, k) => By::Other(rail),
        _ => By::Neighbours,
    };
    let all = rails.iter().flat_map(|rail| &rail.left_out);
    all.map(|sample| Clipped {
        sample: *sample,
        by: by(*sample),
    })
    .collect()
}

/// Offset and amplitude of a channel.
fn of_channel(e: &Ellipse, which: usize) -> (f64, f64) {
    [(e.b_c, e.a_c), (e.b_s, e.a_s)][which]
}

impl Rail {
    /// Leaves out what is clipped, by the other channel, so that noise has no say in it: the samples there, and those beside them.
    fn leave_out(&mut self, recording: &Recording, weight: &mut [f64]) {
        let both = [&recording.cos, &recording.sin];
        let (own, other) = (both[self.at.channel], both[1 - self.at.channel]);
        let [low, high] = ends(self.clipped.iter().map(|k| other[*k]));
        let wider = WIDER * (high - low);
        let range = low - wider..=high + wider;
        let sound: Vec<usize> = (0..weight.len()).filter(|k| weight[*k] > 0.0).collect();
        let [low, high] = ends(sound.iter().map(|k| own[*k]));
        let middle = (low + high) / 2.0;
        let near = |k: &usize| range.contains(&other[*k]) && (own[*k] < middle) == self.at.lower;
        self.left_out = sound.into_iter().filter(near).collect();
        self.left_out.iter().for_each(|k| weight[*k] = 0.0);
    }

    fn place(&self) -> Place {
        Place::Rail {
            channel: self.at.channel,
            code: self.code,
        }
    }

    /// What is said of it, by an ellipse: offset and amplitude of its channel.
    pub(crate) fn finding(&self, adc: &AdcPair, e: &Ellipse) -> Finding {
        let AtRail { channel, lower } = self.at;
        let adc = [&adc.cos, &adc.sin][channel];
        let (offset, amplitude) = of_channel(e, channel);
        let sense = if lower { -1.0 } else { 1.0 };
        let threshold = sense * (adc.value(self.code) - offset) / amplitude;
        let half = 0.5 * adc.lsb / amplitude;
        let mut parameters = vec![
            Parameter::measured("threshold", threshold, half, "amplitude"),
            Parameter::exact("compression", 1.0, "1"),
        ];
        for (channel, names) in RAILS.iter().enumerate() {
            for (name, lower) in names.iter().zip([false, true]) {
                let value = f64::from(self.at == AtRail { channel, lower });
                parameters.push(Parameter::exact(&format!("compression_{name}"), value, "1"));
            }
        }
        let ends = adc.codes();
        let end = self.code == if lower { ends.0 } else { ends.1 };
        let count = self.clipped.len();
        let evidence = format!(
            "the {} channel is clipped at its {} rail, {} of the amplitude {} its offset: {} {} its {} code, {}{}",
            ["cos", "sin"][channel],
            if lower { "lower" } else { "upper" },
            parameters[0].brief(),
            if lower { "below" } else { "above" },
            counted(count, "sample"),
            agree(count, "has", "have"),
            if lower { "lowest" } else { "highest" },
            self.code,
            if end {
                ", the end of the ADC's range"
            } else {
                ""
            },
        );
        Finding::digital(Cause::Saturation, parameters, evidence)
            .at(self.place())
            .repairing(self.left_out.len())
    }

    /// Whether a finding is that of it.
    pub(crate) fn is_of(&self, finding: &Finding) -> bool {
        finding.place == Some(self.place())
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
                    at: AtRail { channel, lower },
                    code,
                    clipped,
                    left_out: vec![],
                });
            }
        }
    }
    let mut without = weight.clone();
    for rail in &mut found {
        rail.leave_out(recording, &mut without);
    }
    let left = without.iter().filter(|w| **w > 0.0).count();
    if found.is_empty() || (left as f64) < (1.0 - MOST) * sound.len() as f64 {
        return;
    }
    let Ok(e) = first::ellipse(recording, &without) else {
        return;
    };
    checked.weight = without;
    let adc = recording.metadata.adc;
    let said = found.iter().map(|rail| rail.finding(&adc, &e));
    checked.findings.extend(said);
    checked.clipped = told(recording, &found, &e);
    checked.rails = found;
}
