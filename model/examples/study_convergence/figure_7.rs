//! The paper's Figure 7: θ1 … θ5 against periods travelled.

use std::f64::consts::TAU;
use std::fmt::Write as _;

use nonius_model::design::Design;
use nonius_model::reference::gate::Gate;
use nonius_model::reference::interpolator::Gamma;
use nonius_model::reference::{Parameters, Reference, from_spec, heydemann};
use nonius_model::spec::Spec;

use super::method::Method;
use super::on_chip::OnChip;
use super::scenario::{SENSOR, SPEED, Scenario, samples};

/// Who says the parameters.
pub(crate) const SOURCES: [&str; 3] = ["paper", "chip", "heydemann"];

/// Periods travelled, and θ1 … θ5 of each source.
pub(crate) type Row = (f64, [[f64; 5]; 3]);

/// The course of the parameters of a sensor that stays what it is, at 0.1 % noise. The paper updates each sample with one γ; the chip
/// is the design's.
pub(crate) fn figure_7(spec: &Spec) -> Result<Vec<Row>, Box<dyn std::error::Error>> {
    let set = Parameters::Five;
    // The beginning, before it stands still.
    let record = samples(Scenario::Standstill, &SENSOR).take(10_000);
    let record: Vec<[f64; 2]> = record.map(|s| s.y).collect();
    let target = set.from_five(heydemann::calibrate(&record)?.theta());
    let mut config = from_spec::config(spec)?;
    config.gamma = Gamma::constant(0.01);
    config.gate = Gate::EverySample;
    config.hold = None;
    let mut paper = Method::Paper(set, Box::new(Reference::new(config)?));
    let mut chip = Method::Chip(Box::new(OnChip::of(Design::new(spec)?)));
    let mut rows = vec![];
    for (k, y) in record.iter().enumerate() {
        let (paper, chip) = (paper.step(*y), chip.step(*y));
        if k % 20 == 0 {
            let theta = [&paper.theta, &chip.theta, &target];
            let five = theta.map(|theta| std::array::from_fn(|i| theta[i]));
            rows.push((SPEED * k as f64 / TAU, five));
        }
    }
    Ok(rows)
}

/// As a table.
pub(crate) fn csv(rows: &[Row]) -> String {
    let mut csv = String::from("periods");
    for source in SOURCES {
        (1..=5).for_each(|i| _ = write!(csv, ",{source}_theta_{i}"));
    }
    csv.push('\n');
    for (periods, theta) in rows {
        _ = write!(csv, "{periods:.4}");
        for theta in theta.iter().flatten() {
            _ = write!(csv, ",{theta:.6}");
        }
        csv.push('\n');
    }
    csv
}
