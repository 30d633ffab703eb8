//! `nonius verify`: the chip in both simulators, and both against each other.

use std::path::Path;
use std::thread;
use std::time::Duration;

use serde::Serialize;

use crate::chip_dir::ChipDir;
use crate::error::Error;
use crate::progress::Progress;
use crate::run::Run;
use crate::tools::{Tool, require};
use crate::verilator::Effort;
use crate::{icarus, verilator};

/// What to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Simulate in Icarus.
    pub icarus: bool,
    /// Simulate in Verilator.
    pub verilator: bool,
    /// End a simulation with the first stimulus that fails.
    pub stop_at_first: bool,
    /// Time that each simulation may take; by default five minutes and what a slow machine needs
    /// for the rows.
    pub time_limit: Option<Duration>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            icarus: true,
            verilator: true,
            stop_at_first: false,
            time_limit: None,
        }
    }
}

impl Options {
    /// Both simulators, however long a busy machine takes.
    pub const PATIENT: Self = Self {
        icarus: true,
        verilator: true,
        stop_at_first: false,
        time_limit: Some(Duration::from_secs(3600)),
    };

    /// What the testbench is told.
    fn plusargs(&self) -> &'static [&'static str] {
        if self.stop_at_first {
            &["+stop_at_first"]
        } else {
            &[]
        }
    }
}

/// What the simulators say.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Whether at least one simulator ran and everything held. Warnings do not count.
    pub passed: bool,
    /// One entry per simulator.
    pub runs: Vec<Run>,
    /// Where the simulators contradict each other, one sentence each.
    pub disagreements: Vec<String>,
}

/// Runs the chip in `dir` in the chosen simulators, at the same time.
pub fn verify(
    dir: impl AsRef<Path>,
    options: &Options,
    progress: Progress,
) -> Result<Report, Error> {
    let chip = ChipDir::open(dir)?;
    match (options.icarus, options.verilator) {
        (true, true) => {
            require([
                Tool::Iverilog,
                Tool::Vvp,
                Tool::Verilator,
                Tool::Cxx,
                Tool::Make,
            ])
            .map(drop)?;
        }
        (true, false) => require([Tool::Iverilog, Tool::Vvp]).map(drop)?,
        (false, true) => require([Tool::Verilator, Tool::Cxx, Tool::Make]).map(drop)?,
        (false, false) => (),
    }
    let limit = options.time_limit.unwrap_or(default_limit(&chip));
    let effort = Effort::for_rows(chip.rows);
    let plusargs = options.plusargs();
    let (icarus, verilator) = thread::scope(|scope| {
        let icarus = options
            .icarus
            .then(|| scope.spawn(|| icarus::simulate(&chip, limit, plusargs, progress)));
        let verilator = options
            .verilator
            .then(|| verilator::simulate(&chip, effort, limit, plusargs, progress));
        (icarus.map(joined), verilator)
    });
    let runs: Vec<Run> = [icarus, verilator]
        .into_iter()
        .flatten()
        .collect::<Result<_, Error>>()?;
    let disagreements = match runs.as_slice() {
        [one, other] => compare(one, other),
        _ => Vec::new(),
    };
    Ok(Report {
        passed: !runs.is_empty() && disagreements.is_empty() && runs.iter().all(|it| it.passed),
        runs,
        disagreements,
    })
}

fn joined<T>(handle: thread::ScopedJoinHandle<'_, T>) -> T {
    handle
        .join()
        .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Icarus does some thousand samples a second; a busy machine a tenth of that.
fn default_limit(chip: &ChipDir) -> Duration {
    Duration::from_secs(300)
        + Duration::from_millis(20) * u32::try_from(chip.rows).unwrap_or(u32::MAX)
}

fn compare(one: &Run, other: &Run) -> Vec<String> {
    // One that did not get so far has said why.
    if [one, other]
        .iter()
        .any(|run| !run.passed && run.stimuli.is_empty())
    {
        return Vec::new();
    }
    let mut disagreements = Vec::new();
    for (a, b) in [(one, other), (other, one)] {
        for stimulus in &a.stimuli {
            if !b.stimuli.iter().any(|it| it.name == stimulus.name) {
                disagreements.push(format!(
                    "{} reports stimulus {}, {} does not",
                    a.tool, stimulus.name, b.tool
                ));
            }
        }
    }
    for a in &one.stimuli {
        for b in other.stimuli.iter().filter(|b| b.name == a.name) {
            let sentence = |what_a: &str, what_b: &str| {
                format!(
                    "stimulus {}: {} says {what_a}, {} says {what_b}",
                    a.name, one.tool, other.tool
                )
            };
            if a.passed != b.passed {
                disagreements.push(sentence(verdict(a.passed), verdict(b.passed)));
            } else if !a.passed && a.detail != b.detail {
                disagreements.push(sentence(&a.detail, &b.detail));
            } else if a.samples != b.samples {
                disagreements.push(sentence(&count(a.samples), &count(b.samples)));
            }
        }
    }
    disagreements
}

fn verdict(passed: bool) -> &'static str {
    if passed { "PASS" } else { "FAIL" }
}

fn count(samples: Option<u64>) -> String {
    samples.map_or("nothing of samples".to_owned(), |it| {
        format!("{it} samples")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::StimulusResult;

    fn run(tool: Tool, stimuli: &[(&str, bool, u64)]) -> Run {
        Run {
            tool,
            version: String::new(),
            passed: true,
            failure: None,
            warnings: Vec::new(),
            samples: None,
            build_seconds: 0.0,
            seconds: 0.0,
            stimuli: stimuli
                .iter()
                .map(|&(name, passed, samples)| StimulusResult {
                    name: name.to_owned(),
                    passed,
                    samples: Some(samples),
                    detail: String::new(),
                })
                .collect(),
        }
    }

    #[test]
    fn the_simulators_must_say_the_same() {
        let icarus = run(
            Tool::Iverilog,
            &[("a", true, 5), ("b", true, 5), ("c", true, 5)],
        );
        let verilator = run(
            Tool::Verilator,
            &[("a", true, 4), ("b", false, 5), ("d", true, 5)],
        );
        assert_eq!(
            compare(&icarus, &verilator),
            [
                "iverilog reports stimulus c, verilator does not",
                "verilator reports stimulus d, iverilog does not",
                "stimulus a: iverilog says 5 samples, verilator says 4 samples",
                "stimulus b: iverilog says PASS, verilator says FAIL",
            ]
        );
        assert_eq!(compare(&icarus, &icarus), Vec::<String>::new());
    }
}
