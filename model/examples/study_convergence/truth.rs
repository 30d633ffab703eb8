//! The Θ that a search should find: that which corrects the sensor as it is at the end of the run, or comes nearest.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use nonius_model::reference::{Parameters, Sensor, Theta};

use super::scenario::{SAMPLES, Scenario};

/// Places of the period.
const POINTS: usize = 90;
/// The corrections are linear in Θ, or nearly so.
const ITERATIONS: usize = 20;

/// By least squares of the corrected pair against (cos α, sin α), from the Θ that corrects the sensor without what the scenario
/// adds to it.
pub(crate) fn theta(set: Parameters, scenario: Scenario, sensor: &Sensor) -> Theta {
    let left = |theta: &Theta| {
        DVector::from_iterator(
            2 * POINTS,
            (0..POINTS).flat_map(|k| {
                let alpha = TAU * k as f64 / POINTS as f64;
                let y = scenario.signals(sensor, alpha, SAMPLES);
                let [c, s] = set.corrected(theta, y);
                [c - alpha.cos(), s - alpha.sin()]
            }),
        )
    };
    let mut theta = set.from_five(sensor.theta());
    for _ in 0..ITERATIONS {
        let mut by = DMatrix::zeros(2 * POINTS, theta.len());
        for i in 0..theta.len() {
            let moved = |h: f64| {
                let mut theta = theta;
                theta[i] += h;
                left(&theta)
            };
            by.set_column(i, &((moved(1e-4) - moved(-1e-4)) / 2e-4));
        }
        // A parameter that the set has not moves nothing, and stays.
        let solved = by.svd(true, true).solve(&left(&theta), 1e-9);
        let Ok(step) = solved else { break };
        theta -= Theta::from_fn(|i, _| step[i]);
    }
    theta
}
