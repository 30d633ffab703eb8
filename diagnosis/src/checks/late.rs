//! Samples that were put in: behind one, the angle is late by what it moves in a sample.

use nonius_recording::Recording;

use crate::checks::Checked;
use crate::checks::delays::{Delay, delays};
use crate::checks::sides::is_about;

/// Standard deviations from which on a delay counts.
const SURE: f64 = 5.0;

/// Those of some samples behind which the angle is late by what it moves in a sample: they were put in. One of them is looked
/// for, not the farthest of all, so a smaller delay tells, by the curves that show the largest there; where the axis turns, its own motion
/// can look like one to some curves, so all that would show one have to. The first and the last 900 samples show none; of short recordings, fewer.
pub(crate) fn late(recording: &Recording, checked: &Checked, of: &[usize]) -> Vec<usize> {
    if of.is_empty() {
        return vec![];
    }
    let Some(angle) = checked.angle(recording) else {
        return vec![];
    };
    let all = delays(&angle);
    let by_one = |delay: &Delay| is_about(delay.samples, -1.0, delay.sigma);
    let is_late = |k: &usize| {
        let looks: Vec<(Delay, f64)> = all.iter().filter_map(|look| look.at(*k)).collect();
        let best = looks.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let would_show = |delay: &Delay| SURE * delay.sigma < 1.0;
        best.is_some_and(|(delay, told)| *told > SURE && by_one(delay))
            && looks
                .iter()
                .all(|(delay, _)| by_one(delay) || !would_show(delay))
    };
    of.iter().copied().filter(is_late).collect()
}
