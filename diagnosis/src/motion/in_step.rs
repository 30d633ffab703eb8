//! Motion in step with the scale, as a step motor's: it repeats with the period and is no error of the sensor, for the radius repeats
//! nothing like it.

use crate::motion::knots::{self, Spacing, Told};
use crate::motion::spline::Spline;
use crate::numerics::repeated::repeated;

/// Parts of the period.
const PARTS: usize = 32;
/// Radians rms from which on it is no harmonic that the ellipse has taken out of the radius.
const LARGE: f64 = 0.1;
/// So many times what repeats in the radius.
const TIMES: f64 = 10.0;
/// So many times farther apart, knots follow nothing in step with the period.
const FARTHER: f64 = 4.0;

/// Whether what a spline leaves of an angle, radians, is such motion, by the radius less 1.
fn is_in_step(angle: &[f64], left: &[f64], radius: &[f64], weight: &[f64]) -> bool {
    let all: f64 = weight.iter().sum();
    let rms = |values: &[f64]| (repeated(angle, values, weight, PARTS) / all.max(1.0)).sqrt();
    let along = rms(left);
    along > LARGE && along > TIMES * rms(radius)
}

/// The knot spacing for an angle (radians) that no reference shows; that of all its motion, where that is in step with the scale.
pub(crate) fn spacing(angle: &[f64], radius: &[f64], weight: &[f64], per: Option<u32>) -> Spacing {
    let told = knots::spacing(angle, weight, per, Told::WhereItTravels);
    let smooth = Spline::new(angle.len(), FARTHER * told.motion, weight);
    let smooth = smooth.values(&smooth.fit(angle, weight));
    let left: Vec<f64> = angle.iter().zip(smooth).map(|(a, s)| a - s).collect();
    if !is_in_step(angle, &left, radius, weight) {
        return told;
    }
    let followed = knots::spacing(angle, weight, per, Told::Not).followed;
    Spacing {
        followed,
        motion: followed,
    }
}
