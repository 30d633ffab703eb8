//! The time base is repaired before anything else: samples that are missing get their place, and do not count.

use nonius_recording::Recording;

use crate::checks::Checked;
use crate::clipped::Clipped;
use crate::context::{Context, ContextError};

/// A recording on a regular time base, and where the samples of the original stand in it.
pub(crate) struct Repaired {
    pub(crate) recording: Recording,
    pub(crate) weight: Vec<f64>,
    /// Samples that are left out where a channel is clipped.
    pub(crate) clipped: Vec<Clipped>,
    /// One per sample of the original.
    pub(crate) place: Vec<usize>,
}

impl Repaired {
    /// Its motion, and what is left of the signals.
    pub(crate) fn context(&self) -> Result<Context, ContextError> {
        Context::new(&self.recording, self.weight.clone(), self.clipped.clone())
    }
}

/// Fills each gap (index of the sample behind it, how many are missing) with a straight line that does not count, and
/// leaves out samples that were put in.
pub(crate) fn repair(recording: &Recording, checked: &Checked) -> Repaired {
    let n = recording.samples();
    let kept: Vec<bool> = {
        let mut kept = vec![true; n];
        checked.extra.iter().for_each(|k| kept[*k] = false);
        kept
    };
    // For every sample of the repaired recording: the one behind it, and how far on the way from the one before.
    let (mut places, mut sources) = (Vec::with_capacity(n), vec![]);
    let mut next = checked.gaps.iter().peekable();
    let mut last = 0;
    for (k, kept) in kept.iter().enumerate() {
        if let Some((_, missing)) = next.next_if(|g| g.0 == k) {
            let share = |i: usize| i as f64 / (*missing + 1) as f64;
            sources.extend((1..=*missing).map(|i| (last, k, share(i))));
        }
        if *kept {
            sources.push((k, k, 0.0));
            last = k;
        }
        places.push(sources.len().saturating_sub(1));
    }
    let filled = |values: &[f64]| -> Vec<f64> {
        let between =
            |(a, b, share): &(usize, usize, f64)| values[*a] + share * (values[*b] - values[*a]);
        sources.iter().map(between).collect()
    };
    let weight = sources
        .iter()
        .map(|(a, b, _)| if a == b { checked.weight[*a] } else { 0.0 })
        .collect();
    let mut repaired = recording.clone();
    // Where the clock shows nothing of it, time goes on as it should.
    let irregular = !checked.extra.is_empty() || sources.len() > n;
    repaired.time_s = filled(&recording.time_s);
    if irregular {
        let (first, rate) = (repaired.time_s[0], recording.metadata.sample_rate_hz);
        let count = repaired.time_s.len();
        repaired.time_s = (0..count).map(|k| first + k as f64 / rate).collect();
    }
    repaired.cos = filled(&recording.cos);
    repaired.sin = filled(&recording.sin);
    repaired.reference_rad = recording.reference_rad.as_deref().map(filled);
    repaired.temperature_c = recording.temperature_c.as_deref().map(filled);
    repaired.other.clear();
    let clipped = checked.clipped.iter().map(|one| Clipped {
        sample: places[one.sample],
        ..*one
    });
    Repaired {
        recording: repaired,
        weight,
        clipped: clipped.collect(),
        place: places,
    }
}
