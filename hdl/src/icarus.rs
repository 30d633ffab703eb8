//! The testbench in Icarus Verilog.

use std::time::Duration;

use crate::chip_dir::{ChipDir, TESTBENCH};
use crate::error::Error;
use crate::process::Job;
use crate::progress::{Event, Progress};
use crate::run::Run;
use crate::tools::{Tool, require};
use crate::verdict::judge;

const BUILD_LIMIT: Duration = Duration::from_secs(300);

/// Compiles with all warnings and simulates; stops the simulation at the limit.
pub fn simulate(
    chip: &ChipDir,
    limit: Duration,
    plusargs: &[&str],
    progress: Progress,
) -> Result<Run, Error> {
    let [iverilog, vvp] = require([Tool::Iverilog, Tool::Vvp])?;
    let scratch = tempfile::tempdir().map_err(Error::Scratch)?;
    let program = scratch.path().join("chip_tb.vvp");

    progress(Event::Building(Tool::Iverilog));
    let built = Job::new(&iverilog.path, &chip.root, BUILD_LIMIT)
        .args(["-g2005", "-Wall", "-s", TESTBENCH, "-o"])
        .arg(&program)
        .args(chip.rtl.iter().chain(&chip.testbench))
        .run()?;
    let warnings = warnings_in(&built.stderr);
    if let Some(trouble) = built.trouble() {
        progress(Event::Finished(Tool::Iverilog));
        return Ok(Run::refused(&iverilog, &trouble, &built, warnings));
    }

    progress(Event::Simulating(Tool::Iverilog));
    // -N: `$stop` ends the run with exit code 1 in place of a prompt.
    let simulated = Job::new(&vvp.path, &chip.root, limit)
        .arg("-N")
        .arg(&program)
        .args(plusargs)
        .run()?;
    progress(Event::Finished(Tool::Iverilog));
    let verdict = judge(&simulated, &chip.stimuli);
    Ok(Run::judged(
        &iverilog, &built, warnings, &simulated, verdict,
    ))
}

/// A compiler that accepts the files says nothing but warnings and their continuations.
fn warnings_in(stderr: &str) -> Vec<String> {
    stderr
        .lines()
        .filter(|line| !line.trim().is_empty())
        .map(str::to_owned)
        .collect()
}
