//! Samples that were put in: behind one, the angle is late by what it moves in a sample.

use nonius_recording::Recording;

use crate::checks::Checked;
use crate::checks::delays::{Delay, delays};
use crate::checks::sides::is_about;
use crate::checks::timebase::BY_CHANCE;

/// Standard deviations from which on a delay counts.
const SURE: f64 = 5.0;
/// Samples at which it is tried how often an angle seems early.
const PLACES: usize = 4000;

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
    let is_off = |k: usize, by: f64| {
        let looks: Vec<(Delay, f64)> = all.iter().filter_map(|look| look.at(k)).collect();
        let best = looks.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let by_one = |delay: &Delay| is_about(delay.samples, by, delay.sigma);
        let would_show = |delay: &Delay| SURE * delay.sigma < 1.0;
        best.is_some_and(|(delay, told)| *told > SURE && by_one(delay))
            && looks
                .iter()
                .all(|(delay, _)| by_one(delay) || !would_show(delay))
    };
    let late: Vec<usize> = of.iter().copied().filter(|k| is_off(*k, -1.0)).collect();
    if late.is_empty() {
        return late;
    }
    // Nothing makes the angle early by a sample: where it seems so, as of an axis that moves unevenly, it seems late as often.
    let n = angle.len();
    let places = (0..n).step_by(n.div_ceil(PLACES));
    let early = places.clone().filter(|k| is_off(*k, 1.0)).count() as f64;
    let by_chance = of.len() as f64 * early / places.count() as f64;
    if by_chance > BY_CHANCE { vec![] } else { late }
}
