//! The command `nonius`, as a library: `main` calls [`run`], tests call its parts.

/// A line on standard output; where nobody reads any more, nobody is told.
macro_rules! say {
    ($($what:tt)*) => {{
        $crate::say::say(format_args!("{}\n", format_args!($($what)*)));
    }};
}

/// The same without an end of line.
macro_rules! say_as_it_is {
    ($($what:tt)*) => {{
        $crate::say::say(format_args!($($what)*));
    }};
}

mod build;
mod calibrate;
mod corrections;
mod design_file;
mod diagnose;
mod interpolator;
pub mod new;
mod paper;
pub mod play;
mod progress;
mod recording_args;
mod samples;
mod say;
mod simulate;
mod target;
mod verify;

use std::ffi::OsString;
use std::fmt::Display;

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
    Build(Box<build::Build>),
    /// The bit-true chip, or the paper in floating point, over a recording.
    Simulate(Box<simulate::Simulate>),
    /// Offsets, gains and phase of a recording, off line, with error bars.
    Calibrate(Box<calibrate::Calibrate>),
    /// What the simulation of a recorded sensor gets wrong, the causes by name, and what they gain.
    Diagnose(Box<diagnose::Diagnose>),
    /// Runs the chip in a folder in Icarus and in Verilator against the model.
    Verify(verify::Verify),
}

/// Sentences that a result is to be read with, on standard error.
fn notes(sentences: impl IntoIterator<Item = impl Display>) {
    for sentence in sentences {
        eprintln!("note: {sentence}");
    }
}

/// Runs a command line, the program's name first; its exit code: 0 done and everything held, 1 done and something did
/// not hold, 2 the input or the call is wrong.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(said) => {
            // Where nobody reads what is printed there is nobody to tell.
            let _ = said.print();
            return if said.use_stderr() { 2 } else { 0 };
        }
    };
    let done = match cli.command {
        Command::Build(args) => build::run(&args),
        Command::New(args) => new::run(&args).map(|()| true),
        Command::Simulate(args) => simulate::run(&args).map(|()| true),
        Command::Calibrate(args) => calibrate::run(&args).map(|()| true),
        Command::Diagnose(args) => diagnose::run(&args),
        Command::Verify(args) => verify::run(&args),
    };
    let done = done.and_then(|done| say::arrived().map(|()| done));
    match done {
        Ok(true) => 0,
        Ok(false) => 1,
        Err(error) => {
            eprintln!("error: {error:#}");
            2
        }
    }
}
