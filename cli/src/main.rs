//! The command `nonius`.

mod build;
mod calibrate;
mod design_file;
mod diagnose;
mod new;
mod paper;
mod recording_args;
mod simulate;
mod target;
mod verify;

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
    /// What the simulation of a recorded sensor gets wrong, the causes by name, and what they gain.
    Diagnose(Box<diagnose::Diagnose>),
    /// Runs the chip in a folder in Icarus and in Verilator against the model.
    Verify(verify::Verify),
}

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Build { design, output } => build::run(&design, &output).map(|()| true),
        Command::New(args) => new::run(&args).map(|()| true),
        Command::Simulate(args) => simulate::run(&args).map(|()| true),
        Command::Calibrate(args) => calibrate::run(&args).map(|()| true),
        Command::Diagnose(args) => diagnose::run(&args),
        Command::Verify(args) => verify::run(&args),
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
