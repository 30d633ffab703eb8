//! The paper's Figure 7.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use nonius_model::design::Design;
use nonius_model::reference::gate::Gate;
use nonius_model::reference::interpolator::Gamma;
use nonius_model::reference::{Parameters, Reference, from_spec, heydemann};
use nonius_model::spec::Spec;
use plotters::style::RGBColor;

use crate::method::Method;
use crate::on_chip::OnChip;
use crate::plot::{self, COLOURS, Line};
use crate::scenario::{SPEED, Scenario, samples};

/// Figure 7: θ1 … θ5 against periods travelled. The paper updates each sample with one γ; the chip is the design's.
pub(crate) fn figure_7(spec: &Spec, folder: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let set = Parameters::Five;
    let record: Vec<[f64; 2]> = samples(Scenario::Drift).take(10_000).map(|s| s.y).collect();
    let target = set.from_five(heydemann::calibrate(&record)?.theta());
    let mut config = from_spec::config(spec)?;
    config.gamma = Gamma::constant(0.01);
    config.gate = Gate::EverySample;
    let mut paper = Method::Paper(set, Box::new(Reference::new(config)?));
    let mut chip = Method::Chip(Box::new(OnChip::of(Design::new(spec)?)));
    let mut csv = String::from("periods");
    for source in ["paper", "chip", "heydemann"] {
        (1..=5).for_each(|i| _ = write!(csv, ",{source}_theta_{i}"));
    }
    csv.push('\n');
    let mut drawn: Vec<Line> = (0..15).map(line).collect();
    for (k, y) in record.iter().enumerate() {
        let (paper, chip) = (paper.step(*y), chip.step(*y));
        if k % 20 != 0 {
            continue;
        }
        let periods = SPEED * k as f64 / TAU;
        write!(csv, "{periods:.4}")?;
        for (source, theta) in [&paper.theta, &chip.theta, &target].into_iter().enumerate() {
            for (i, theta) in theta.iter().take(5).enumerate() {
                write!(csv, ",{theta:.6}")?;
                drawn[5 * source + i].points.push((periods, *theta));
            }
        }
        csv.push('\n');
    }
    crate::write(folder, "figure_7.csv", &csv)?;
    plot::lines(
        &folder.join("figure_7.svg"),
        "Five parameters: paper (thick), bit-true chip (light), Heydemann (dashed)",
        ["periods travelled", "theta"],
        (0.0..40.0, -0.2..1.3),
        &drawn,
    )
}

/// Lines 0 … 4 are the paper's, then the chip's, then Heydemann's.
fn line(n: usize) -> Line {
    let [r, g, b] = {
        let RGBColor(r, g, b) = COLOURS[n % 5];
        let lighter = |x: u8| if n / 5 == 1 { x / 2 + 127 } else { x };
        [r, g, b].map(lighter)
    };
    Line {
        name: if n < 5 {
            format!("theta {}", n + 1)
        } else {
            String::new()
        },
        colour: RGBColor(r, g, b),
        dashed: n >= 10,
        points: Vec::new(),
    }
}
