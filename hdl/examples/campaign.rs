//! A long run of mixed stimuli for every variant of the chip, in Verilator and in Icarus.
//!
//!     cargo run --release -p nonius-hdl --example campaign -- DOCS
//!     cargo run -p nonius-hdl --example campaign -- --short
//!
//! The first writes DOCS/bit-exact.md. The second runs few samples of few variants and writes nothing: the form for
//! every commit.
//! Exit code 1 if any bit of any probe differs.

use std::env;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use nonius_hdl::progress::silent;
use nonius_hdl::{ChipDir, Options, verify};
use nonius_model::design::Design;
use nonius_model::spec::{All, CalibrationMethod, Multipliers, Spec};

/// Rows of each of the nine stimuli: at least 100 000 samples for Verilator, 2 000 for Icarus.
const LONG: (usize, usize) = (11_200, 230);
const SHORT: (usize, usize) = (60, 60);

struct Variant {
    what: String,
    spec: Spec,
}

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
    let designs = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../designs/optical.toml");
    let base = Spec::from_toml(&fs::read_to_string(designs)?, "optical.toml")?;
    let (rows, step) = if docs.is_some() {
        (LONG, 1)
    } else {
        (SHORT, 13)
    };
    let mut outcomes = vec![];
    for variant in variants(&base).into_iter().step_by(step) {
        let outcome = Outcome {
            verilator: samples(&variant.spec, rows.0, true)?,
            icarus: samples(&variant.spec, rows.1, false)?,
            what: variant.what,
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

/// Every method and type, parameter set and number of multipliers; then the widths of the ADC.
fn variants(base: &Spec) -> Vec<Variant> {
    let counts = [1, 2, 3, 5].map(Multipliers::Count);
    let mut all = vec![];
    for (method, filter_type) in [(1, 1), (1, 2), (2, 1), (3, 1), (3, 2)] {
        for parameters in [0, 4, 5] {
            for multipliers in counts.into_iter().chain([Multipliers::All(All::All)]) {
                let mut spec = base.clone();
                spec.tracking.method = method;
                spec.tracking.filter_type = filter_type;
                if filter_type == 1 {
                    // It lags at speed: asked to follow less.
                    spec.sensor.speed_max_periods_per_s = 1e3;
                }
                spec.calibration.parameters = parameters;
                spec.chip.multipliers = multipliers;
                let number = match multipliers {
                    Multipliers::Count(n) => n.to_string(),
                    Multipliers::All(_) => "all".into(),
                };
                let what = format!("{method} | {filter_type} | {parameters} | {number} | 12");
                all.push(Variant { what, spec });
            }
        }
    }
    for (method, parameters, completion) in [
        (CalibrationMethod::Final, 8, true),
        (CalibrationMethod::Final, 9, true),
        (CalibrationMethod::Final, 9, false),
        (CalibrationMethod::Exact, 4, false),
        (CalibrationMethod::Exact, 5, false),
        (CalibrationMethod::SumOfSquares, 4, false),
        (CalibrationMethod::SumOfSquares, 5, false),
        (CalibrationMethod::Batch, 4, false),
        (CalibrationMethod::Batch, 5, false),
    ] {
        for multipliers in [Multipliers::Count(1), Multipliers::All(All::All)] {
            let mut spec = base.clone();
            spec.calibration.method = method;
            spec.calibration.parameters = parameters;
            spec.calibration.completion = completion;
            spec.chip.multipliers = multipliers;
            let number = match multipliers {
                Multipliers::Count(n) => n.to_string(),
                Multipliers::All(_) => "all".into(),
            };
            let how = match method {
                CalibrationMethod::Final if completion => "completed",
                CalibrationMethod::Final => "bends, radius alone",
                CalibrationMethod::Exact => "exact",
                CalibrationMethod::SumOfSquares => "sum of squares",
                CalibrationMethod::Batch => "batch",
            };
            let what = format!("3 | 2 | {parameters}, {how} | {number} | 12");
            all.push(Variant { what, spec });
        }
    }
    for bits in [8, 10, 14, 16, 18] {
        let mut spec = base.clone();
        spec.adc.bits = bits;
        spec.sensor.noise_rms = 0.0;
        spec.accuracy.rms_periods = 60e-6 * 2f64.powi(12 - bits as i32);
        let what = format!("3 | 2 | 5 | 1 | {bits}");
        all.push(Variant { what, spec });
    }
    all
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
(standstill, both directions, sweep, step, corners, bounds, ties, random codes) in which every probe and register of the
Verilog equals the model. A variant that is missing was not run.

| method | type | parameters | multipliers | ADC bits | Verilator | Icarus |
|---|---|---|---|---|---|---|
";
