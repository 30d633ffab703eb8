//! `nonius verify`: the chip in a folder in other people's simulators, against the model.

use std::path::PathBuf;
use std::sync::Mutex;

use anyhow::Result;
use clap::{Args, ValueEnum};
use indicatif::ProgressBar;
use nonius_hdl::StimulusResult;
use nonius_hdl::progress::Event;
use nonius_hdl::tools::Tool;
use nonius_hdl::verify::{Options, Report};

/// Arguments of `nonius verify`.
#[derive(Args)]
pub(crate) struct Verify {
    /// What `build` wrote.
    dir: PathBuf,
    /// Which simulators to run.
    #[arg(long, value_enum, default_value_t = Simulator::Both)]
    simulator: Simulator,
    /// Ends a simulation with the first stimulus that fails.
    #[arg(long)]
    stop_at_first: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Simulator {
    /// Icarus Verilog and Verilator, and each against the other.
    Both,
    /// Icarus Verilog.
    Icarus,
    /// Verilator.
    Verilator,
}

/// Whether everything held.
pub(crate) fn run(args: &Verify) -> Result<bool> {
    let options = Options {
        icarus: args.simulator != Simulator::Verilator,
        verilator: args.simulator != Simulator::Icarus,
        stop_at_first: args.stop_at_first,
        ..Options::default()
    };
    let report = {
        let shown = Shown::new();
        nonius_hdl::verify::verify(&args.dir, &options, &|event| shown.follow(event))?
    };
    if args.json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        print(&report);
    }
    Ok(report.passed)
}

fn print(report: &Report) {
    for run in &report.runs {
        say!("{} {}: {}", run.tool, run.version, verdict(run.passed));
        let says_why = |one: &StimulusResult| !one.passed && !one.detail.is_empty();
        for stimulus in &run.stimuli {
            say!("  {} {}", verdict(stimulus.passed), stimulus.name);
            if says_why(stimulus) {
                say!("       {}", stimulus.detail);
            }
        }
        if let Some(failure) = &run.failure {
            // What stands behind the reason is the end of the output, which a failed stimulus has said already.
            let reason = failure.lines().next().unwrap_or_default();
            let told = run.stimuli.iter().any(says_why);
            say!("  {}", if told { reason } else { failure });
        }
        for warning in &run.warnings {
            say!("  warning: {warning}");
        }
    }
    for disagreement in &report.disagreements {
        say!("{disagreement}");
    }
}

fn verdict(passed: bool) -> &'static str {
    if passed { "PASS" } else { "FAIL" }
}

/// What the tools are doing, in one line; on a terminal only.
struct Shown {
    line: ProgressBar,
    doing: Mutex<Vec<(Tool, &'static str)>>,
}

impl Shown {
    fn new() -> Self {
        Self {
            line: crate::progress::line(),
            doing: Mutex::default(),
        }
    }

    fn follow(&self, event: Event) {
        let (tool, what) = match event {
            Event::Building(tool) => (tool, Some("compiles")),
            Event::Simulating(tool) => (tool, Some("simulates")),
            Event::Finished(tool) => (tool, None),
            Event::Synthesising | Event::Placing { .. } => return,
        };
        let Ok(mut doing) = self.doing.lock() else {
            return;
        };
        // Icarus is two programs, one of which takes over from the other.
        let family = |tool| {
            if tool == Tool::Vvp {
                Tool::Iverilog
            } else {
                tool
            }
        };
        doing.retain(|(known, _)| family(*known) != family(tool));
        doing.extend(what.map(|what| (tool, what)));
        let text: Vec<_> = doing
            .iter()
            .map(|(tool, what)| format!("{tool} {what}"))
            .collect();
        self.line.set_message(text.join(", "));
    }
}

impl Drop for Shown {
    fn drop(&mut self) {
        self.line.finish_and_clear();
    }
}
