//! Convergence of the calibration: the paper's Figure 7, and every method beside every other.
//!
//!     cargo run --release -p nonius-model --example study_convergence -- DESIGN.toml DIR [COSTS.csv]
//!
//! writes `figure_7.csv` and `.svg` (five parameters converging to Heydemann's values: the paper in f64, and the bit-true
//! chip of the design, beside the values of Heydemann's least squares), `methods.csv` and `methods.md` (method × scenario; clocks and LUTs from
//! the file that `nonius-hdl`'s example `costs` writes), and `null_direction.svg` and `third_harmonics.svg` (what section 5.4 cannot see, and what the completion makes of it).

mod costs;
mod figure_7;
mod figure_7_plot;
mod limit;
mod method;
mod on_chip;
mod page;
mod plot;
mod scenario;
#[path = "../../../designs/shipped.rs"]
mod shipped;
mod singular;
mod table;
mod truth;

use std::path::Path;

use nonius_model::design::Design;
use nonius_model::spec::Spec;

use costs::Costs;
use scenario::Scenario;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let ([design, folder] | [design, folder, _]) = &arguments[..] else {
        return Err(
            "give a design and a folder: study_convergence DESIGN.toml DIR [COSTS.csv]".into(),
        );
    };
    let costs = match arguments.get(2) {
        Some(file) => Costs::read(&std::fs::read_to_string(file)?),
        None => Costs::default(),
    };
    let spec = Spec::from_toml(&std::fs::read_to_string(design)?, design)?;
    let folder = Path::new(folder);
    std::fs::create_dir_all(folder)?;
    let course = figure_7::figure_7(&spec)?;
    write(folder, "figure_7.csv", &figure_7::csv(&course))?;
    write(folder, "figure_7.svg", &figure_7_plot::plot(&course)?)?;
    write(folder, "null_direction.svg", &singular::effect()?)?;
    write(folder, "third_harmonics.svg", &singular::order_2()?)?;
    let csv = table::methods(&Design::new(&spec)?, &Scenario::ALL, &costs);
    write(folder, "methods.csv", &csv)?;
    write(folder, "methods.md", &page::page(&csv))?;
    Ok(())
}

/// Under a temporary name first, so that no half of a file is ever there.
fn write(folder: &Path, name: &str, text: &str) -> std::io::Result<()> {
    let unfinished = folder.join(format!("{name}.unfinished"));
    std::fs::write(&unfinished, text)?;
    std::fs::rename(unfinished, folder.join(name))
}
