//! The time base is repaired before anything else: samples that are missing get their place, and do not count.

use nonius_recording::Recording;

/// A recording on a regular time base, and which of its samples are of the original.
pub(crate) struct Repaired {
    pub(crate) recording: Recording,
    pub(crate) weight: Vec<f64>,
    pub(crate) original: Vec<bool>,
}

/// Fills each gap (index of the sample behind it, how many are missing) with a straight line that does not count.
pub(crate) fn repair(recording: &Recording, weight: &[f64], gaps: &[(usize, usize)]) -> Repaired {
    let filled = |values: &[f64]| -> Vec<f64> {
        let mut out = Vec::with_capacity(values.len());
        let mut next = gaps.iter().peekable();
        for (k, value) in values.iter().enumerate() {
            if let Some((_, missing)) = next.next_if(|g| g.0 == k) {
                let before = values[k.saturating_sub(1)];
                for i in 1..=*missing {
                    let share = i as f64 / (*missing + 1) as f64;
                    out.push(before + share * (value - before));
                }
            }
            out.push(*value);
        }
        out
    };
    let mut original = vec![];
    let mut next = gaps.iter().peekable();
    for k in 0..recording.samples() {
        if let Some((_, missing)) = next.next_if(|g| g.0 == k) {
            original.extend(std::iter::repeat_n(false, *missing));
        }
        original.push(true);
    }
    let counts = filled(weight);
    let weight = counts
        .iter()
        .zip(&original)
        .map(|(w, own)| if *own { *w } else { 0.0 })
        .collect();
    let mut repaired = recording.clone();
    repaired.time_s = filled(&recording.time_s);
    repaired.cos = filled(&recording.cos);
    repaired.sin = filled(&recording.sin);
    repaired.reference_rad = recording.reference_rad.as_deref().map(filled);
    repaired.temperature_c = recording.temperature_c.as_deref().map(filled);
    repaired.other.clear();
    Repaired {
        recording: repaired,
        weight,
        original,
    }
}
