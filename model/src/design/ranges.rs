//! What the parameters can reach, by the design's promise.

use super::normalisation;
use crate::format::exp2;
use crate::spec::Spec;

/// What the promised sensors need of θ1 … θ9 at their worst: largest deviation from the nominal value.
pub(super) struct Needs {
    /// θ1 and θ3.
    pub(super) gain: f64,
    /// θ2 and θ4.
    pub(super) offset: f64,
    /// θ5.
    pub(super) cross: f64,
    /// θ6 … θ9.
    pub(super) bend: f64,
}

pub(super) fn needs(spec: &Spec) -> Needs {
    let nominal = 1.0 / normalisation(spec).0;
    let (m, offset) = (spec.sensor.amplitude_tolerance, spec.sensor.offset_max);
    let beta = spec.sensor.phase_error_max_deg.to_radians();
    Needs {
        gain: nominal / (1.0 - m) / beta.cos() - nominal,
        offset: offset / (1.0 - m) * (1.0 / beta.cos() + beta.tan()),
        cross: if spec.calibration.has_bend() {
            // It acts on the corrected cosine.
            beta.tan() / (1.0 - m)
        } else {
            beta.tan() * nominal / (1.0 - m)
        },
        bend: spec.sensor.bend_max,
    }
}

/// Smallest range of a parameter: bits above the point that are not needed cost nothing less.
const FINEST: i32 = -6;

/// log2 of the smallest range that holds `need`.
pub(super) fn just(need: f64) -> i32 {
    need.log2().ceil().max(f64::from(FINEST)) as i32
}

/// The promise, a quarter more, up to a power of two.
fn ample(need: f64) -> i32 {
    (need.max(1.0 / 64.0) * 1.25).log2().ceil() as i32
}

/// What the parameters can reach in the chip: as the user says, else the promise with some to spare.
pub(super) struct Ranges {
    /// log2 of the largest deviation of θ1 … θ9.
    pub(super) deviation: [i32; 9],
    /// Nominal θ1 and θ3.
    pub(super) nominal: f64,
}

pub(super) fn ranges(spec: &Spec) -> Ranges {
    let (need, o) = (needs(spec), &spec.formats);
    let gain = o.gain_range_log2.unwrap_or(ample(need.gain));
    let offset = o.offset_range_log2.unwrap_or(ample(need.offset));
    let cross = o.cross_range_log2.unwrap_or(ample(need.cross));
    let bend = o.bend_range_log2.unwrap_or(ample(need.bend));
    Ranges {
        deviation: [gain, offset, gain, offset, cross, bend, bend, bend, bend],
        nominal: 1.0 / normalisation(spec).0,
    }
}

/// The largest value in the word of `key`, which holds parameters as they are multiplied; coefficients are no larger than 1.
pub(super) fn multiplied_top(key: &str, spec: &Spec) -> f64 {
    let r = ranges(spec);
    let reach = |n: usize| exp2(r.deviation[n].into());
    match key {
        "gain_bits" => r.nominal + reach(0),
        "cross_bits" => reach(4),
        "bend_bits" => reach(5),
        "cubic_bits" => 8.0 * reach(7),
        _ => 1.0,
    }
}
