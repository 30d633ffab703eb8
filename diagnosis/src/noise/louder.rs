//! Noise that is louder where a cause stands than the sums of a recording know: no cause is shown for it, and the numbers of a cause say so.

use crate::doubt;
use crate::model::{Fit, System};
use crate::noise::flicker::records::Records;
use crate::select::both;
use crate::select::score::{CLEAR, SHOWN, Scored};
use crate::select::selection::Selection;

/// Leaves out what is best only because noise is louder where it is: its probability is that of noise which is as uneven as what is left.
pub(crate) fn beyond_uneven_noise(
    system: &mut System,
    fit: &Fit,
    mut scored: Vec<Scored>,
) -> Vec<Scored> {
    let seen = |s: &&Scored| s.log_p < SHOWN.ln() && s.gain < CLEAR;
    while let Some(best) = scored.first().filter(seen) {
        system.extend();
        let with = system.fit(both(&fit.shapes, &best.candidate.shapes));
        let inflation = system.unevenness(fit, &with);
        if best.by_chance(inflation) < SHOWN.ln() {
            break;
        }
        scored.remove(0);
    }
    scored
}

/// Slow noise of the channels is in the numbers of what can be slow.
pub(crate) fn widen_where_slow(system: &mut System, found: &mut Selection, noise: &Records) {
    for one in &mut found.accepted {
        if !doubt::SLOW_DOMAINS.contains(&one.candidate.domain) {
            continue;
        }
        let range = one.range();
        let others = system.sure(&found.fit.others(&range));
        let own = system.sure(&found.fit.shapes[range]);
        one.inflation = noise.inflation(system, &others, &own);
    }
}

/// Noise that is not as loud everywhere is in the numbers of what stands where it is loud.
pub(crate) fn widen_where_uneven(system: &System, found: &mut Selection) {
    for one in &mut found.accepted {
        let without = system.fit(found.fit.others(&one.range()));
        one.inflation = one.inflation.max(system.unevenness(&without, &found.fit));
    }
}
