//! Stimuli of a signal that becomes weaker, goes and comes back.

use crate::plant::{Codes, Plant};

/// Periods of travel in which the signal fades.
const FADING: f64 = 12.0;
/// Periods of travel in which it vanishes.
const VANISHING: f64 = 100.0;
/// Of the signal where it is weak.
const WEAK: f64 = 0.88;

/// At top speed, with so much of the signal.
fn at_top_speed(plant: &Plant, k: usize, gain: f64) -> Codes {
    plant.faded(plant.travelled(k), gain)
}

/// The signal grows before gamma has settled, goes before the search has begun again and once more after its first period, and falls
/// a little later; it goes, comes back small, and grows.
pub(crate) fn loss(plant: &Plant, k: usize) -> Codes {
    let gain = match k as f64 / plant.samples() {
        t if t < 0.2 => 0.72,
        t if t > 0.235 && t < 0.25 => 0.0,
        t if t > 0.45 && t < 0.465 => 0.0,
        t if t > 0.60 && t < 0.64 => 1.0 - 2.5 * (t - 0.60),
        t if t < 0.66 => 1.0,
        t if t < 0.72 => 0.0,
        t if t < 0.9 => 0.7,
        t => 0.7 + 4.0 * (t - 0.9),
    };
    plant.faded(plant.slowly(0.02, k), gain)
}

/// At top speed, soon after lock, each second period has a part that is too large. The signal fades slowly once gamma has settled,
/// and stays so until the search begins again; where there is recall it changes for some periods once gamma has settled on it,
/// is then back, and grows until the radius is far too large.
pub(crate) fn fade(plant: &Plant, k: usize) -> Codes {
    let calibration = &plant.design.spec.calibration;
    // Periods of travel from a fade until the search has begun again and gamma, in gears of a period, has settled.
    let followed = 12.0 + f64::from(calibration.hold_periods());
    let travelled = plant.travelled(k);
    let fading = (k as f64 - plant.samples() / 3.0) * plant.top;
    let gain = match fading - FADING / 2.0 - followed {
        _ if travelled > 17.0 && travelled < 24.0 && travelled % 2.0 < 0.2 => 1.35,
        _ if 3 * k < plant.rows => 1.0,
        _ if fading < FADING => 1.0 - (1.0 - WEAK) * fading / FADING,
        _ if !calibration.recalls() => WEAK,
        periods if periods > 6.0 => 1.06 + 0.006 * (periods - 6.0),
        periods if periods > 0.0 && periods < 3.0 => 0.97,
        _ => WEAK,
    };
    at_top_speed(plant, k, gain)
}

/// So slowly that the gains follow for some periods, to nothing, and back.
pub(crate) fn vanish(plant: &Plant, k: usize) -> Codes {
    let vanished = (k as f64 - 0.22 * plant.samples()) * plant.top / VANISHING;
    let gain = if vanished < 1.0 {
        1.0 - vanished.max(0.0)
    } else {
        ((vanished - 1.05) * 2.0).clamp(0.0, 1.0)
    };
    at_top_speed(plant, k, gain)
}

/// Weak once gamma has settled and before anything is proven, until the search begins again.
pub(crate) fn early(plant: &Plant, k: usize) -> Codes {
    let periods = plant.travelled(k);
    let weak = periods > 34.0 && periods < 74.0;
    at_top_speed(plant, k, if weak { WEAK } else { 1.0 })
}

/// Weak for most of what is waited for, whole for some periods, and weak for most of it again.
pub(crate) fn weak(plant: &Plant, k: usize) -> Codes {
    let calibration = &plant.design.spec.calibration;
    let weak = (k as f64 - 0.4 * plant.samples()) * plant.top;
    let again = 0.625 * f64::from(calibration.hold_periods());
    let whole = again + 8.0 + f64::from(calibration.returning_periods());
    let gain = match weak {
        weak if weak < 0.0 => 1.0,
        weak if weak < again => WEAK,
        weak if weak < whole => 1.0,
        _ => WEAK,
    };
    at_top_speed(plant, k, gain)
}

/// So slowly down that the parameters follow, until it falls.
pub(crate) fn drift(plant: &Plant, k: usize) -> Codes {
    let drifting = (k as f64 - 0.4 * plant.samples()) * plant.top;
    let left = if 8 * k > 7 * plant.rows { WEAK } else { 1.0 };
    at_top_speed(plant, k, left * (1.0 - 6e-4 * drifting.max(0.0)))
}

/// One channel has another gain and another offset from the middle on.
pub(crate) fn step(plant: &Plant, k: usize) -> Codes {
    let (gain, offset) = if k > plant.rows / 2 {
        (0.9, 0.04 * plant.amplitude)
    } else {
        (1.0, 0.0)
    };
    plant.changed(plant.slowly(0.011, k), gain, offset)
}
