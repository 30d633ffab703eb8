//! Yosys reads the chip as hardware and checks it: no undriven or doubly driven net, no
//! combinational loop.

use std::path::Path;
use std::time::Duration;

use serde::Serialize;

use crate::chip_dir::ChipDir;
use crate::error::Error;
use crate::process::{Job, Output};
use crate::tools::{Found, Tool, require};

const LIMIT: Duration = Duration::from_secs(600);

/// What Yosys says of the chip.
#[derive(Clone, Debug, Serialize)]
pub struct Check {
    /// Its version.
    pub version: String,
    /// Whether it accepts the files and finds nothing in them.
    pub passed: bool,
    /// The end of its output if not.
    pub failure: Option<String>,
    /// Every warning.
    pub warnings: Vec<String>,
}

/// `check -assert` of every module, then of the flattened chip.
pub fn check(chip: &ChipDir) -> Result<Check, Error> {
    let [yosys] = require([Tool::Yosys])?;
    let script = format!(
        "{}; hierarchy -check -top {top}; proc; check -assert; flatten; check -assert {top}",
        read(chip),
        top = chip.name
    );
    let output = run(&yosys, &chip.root, &script)?;
    Ok(Check {
        version: yosys.version(),
        passed: output.trouble().is_none(),
        failure: output
            .trouble()
            .map(|it| format!("yosys {it}\n{}", output.tail())),
        warnings: warnings_in(&output),
    })
}

/// The command that reads the chip's files.
pub(crate) fn read(chip: &ChipDir) -> String {
    let files: Vec<String> = chip.rtl.iter().map(|it| format!("\"{it}\"")).collect();
    format!("read_verilog {}", files.join(" "))
}

/// Runs a script in a folder. It prints warnings and errors only.
pub(crate) fn run(yosys: &Found, folder: &Path, script: &str) -> Result<Output, Error> {
    Job::new(&yosys.path, folder, LIMIT)
        .args(["-q", "-p", script])
        .run()
}

pub(crate) fn warnings_in(output: &Output) -> Vec<String> {
    output
        .stdout
        .lines()
        .chain(output.stderr.lines())
        .filter(|line| line.to_lowercase().contains("warning:"))
        .map(str::to_owned)
        .collect()
}
