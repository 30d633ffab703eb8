//! Every method beside every other.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nonius_model::design::Design;
use nonius_model::reference::{Parameters, Theta};

use super::method::Method;
use super::scenario::{SAMPLES, SENSOR, Scenario, samples};

/// Miscalibration of Θ at sample k, radians: (rms, largest), the constant part removed.
fn miscalibration(scenario: Scenario, k: u32, parameters: Parameters, theta: &Theta) -> (f64, f64) {
    const POINTS: u32 = 90;
    let errors: Vec<f64> = (0..POINTS)
        .map(|i| {
            let alpha = TAU * f64::from(i) / f64::from(POINTS);
            let [c, s] = parameters.corrected(theta, scenario.signals(alpha, k));
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
    /// Largest difference of a parameter from the sensor's own, where the set can express it.
    parameter: Option<f64>,
    /// Miscalibration at the end, radians.
    rms: f64,
    largest: f64,
    /// Error of α̂ over the last tenth, radians rms.
    alpha_hat: f64,
    /// Periods travelled until the miscalibration stays within 10 % of its final value.
    periods: f64,
}

fn run(scenario: Scenario, method: &mut Method) -> Outcome {
    let (mut square, mut counted) = (0.0, 0.0);
    let mut course: Vec<(f64, f64)> = Vec::new();
    let mut last = None;
    for (sample, k) in samples(scenario).zip(0..SAMPLES) {
        let said = method.step(sample.y);
        if k >= SAMPLES / 10 * 9 {
            square += wrapped(said.alpha_hat - sample.alpha).powi(2);
            counted += 1.0;
        }
        if k % 60 == 0 {
            let rms = miscalibration(scenario, k, said.parameters, &said.theta).0;
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
    let (rms, largest) = miscalibration(scenario, SAMPLES, said.parameters, &said.theta);
    let expressible = said.parameters.count() % 2 == 1 && scenario != Scenario::ThirdHarmonic;
    let parameter = (expressible && scenario != Scenario::Drift)
        .then(|| (said.theta - said.parameters.from_five(SENSOR.theta())).amax());
    Outcome {
        parameter,
        rms,
        largest,
        alpha_hat: f64::sqrt(square / counted),
        periods: course[settled].0,
    }
}

/// Every method in these scenarios.
pub(crate) fn methods(design: &Design, scenarios: &[Scenario]) -> String {
    let mut csv = String::from(
        "method,scenario,parameter_error,miscalibration_rms_mrad,miscalibration_largest_mrad,alpha_hat_rms_mrad,periods\n",
    );
    for &scenario in scenarios {
        for (name, mut method) in Method::all(design) {
            let found = run(scenario, &mut method);
            let parameter = found
                .parameter
                .map_or(String::new(), |p| format!("{p:.2e}"));
            let [rms, largest, alpha_hat] =
                [found.rms, found.largest, found.alpha_hat].map(|x| 1e3 * x);
            _ = writeln!(
                csv,
                "\"{name}\",{},{parameter},{rms:.4},{largest:.4},{alpha_hat:.4},{:.1}",
                scenario.name(),
                found.periods
            );
        }
    }
    csv
}
