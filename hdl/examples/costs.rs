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
use nonius_model::spec::Calibration;
use shipped::variants::costed;

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

fn run(docs: &Path) -> Result<(), Box<dyn Error>> {
    let mut page = String::from(HEAD);
    let mut csv = String::from("method,start,parameters,completion,clocks,lut4\n");
    let mut bare = 0;
    for variant in costed() {
        let design = variant.design();
        let Calibration {
            method,
            start,
            parameters,
            completion,
            recall,
            lag,
            ..
        } = variant.spec.calibration;
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
            "| {} | {parameters} | {products} | {} | {} | {} | {} |",
            variant.what,
            products - bare,
            package.json.clocks_per_sample,
            placed.chip.lut4,
            placed.chip.ff
        )?;
        let (clocks, luts) = (package.json.clocks_per_sample, placed.chip.lut4);
        // The comparison of convergence knows no losses.
        if recall.is_none() && lag.is_none() {
            writeln!(
                csv,
                "{method:?},{start:?},{parameters},{completion},{clocks},{luts}"
            )?;
        }
        eprintln!("{}, {parameters} parameters", variant.what);
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
