//! A long run of mixed stimuli for every variant of the chip, in Verilator and in Icarus.
//!
//!     cargo run --release -p nonius-hdl --example bit_exact -- DOCS
//!     cargo run -p nonius-hdl --example bit_exact -- --short
//!
//! The first writes DOCS/bit-exact.md; chips whose row there is of the same files (rtl, testbench, stimuli) are not run again.
//! The second runs few samples of few variants and writes nothing: the form for every commit.
//! Exit code 1 if any bit of any probe differs.

mod row;
#[path = "../../../designs/shipped.rs"]
mod shipped;

use std::env;
use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::Duration;

use nonius_hdl::progress::silent;
use nonius_hdl::{ChipDir, Options, verify};
use nonius_model::design::Design;
use nonius_model::spec::Spec;
use rayon::prelude::*;
use row::{HEAD, begins, described};
use shipped::variants::{Variant, everything};

/// Rows of each stimulus: at least 100 000 samples for Verilator, 2 000 for Icarus.
const LONG: (usize, usize) = (5_600, 112);
const SHORT: (usize, usize) = (60, 60);

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let docs = match arguments.as_slice() {
        [short] if short == "--short" => None,
        [docs] if !docs.starts_with('-') => Some(Path::new(docs)),
        _ => {
            eprintln!("usage: bit_exact DOCS | bit_exact --short");
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
    let Some(docs) = docs else {
        let some: Vec<Variant> = everything().into_iter().step_by(50).collect();
        let lines: Result<Vec<String>, String> =
            some.par_iter().map(|v| run_one(v, SHORT)).collect();
        let page = lines?.concat();
        print!("{page}");
        return Ok(!page.contains(FAIL));
    };
    let file = docs.join("bit-exact.md");
    let known = fs::read_to_string(&file).unwrap_or_default();
    let variants = everything();
    let before = variants.iter().map(|variant| earlier(variant, &known));
    let lines: Mutex<Vec<Option<String>>> = Mutex::new(before.collect());
    let all: Result<(), String> = variants
        .par_iter()
        .enumerate()
        .try_for_each(|(i, variant)| {
            let begins = begins(&variant.what, &variant.spec)?;
            let same = known
                .lines()
                .find(|line| line.starts_with(&begins) && !line.contains(FAIL));
            let line = match same {
                Some(line) => format!("{line}\n"),
                None => run_one(variant, LONG)?,
            };
            eprint!("{line}");
            // What has been measured so far, should somebody stop the campaign.
            let mut lines = lines.lock().map_err(|e| e.to_string())?;
            lines[i] = Some(line);
            write(docs, &file, &page(&lines)).map_err(|e| e.to_string())
        });
    all?;
    let lines = lines.into_inner()?;
    Ok(!page(&lines).contains(FAIL))
}

/// The row that the page has of this variant, as one of a chip that has changed since.
fn earlier(variant: &Variant, known: &str) -> Option<String> {
    let begins = format!("| {} | ", described(&variant.what, &variant.spec));
    let row = known.lines().find_map(|line| line.strip_prefix(&begins))?;
    let (_, results) = row.split_once(" | ")?;
    Some(format!("{begins}earlier | {results}\n")).filter(|row| !row.contains(FAIL))
}

/// What a row says where something differs.
const FAIL: &str = "**FAIL**";

/// Under a temporary name first.
fn write(docs: &Path, file: &Path, page: &str) -> std::io::Result<()> {
    fs::create_dir_all(docs)?;
    let scratch = file.with_extension("part");
    fs::write(&scratch, page)?;
    fs::rename(scratch, file)
}

/// A chip in both simulators: its line.
fn run_one(variant: &Variant, rows: (usize, usize)) -> Result<String, String> {
    let say = |rows: usize, verilator: bool| {
        let samples = samples(&variant.spec, rows, verilator).map_err(|e| e.to_string())?;
        Ok::<_, String>(match samples {
            Ok(samples) => format!("{samples} equal"),
            Err(why) => format!("{FAIL} {why}"),
        })
    };
    Ok(format!(
        "{} {} | {} |\n",
        begins(&variant.what, &variant.spec)?,
        say(rows.0, true)?,
        say(rows.1, false)?
    ))
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

fn page(lines: &[Option<String>]) -> String {
    let lines: String = lines.iter().flatten().map(String::as_str).collect();
    format!("{HEAD}{lines}")
}
