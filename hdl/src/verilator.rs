//! The testbench in Verilator, and Verilator's lint.
//!
//! Registers start with random bits (of a fixed seed): what is not reset shows as a
//! difference, as it does with the X of Icarus.

use std::path::Path;
use std::time::Duration;

use crate::chip_dir::{ChipDir, TESTBENCH};
use crate::error::Error;
use crate::process::{Job, Output};
use crate::progress::{Event, Progress};
use crate::run::Run;
use crate::tools::{Found, Tool, require};
use crate::verdict::judge;

const BUILD_LIMIT: Duration = Duration::from_secs(900);
const LINT_LIMIT: Duration = Duration::from_secs(120);

/// How much work the C++ compiler puts in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Short vectors: the build takes longer than the run, so do not optimise.
    QuickBuild,
    /// Long vectors: let the run be fast.
    QuickRun,
}

impl Effort {
    /// What is quicker in all for so many rows of vectors: up to some thousand an optimised build takes longer than the run it
    /// saves.
    pub fn for_rows(rows: u64) -> Effort {
        if rows < 10_000 {
            Effort::QuickBuild
        } else {
            Effort::QuickRun
        }
    }

    /// Verilator's own part is the same for every chip, and kept by ccache: it is always made to run fast.
    fn make_flags(self) -> &'static str {
        match self {
            Effort::QuickBuild => "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O2",
            Effort::QuickRun => "OPT_FAST=-O1 OPT_SLOW=-O0 OPT_GLOBAL=-O2",
        }
    }
}

/// Compiles with all warnings and simulates; stops the simulation at the limit.
pub fn simulate(
    chip: &ChipDir,
    effort: Effort,
    limit: Duration,
    plusargs: &[&str],
    progress: Progress,
) -> Result<Run, Error> {
    let [verilator, _, _] = require([Tool::Verilator, Tool::Cxx, Tool::Make])?;
    let scratch = tempfile::tempdir().map_err(Error::Scratch)?;

    progress(Event::Building(Tool::Verilator));
    let built = build(chip, effort, &verilator, scratch.path())?;
    let warnings = warnings_in(&built.stderr);
    if let Some(trouble) = built.trouble() {
        progress(Event::Finished(Tool::Verilator));
        return Ok(Run::refused(&verilator, &trouble, &built, warnings));
    }

    progress(Event::Simulating(Tool::Verilator));
    let program = scratch.path().join(format!("V{TESTBENCH}"));
    let simulated = Job::new(&program, &chip.root, limit)
        .args(["+verilator+rand+reset+2", "+verilator+seed+1"])
        .args(plusargs)
        .run()?;
    progress(Event::Finished(Tool::Verilator));
    let verdict = judge(&simulated, &chip.stimuli);
    Ok(Run::judged(
        &verilator, &built, warnings, &simulated, verdict,
    ))
}

fn build(chip: &ChipDir, effort: Effort, verilator: &Found, to: &Path) -> Result<Output, Error> {
    // In one piece the compiler reads the headers once.
    let mut job = Job::new(&verilator.path, &chip.root, BUILD_LIMIT).args(["--output-split", "0"]);
    // Verilator's own part is the same for every chip.
    if let Ok(ccache) = Tool::Ccache.find() {
        job = job.env("OBJCACHE", ccache.path);
    }
    job.args(["--binary", "--timing", "-O3", "-j", "2"])
        .args(["-Wall", "-Wno-fatal"])
        .args(["--top-module", TESTBENCH])
        .args(["-MAKEFLAGS", effort.make_flags()])
        .arg("-Mdir")
        .arg(to)
        .args(chip.rtl.iter().chain(&chip.testbench))
        .run()
}

/// Every warning of `verilator --lint-only -Wall` for the chip alone, in its testbench and in its
/// example. Files that Verilator does not accept are an error.
pub fn lint(chip: &ChipDir) -> Result<Vec<String>, Error> {
    let [verilator] = require([Tool::Verilator])?;
    let mut warnings = lint_top(&verilator, chip, &chip.name, &chip.rtl)?;
    let all: Vec<String> = chip.rtl.iter().chain(&chip.testbench).cloned().collect();
    let mut more = lint_top(&verilator, chip, TESTBENCH, &all)?;
    if !chip.example.is_empty() {
        let all: Vec<String> = chip.rtl.iter().chain(&chip.example).cloned().collect();
        more.extend(lint_top(
            &verilator,
            chip,
            &format!("{}_example", chip.name),
            &all,
        )?);
    }
    for warning in more {
        if !warnings.contains(&warning) {
            warnings.push(warning);
        }
    }
    Ok(warnings)
}

fn lint_top(
    verilator: &Found,
    chip: &ChipDir,
    top: &str,
    files: &[String],
) -> Result<Vec<String>, Error> {
    let output = Job::new(&verilator.path, &chip.root, LINT_LIMIT)
        .args(["--lint-only", "--timing", "-Wall", "-Wno-fatal"])
        .args(["--top-module", top])
        .args(files)
        .run()?;
    match output.trouble() {
        None => Ok(warnings_in(&output.stderr)),
        Some(trouble) => Err(Error::Tool {
            tool: "verilator",
            did: format!("did not accept {top} and {trouble}"),
            detail: output.tail(),
        }),
    }
}

/// First lines of the warnings, without the excerpts and hints that follow each.
fn warnings_in(stderr: &str) -> Vec<String> {
    stderr
        .lines()
        .filter(|line| line.starts_with("%Warning"))
        .map(str::to_owned)
        .collect()
}
