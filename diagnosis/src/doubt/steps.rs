//! A reference that moves in steps, as a counter does. Its rounding stands along the circle and goes with the angle, the revolution, the
//! speed and the time as the axis does: an error that is smaller may be its doing.

use nonius_quantity::{Quantity, Unit};
use nonius_recording::{Recording, code_step};

use crate::model::System;
use crate::select::selection::Selection;
use crate::unnamed::unexplained::Unnamed;
use crate::unnamed::whereabouts::Left;

/// Shares of the noise from which on the rounding is seen, and from which on it is seen in how the noise varies.
const SEEN: [f64; 2] = [0.1, 0.3];

/// Whether a reference whose values are so far apart is one that counts: at a speed that stays as it is, those of any other are equally far
/// apart, too.
fn counts(reference: &[f64], step: f64) -> bool {
    /// Share of the increments that may be others where the reference comes round.
    const OTHERS: f64 = 0.01;
    let mut steps: Vec<i64> = reference
        .windows(2)
        .map(|w| ((w[1] - w[0]) / step).round() as i64)
        .collect();
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable(middle).1;
    let others = steps.iter().filter(|s| **s != usual).count();
    // One that counts slowly stands most of the time.
    usual == 0 && others > 0 || others as f64 > OTHERS * steps.len() as f64
}

/// Takes back what has no name, stands along the circle and is smaller than the rounding of the reference. A sentence that says so,
/// where anything was or may be.
pub(crate) fn beside(
    system: &System,
    found: &mut Selection,
    recording: &Recording,
) -> Option<String> {
    let reference = recording.reference_rad.as_deref()?;
    let step = code_step(reference).filter(|step| counts(reference, *step))?;
    let rounding = step / 12f64.sqrt();
    if rounding < SEEN[0] * system.noise() {
        return None;
    }
    found.stepped = rounding > SEEN[1] * system.noise();
    let context = system.context;
    // Without the shapes that stand in for what has no name.
    let left = system.residual(&found.named(system).fit);
    let left = Left {
        context,
        radial: &left.radial,
        tangential: &left.tangential,
    };
    let stays = |one: &Unnamed| {
        let along = one.domain().is_some_and(|d| left.is_along(d.home()));
        system.size(one.gain) > rounding || !along
    };
    let before = found.unnamed.len() + found.left.len();
    found.unnamed.retain(stays);
    found.left.retain(stays);
    let step = Quantity::rounded(step, 2, Unit::Prefixed("rad")).brief();
    (found.stepped || found.unnamed.len() + found.left.len() < before).then(|| {
        format!("the reference moves in steps of {step}, and what is smaller along the circle and may be their doing has no name")
    })
}
