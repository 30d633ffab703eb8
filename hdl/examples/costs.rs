//! What each on-line calibration costs on one multiplier: products and clocks a sample, cells of an iCE40.
//!
//!     cargo run --release -p nonius-hdl --example costs -- docs
//!
//! writes docs/on-line-costs.md for the optical design with each method and parameter set. Some minutes of Yosys.

use std::env;
use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use nonius_hdl::ChipDir;
use nonius_hdl::place::{Device, place};
use nonius_hdl::progress::silent;
use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, Spec};

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

/// Name, method, parameters, completion.
const CHIPS: [(&str, CalibrationMethod, u32, bool); 12] = [
    ("none", CalibrationMethod::Final, 0, false),
    ("residual, final form", CalibrationMethod::Final, 4, false),
    ("residual, final form", CalibrationMethod::Final, 5, false),
    ("residual, final form", CalibrationMethod::Final, 8, false),
    ("residual, final form", CalibrationMethod::Final, 9, false),
    ("residual, completed", CalibrationMethod::Final, 8, true),
    ("residual, completed", CalibrationMethod::Final, 9, true),
    ("residual, exact", CalibrationMethod::Exact, 4, false),
    ("residual, exact", CalibrationMethod::Exact, 5, false),
    (
        "sum of squares, λ",
        CalibrationMethod::SumOfSquares,
        4,
        false,
    ),
    (
        "sum of squares, λ",
        CalibrationMethod::SumOfSquares,
        5,
        false,
    ),
    ("sum of squares, batch", CalibrationMethod::Batch, 5, false),
];

fn run(docs: &Path) -> Result<(), Box<dyn Error>> {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../designs/optical.toml");
    let base = Spec::from_toml(&std::fs::read_to_string(file)?, "optical.toml")?;
    let mut page = String::from(HEAD);
    let mut bare = 0;
    for (name, method, parameters, completion) in CHIPS {
        let mut spec = base.clone();
        spec.calibration.method = method;
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
        eprintln!("{name}, {parameters} parameters");
    }
    std::fs::create_dir_all(docs)?;
    let path = docs.join("on-line-costs.md");
    let scratch = docs.join("on-line-costs.md.part");
    std::fs::write(&scratch, &page)?;
    std::fs::rename(scratch, path)?;
    print!("{page}");
    Ok(())
}

const HEAD: &str = "\
# What on-line calibration costs

Written by `cargo run --release -p nonius-hdl --example costs -- docs`; do not edit. The optical design (12 bits, one
multiplier) with each method and parameter set; Yosys `synth_ice40`, HX8K. *More* is what calibration adds to the
products of the bare loop and fixed correction.

| method | parameters | products | more | clocks per sample | LUT4 | FF |
|---|---|---|---|---|---|---|
";
