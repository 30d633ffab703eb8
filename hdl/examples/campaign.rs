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
use nonius_model::spec::{All, CalibrationMethod, CalibrationStart, Multipliers, Spec};

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
    let (rows, step) = if docs.is_some() {
        (LONG, 1)
    } else {
        (SHORT, 6)
    };
    let mut outcomes = vec![];
    for variant in variants().into_iter().step_by(step) {
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

fn variant(what: &str, spec: Spec) -> Variant {
    let number = match spec.chip.multipliers {
        Multipliers::Count(n) => n.to_string(),
        Multipliers::All(_) => "all".into(),
    };
    let (method, filter_type) = (spec.tracking.method, spec.tracking.filter_type);
    let (parameters, bits) = (spec.calibration.parameters, spec.adc.bits);
    Variant {
        what: format!("{what} | {method} | {filter_type} | {parameters} | {number} | {bits}"),
        spec,
    }
}

/// The shipped designs; ADC widths; every number of multipliers; every search and parameter set; then every method and
/// type with four and five parameters, on one multiplier and on as many as there are products.
fn variants() -> Vec<Variant> {
    let all = Multipliers::All(All::All);
    let base = shipped::optical();
    let with = |what: &str, change: &dyn Fn(&mut Spec)| {
        let mut spec = base.clone();
        change(&mut spec);
        variant(what, spec)
    };
    let mut list = vec![];
    for name in shipped::NAMES {
        list.push(variant(name, shipped::spec(name)));
    }
    for bits in [8, 16, 18] {
        list.push(with("optical", &|s| {
            s.adc.bits = bits;
            s.sensor.noise_rms = 0.0;
            s.accuracy.rms_periods = 60e-6 * 2f64.powi(12 - bits as i32);
        }));
    }
    for multipliers in [2, 3, 5].map(Multipliers::Count).into_iter().chain([all]) {
        list.push(with("optical", &|s| s.chip.multipliers = multipliers));
    }
    for (what, method, parameters, completion) in [
        ("completed", CalibrationMethod::Final, 8, true),
        ("completed", CalibrationMethod::Final, 9, true),
        ("radius alone", CalibrationMethod::Final, 9, false),
        ("exact", CalibrationMethod::Exact, 4, false),
        ("exact", CalibrationMethod::Exact, 5, false),
        ("sum of squares", CalibrationMethod::SumOfSquares, 4, false),
        ("sum of squares", CalibrationMethod::SumOfSquares, 5, false),
        ("batch", CalibrationMethod::Batch, 4, false),
        ("batch", CalibrationMethod::Batch, 5, false),
    ] {
        list.push(with(what, &|s| {
            s.calibration.method = method;
            s.calibration.parameters = parameters;
            s.calibration.completion = completion;
        }));
    }
    for (what, method, parameters) in [
        ("started", CalibrationMethod::Final, 4),
        ("started", CalibrationMethod::Final, 5),
        ("started", CalibrationMethod::Final, 9),
        ("started, exact", CalibrationMethod::Exact, 5),
    ] {
        list.push(with(what, &|s| {
            s.calibration.start = CalibrationStart::LeastSquares;
            s.calibration.method = method;
            s.calibration.parameters = parameters;
        }));
    }
    for (what, filter_type, parameters, multipliers, delay) in [
        ("skewed", 2, 5, Multipliers::Count(1), 1e-7),
        ("skewed", 2, 9, all, -3e-7),
        ("skewed", 1, 4, Multipliers::Count(1), 1e-6),
        ("skewed, first order", 1, 5, all, 1e-9),
    ] {
        list.push(with(what, &|s| {
            s.tracking.filter_type = filter_type;
            if filter_type == 1 {
                s.sensor.speed_max_periods_per_s = 1e3;
            }
            s.calibration.parameters = parameters;
            s.chip.multipliers = multipliers;
            s.correction.channel_skew_s = delay;
        }));
    }
    list.push(with("completed", &|s| {
        s.calibration.parameters = 9;
        s.chip.multipliers = all;
    }));
    list.push(with("fixed", &|s| s.calibration.parameters = 0));
    for (method, filter_type) in [(1, 1), (1, 2), (2, 1), (3, 1), (3, 2)] {
        for parameters in [4, 5] {
            for multipliers in [Multipliers::Count(1), all] {
                if (method, filter_type, parameters) == (3, 2, 5) {
                    continue;
                }
                list.push(with("optical", &|s| {
                    s.tracking.method = method;
                    s.tracking.filter_type = filter_type;
                    if filter_type == 1 {
                        // It lags at speed: asked to follow less.
                        s.sensor.speed_max_periods_per_s = 1e3;
                    }
                    s.calibration.parameters = parameters;
                    s.chip.multipliers = multipliers;
                }));
            }
        }
    }
    list
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
(standstill, both directions, sweep, step, corners, bounds, ties, random codes) in which every probe and register of the
Verilog equals the model. A variant that is missing was not run.

| design | method | type | parameters | multipliers | ADC bits | Verilator | Icarus |
|---|---|---|---|---|---|---|---|
";
