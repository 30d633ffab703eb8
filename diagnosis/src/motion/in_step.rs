//! Motion in step with the scale, as a step motor's: it repeats with the period and is no error of the sensor, for the radius repeats
//! nothing like it.

use std::f64::consts::TAU;

/// Parts of the period.
const PARTS: usize = 32;
/// Radians rms from which on it is no harmonic that the ellipse has taken out of the radius.
const LARGE: f64 = 0.1;
/// So many times what repeats in the radius.
const TIMES: f64 = 10.0;

/// Rms of what values repeat with the period of an angle.
fn repeated(angle: &[f64], values: impl Iterator<Item = f64>, weight: &[f64]) -> f64 {
    let mut parts = [[0.0; 2]; PARTS];
    for ((angle, value), weight) in angle.iter().zip(values).zip(weight) {
        let part = (angle / TAU).rem_euclid(1.0) * PARTS as f64;
        let [sum, count] = &mut parts[(part as usize).min(PARTS - 1)];
        *sum += weight * value;
        *count += weight;
    }
    let [square, all] = parts
        .iter()
        .fold([0.0, 0.0], |[square, all], [sum, count]| {
            [square + sum * sum / count.max(1.0), all + count]
        });
    (square / all.max(1.0)).sqrt()
}

/// Whether what a spline leaves of an angle, radians, is such motion, by the radius less 1.
pub(crate) fn is_in_step(angle: &[f64], left: &[f64], radius: &[f64], weight: &[f64]) -> bool {
    let along = repeated(angle, left.iter().copied(), weight);
    along > LARGE && along > TIMES * repeated(angle, radius.iter().copied(), weight)
}
