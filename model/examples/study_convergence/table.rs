//! Every method beside every other.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nonius_model::design::Design;
use nonius_model::reference::Sensor;

use super::costs::Costs;
use super::limit;
use super::method::{Method, Said};
use super::scenario::{SAMPLES, Scenario, samples};
use super::truth;

/// Miscalibration of Θ at sample k, radians: (rms, largest), the constant part removed.
fn miscalibration(scenario: Scenario, sensor: &Sensor, k: u32, said: &Said) -> (f64, f64) {
    const POINTS: u32 = 90;
    let errors: Vec<f64> = (0..POINTS)
        .map(|i| {
            let alpha = TAU * f64::from(i) / f64::from(POINTS);
            let y = scenario.signals(sensor, alpha, k);
            let [c, s] = said.set.corrected(&said.theta, y);
            wrapped(s.atan2(c) - alpha)
        })
        .collect();
    let n = f64::from(POINTS);
    let mean = errors.iter().sum::<f64>() / n;
    let square = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n;
    let largest = errors.iter().fold(0.0f64, |m, e| m.max((e - mean).abs()));
    (square.sqrt(), largest)
}

/// To the nearest whole turn, radians.
pub(crate) fn wrapped(x: f64) -> f64 {
    x - (x / TAU).round() * TAU
}

/// What a run comes to.
struct Outcome {
    /// Largest difference of a parameter from the one that corrects the sensor best.
    parameter: f64,
    /// Miscalibration at the end, radians.
    rms: f64,
    largest: f64,
    /// Error of α̂ over the last tenth, radians rms, and the largest.
    alpha_hat: f64,
    alpha_hat_largest: f64,
    /// Periods travelled until the miscalibration stays within 10 % of its final value.
    periods: f64,
}

fn run(scenario: Scenario, method: &mut Method) -> Outcome {
    let sensor = method.sensor();
    let mut furthest = 0.0f64;
    let (mut square, mut counted) = (0.0, 0.0);
    let mut course: Vec<(f64, f64)> = Vec::new();
    let mut last = None;
    for (sample, k) in samples(scenario, &sensor).zip(0..SAMPLES) {
        let said = method.step(sample.y);
        if k >= SAMPLES / 10 * 9 {
            let error = wrapped(said.alpha_hat - sample.alpha);
            square += error.powi(2);
            furthest = furthest.max(error.abs());
            counted += 1.0;
        }
        if k % 60 == 0 {
            let rms = miscalibration(scenario, &sensor, k, &said).0;
            course.push((sample.alpha / TAU, rms));
        }
        last = Some(said);
    }
    let Some(said) = last else {
        unreachable!("a run has samples")
    };
    let end = course.len() / 10 * 9;
    let tail = &course[end..];
    let end = tail.iter().map(|(_, rms)| rms).sum::<f64>() / tail.len() as f64;
    let outside = course.iter().rposition(|(_, rms)| *rms > 1.1 * end);
    // Parameters that wander about their final value for ever, by noise, count from when they first get there.
    let arrived = course.iter().position(|(_, rms)| *rms <= 1.1 * end);
    let settled = match (outside, arrived) {
        (Some(i), Some(first)) if i < course.len() / 2 => i.max(first),
        (_, first) => first.unwrap_or(0),
    };
    let (rms, largest) = miscalibration(scenario, &sensor, SAMPLES, &said);
    Outcome {
        parameter: (said.theta - truth::theta(said.set, scenario, &sensor)).amax(),
        rms,
        largest,
        alpha_hat: f64::sqrt(square / counted),
        alpha_hat_largest: furthest,
        periods: course[settled].0,
    }
}

/// Every method in these scenarios.
pub(crate) fn methods(design: &Design, scenarios: &[Scenario], costs: &Costs) -> String {
    let mut csv = String::from(
        "method,scenario,parameter_error,miscalibration_rms_mrad,miscalibration_largest_mrad,alpha_hat_rms_mrad,alpha_hat_largest_mrad,periods,products,clocks,lut4\n",
    );
    for &scenario in scenarios {
        // What the paper's introduction argues against first, then what nothing can beat.
        let (first, rest): (Vec<_>, Vec<_>) = Method::all(design)
            .into_iter()
            .partition(|(_, method)| method.is_baseline());
        first
            .into_iter()
            .for_each(|method| row(&mut csv, scenario, method, costs));
        for (name, bound) in limit::bounds(design, scenario) {
            let theta = bound.theta.diagonal().amax().sqrt();
            let rms = 1e3 * bound.angle_by_parameters;
            // The angle of a single sample: its own noise, and that of the parameters.
            let alpha_hat = 1e3 * bound.angle_by_parameters.hypot(bound.angle_by_noise);
            _ = writeln!(
                csv,
                "\"{name}\",{},{theta:.2e},{rms:.4},,{alpha_hat:.4},,,,,",
                scenario.name()
            );
        }
        rest.into_iter()
            .for_each(|method| row(&mut csv, scenario, method, costs));
    }
    csv
}

/// The row of a method in a scenario.
fn row(csv: &mut String, scenario: Scenario, (name, mut method): (String, Method), costs: &Costs) {
    let found = run(scenario, &mut method);
    let [rms, largest, alpha_hat, furthest] = [
        found.rms,
        found.largest,
        found.alpha_hat,
        found.alpha_hat_largest,
    ]
    .map(|x| 1e3 * x);
    let chip = method.design();
    let products = chip.map_or(String::new(), |d| d.graph.products().to_string());
    let [clocks, luts] = chip.map(|d| costs.of(d)).unwrap_or_default();
    _ = writeln!(
        csv,
        "\"{name}\",{},{:.2e},{rms:.4},{largest:.4},{alpha_hat:.4},{furthest:.4},{:.1},{products},{clocks},{luts}",
        scenario.name(),
        found.parameter,
        found.periods
    );
}
