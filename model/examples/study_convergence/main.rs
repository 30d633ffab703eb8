//! Convergence of the calibration: the paper's Figure 7, and every method beside every other.
//!
//!     cargo run --release -p nonius-model --example study_convergence -- DESIGN.toml DIR
//!
//! writes `figure_7.csv` (five parameters converging to Heydemann's values: the paper in f64, and the bit-true chip of the
//! design, beside the values of Heydemann's least squares) and `methods.csv` (method × scenario).

mod method;
mod scenario;

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use method::{Method, OnChip};
use nonius_model::design::Design;
use nonius_model::reference::gate::Gate;
use nonius_model::reference::interpolator::Gamma;
use nonius_model::reference::{Parameters, Reference, Theta, from_spec, heydemann};
use nonius_model::spec::Spec;
use scenario::{SAMPLES, SENSOR, SPEED, Scenario, samples};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [design, folder] = &arguments[..] else {
        return Err("give a design and a folder: study_convergence DESIGN.toml DIR".into());
    };
    let spec = Spec::from_toml(&std::fs::read_to_string(design)?, design)?;
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    write(folder, "figure_7.csv", &figure_7(&spec)?)?;
    write(folder, "methods.csv", &methods(&Design::new(&spec)?))?;
    Ok(())
}

/// Under a temporary name first, so that no half of a file is ever there.
fn write(folder: &Path, name: &str, text: &str) -> std::io::Result<()> {
    let unfinished = folder.join(format!("{name}.unfinished"));
    std::fs::write(&unfinished, text)?;
    std::fs::rename(unfinished, folder.join(name))
}

/// Figure 7: θ1 … θ5 against periods travelled. The paper updates each sample with one γ; the chip is the design's.
fn figure_7(spec: &Spec) -> Result<String, Box<dyn std::error::Error>> {
    let set = Parameters::Five;
    let record: Vec<[f64; 2]> = samples(Scenario::ThirdHarmonic)
        .take(20_000)
        .map(|s| s.y)
        .collect();
    let target = set.from_five(heydemann::calibrate(&record)?.theta());
    let mut config = from_spec::config(spec)?;
    config.gamma = Gamma::constant(0.004);
    config.gate = Gate::EverySample;
    let mut paper = Method::Paper(set, Box::new(Reference::new(config)?));
    let mut chip = Method::Chip(Box::new(OnChip::of(&Design::new(spec)?)));
    let mut csv = String::from("periods");
    for source in ["paper", "chip", "heydemann"] {
        (1..=5).for_each(|i| _ = write!(csv, ",{source}_theta_{i}"));
    }
    csv.push('\n');
    for (k, y) in record.iter().enumerate() {
        let (paper, chip) = (paper.step(*y), chip.step(*y));
        if k % 20 == 0 {
            write!(csv, "{:.4}", SPEED * k as f64 / TAU)?;
            for theta in [&paper.theta, &chip.theta, &target] {
                theta
                    .iter()
                    .take(5)
                    .for_each(|t| _ = write!(csv, ",{t:.6}"));
            }
            csv.push('\n');
        }
    }
    Ok(csv)
}

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

fn wrapped(x: f64) -> f64 {
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

/// Every method in every scenario.
fn methods(design: &Design) -> String {
    let mut csv = String::from(
        "method,scenario,parameter_error,miscalibration_rms_mrad,miscalibration_largest_mrad,alpha_hat_rms_mrad,periods\n",
    );
    for scenario in Scenario::ALL {
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
