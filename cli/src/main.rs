//! The command `nonius`.

mod build;
mod calibrate;
mod design_file;
mod new;
mod paper;
mod recording_args;
mod simulate;
mod target;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Golden model and generator of self-calibrating sin/cos interpolation chips.
#[derive(Parser)]
#[command(version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// A commented design, fitted to a recording if one is given.
    New(Box<new::New>),
    /// Tables, Verilog, testbench and vectors of a design.
    Build {
        /// The design.
        design: PathBuf,
        /// Folder to write; replaced if nonius wrote it before.
        #[arg(short)]
        output: PathBuf,
    },
    /// The bit-true chip, or the paper in floating point, over a recording.
    Simulate(Box<simulate::Simulate>),
    /// Offsets, gains and phase of a recording, off line, with error bars.
    Calibrate(Box<calibrate::Calibrate>),
    /// Runs the chip in a folder in Icarus and in Verilator against the model.
    Verify {
        /// What `build` wrote.
        dir: PathBuf,
    },
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Build { design, output } => build::run(&design, &output).map(|()| true),
        Command::New(args) => new::run(&args).map(|()| true),
        Command::Simulate(args) => simulate::run(&args).map(|()| true),
        Command::Calibrate(args) => calibrate::run(&args).map(|()| true),
        Command::Verify { dir } => verify(&dir),
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

fn verify(dir: &std::path::Path) -> anyhow::Result<bool> {
    let report = nonius_hdl::verify::verify(
        dir,
        &nonius_hdl::verify::Options::default(),
        &nonius_hdl::progress::silent,
    )?;
    for run in &report.runs {
        println!("{}: {}", run.tool, if run.passed { "PASS" } else { "FAIL" });
        for stimulus in &run.stimuli {
            println!(
                "  {} {}",
                if stimulus.passed { "PASS" } else { "FAIL" },
                stimulus.name
            );
        }
        if let Some(failure) = &run.failure {
            println!("  {failure}");
        }
    }
    for disagreement in &report.disagreements {
        println!("{disagreement}");
    }
    Ok(report.passed)
}
