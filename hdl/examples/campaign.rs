//! A long run of mixed stimuli for every variant of the chip, in Verilator and in Icarus.
//!
//!     cargo run --release -p nonius-hdl --example campaign -- DOCS
//!     cargo run -p nonius-hdl --example campaign -- --short
//!
//! The first writes DOCS/bit-exact.md. The second runs few samples of few variants and writes nothing: the form for
//! every commit.
//! Exit code 1 if any bit of any probe differs.

#[path = "../../designs/shipped.rs"]
mod shipped;

use std::env;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use nonius_hdl::progress::silent;
use nonius_hdl::{ChipDir, Options, verify};
use nonius_model::design::Design;
use nonius_model::spec::{Multipliers, Spec};
use shipped::variants::{Variant, everything};

/// Rows of each of the eleven stimuli: at least 100 000 samples for Verilator, 2 000 for Icarus.
const LONG: (usize, usize) = (9_200, 190);
const SHORT: (usize, usize) = (60, 60);

struct Outcome {
    what: String,
    /// Samples compared, or what did not hold.
    verilator: Result<u64, String>,
    icarus: Result<u64, String>,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let docs = match arguments.as_slice() {
        [short] if short == "--short" => None,
        [docs] if !docs.starts_with('-') => Some(Path::new(docs)),
        _ => {
            eprintln!("usage: campaign DOCS | campaign --short");
            return ExitCode::from(2);
        }
    };
    match run(docs) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("campaign: {error}");
            ExitCode::from(2)
        }
    }
}

/// With a folder for the page the long campaign, without one the short.
fn run(docs: Option<&Path>) -> Result<bool, Box<dyn Error>> {
    let (rows, step) = if docs.is_some() {
        (LONG, 1)
    } else {
        (SHORT, 20)
    };
    let mut outcomes = vec![];
    for variant in everything().into_iter().step_by(step) {
        let outcome = Outcome {
            verilator: samples(&variant.spec, rows.0, true)?,
            icarus: samples(&variant.spec, rows.1, false)?,
            what: described(&variant),
        };
        eprintln!("{}", line(&outcome).trim_end());
        outcomes.push(outcome);
        // What has been measured so far, should somebody stop the campaign.
        if let Some(docs) = docs {
            fs::create_dir_all(docs)?;
            fs::write(docs.join("bit-exact.md"), page(&outcomes))?;
        }
    }
    Ok(outcomes
        .iter()
        .all(|o| o.verilator.is_ok() && o.icarus.is_ok()))
}

/// Its line in the table.
fn described(variant: &Variant) -> String {
    let spec = &variant.spec;
    let multipliers = match spec.chip.multipliers {
        Multipliers::Count(n) => n.to_string(),
        Multipliers::All(_) => "all".into(),
    };
    format!(
        "{} | {} | {} | {} | {multipliers} | {}",
        variant.what,
        spec.tracking.method,
        spec.tracking.filter_type,
        spec.calibration.parameters,
        spec.adc.bits
    )
}

fn samples(
    spec: &Spec,
    rows: usize,
    verilator: bool,
) -> Result<Result<u64, String>, Box<dyn Error>> {
    let design = match Design::new(spec) {
        Ok(design) => design,
        Err(refused) => return Ok(Err(format!("design refused: {refused}"))),
    };
    let dir = tempfile::tempdir()?;
    let package = nonius_package::package(&design, rows)?;
    nonius_package::write(&package.files, dir.path())?;
    // The package is written; what the simulator reads is only what a user has.
    ChipDir::open(dir.path())?;
    let options = Options {
        icarus: !verilator,
        verilator,
        time_limit: Some(Duration::from_secs(1800)),
        stop_at_first: false,
    };
    let report = verify(dir.path(), &options, &silent)?;
    let run = report.runs.first().ok_or("no simulator ran")?;
    let counted = run
        .samples
        .ok_or("the testbench does not say how many samples");
    Ok(if report.passed {
        Ok(counted?)
    } else {
        Err(run.failure.clone().unwrap_or_default().replace('\n', " "))
    })
}

fn line(outcome: &Outcome) -> String {
    let say = |result: &Result<u64, String>| match result {
        Ok(samples) => format!("{samples} equal"),
        Err(why) => format!("**FAIL** {why}"),
    };
    format!(
        "| {} | {} | {} |\n",
        outcome.what,
        say(&outcome.verilator),
        say(&outcome.icarus)
    )
}

fn page(outcomes: &[Outcome]) -> String {
    let lines: String = outcomes.iter().map(line).collect();
    format!("{HEAD}{lines}")
}

const HEAD: &str = "\
# Bit-exactness

Written by `cargo run --release -p nonius-hdl --example campaign -- docs`; do not edit. Samples of mixed stimuli
(standstill, both directions, sweep, creep, loss of signal, step, corners, bounds, ties, random codes) in which every probe and register of the
Verilog equals the model. A variant that is missing was not run.

| design | method | type | parameters | multipliers | ADC bits | Verilator | Icarus |
|---|---|---|---|---|---|---|---|
";
