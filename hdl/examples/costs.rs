//! What each on-line calibration costs on one multiplier: products and clocks a sample, cells of an iCE40.
//!
//!     cargo run --release -p nonius-hdl --example costs -- docs
//!
//! writes docs/on-line-costs.md, and .csv for the table of convergence, for the optical design with each method and parameter set. Some minutes of Yosys.

#[path = "../../designs/shipped.rs"]
mod shipped;

use std::env;
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use nonius_hdl::ChipDir;
use nonius_hdl::place::{Device, place};
use nonius_hdl::progress::silent;
use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, CalibrationStart};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [docs] = arguments.as_slice() else {
        eprintln!("usage: costs DOCS");
        return ExitCode::from(2);
    };
    match run(Path::new(docs)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("costs: {error}");
            ExitCode::from(2)
        }
    }
}

use CalibrationMethod::{Batch, Exact, Final, SumOfSquares};
use CalibrationStart::{Gears, LeastSquares};

/// Name, method, start, parameters, completion.
const CHIPS: [(&str, CalibrationMethod, CalibrationStart, u32, bool); 17] = [
    ("none", Final, Gears, 0, false),
    ("residual, final form", Final, Gears, 4, false),
    ("residual, final form", Final, Gears, 5, false),
    ("residual, final form", Final, Gears, 8, false),
    ("residual, final form", Final, Gears, 9, false),
    ("residual, completed", Final, Gears, 8, true),
    ("residual, completed", Final, Gears, 9, true),
    ("residual, exact", Exact, Gears, 4, false),
    ("residual, exact", Exact, Gears, 5, false),
    ("sum of squares, λ", SumOfSquares, Gears, 4, false),
    ("sum of squares, λ", SumOfSquares, Gears, 5, false),
    ("sum of squares, batch", Batch, Gears, 4, false),
    ("sum of squares, batch", Batch, Gears, 5, false),
    (
        "final form, started by least squares",
        Final,
        LeastSquares,
        4,
        false,
    ),
    (
        "final form, started by least squares",
        Final,
        LeastSquares,
        5,
        false,
    ),
    (
        "completed, started by least squares",
        Final,
        LeastSquares,
        9,
        true,
    ),
    (
        "exact, started by least squares",
        Exact,
        LeastSquares,
        5,
        false,
    ),
];

fn run(docs: &Path) -> Result<(), Box<dyn Error>> {
    let base = shipped::optical();
    let mut page = String::from(HEAD);
    let mut csv = String::from("method,start,parameters,completion,clocks,lut4\n");
    let mut bare = 0;
    for (name, method, start, parameters, completion) in CHIPS {
        let mut spec = base.clone();
        spec.calibration.method = method;
        spec.calibration.start = start;
        spec.calibration.parameters = parameters;
        spec.calibration.completion = completion;
        let design = Design::new(&spec)?;
        let dir = tempfile::tempdir()?;
        let package = nonius_package::package(&design, 10)?;
        nonius_package::write(&package.files, dir.path())?;
        let placed = place(&ChipDir::open(dir.path())?, Device::Hx8k, &[], &silent)?;
        let products = package.json.products;
        if parameters == 0 {
            bare = products;
        }
        writeln!(
            page,
            "| {name} | {parameters} | {products} | {} | {} | {} | {} |",
            products - bare,
            package.json.clocks_per_sample,
            placed.chip.lut4,
            placed.chip.ff
        )?;
        let (clocks, luts) = (package.json.clocks_per_sample, placed.chip.lut4);
        writeln!(
            csv,
            "{method:?},{start:?},{parameters},{completion},{clocks},{luts}"
        )?;
        eprintln!("{name}, {parameters} parameters");
    }
    std::fs::create_dir_all(docs)?;
    write(docs, "on-line-costs.md", &page)?;
    write(docs, "on-line-costs.csv", &csv)?;
    print!("{page}");
    Ok(())
}

/// Under a temporary name first.
fn write(docs: &Path, name: &str, text: &str) -> std::io::Result<()> {
    let scratch = docs.join(format!("{name}.part"));
    std::fs::write(&scratch, text)?;
    std::fs::rename(scratch, docs.join(name))
}

const HEAD: &str = "\
# What on-line calibration costs

Written by `cargo run --release -p nonius-hdl --example costs -- docs`; do not edit. The optical design (12 bits, one
multiplier) with each method and parameter set; Yosys `synth_ice40`, HX8K. *More* is what calibration adds to the
products of the bare loop and fixed correction.

| method | parameters | products | more | clocks per sample | LUT4 | FF |
|---|---|---|---|---|---|---|
";
