//! Drives Icarus Verilog, Verilator, Yosys and nextpnr over a directory that
//! `nonius build` wrote, and says strictly whether they agree with the model.
//!
//! The simulators are the independent check of the Verilog. So a verdict here is never
//! generous: what a tool did not say in so many words did not pass.
//!
//! Nothing is printed, and nothing is written into the chip's directory; whoever calls may
//! listen to [`progress`].

pub mod chip_dir;
pub mod error;
pub mod icarus;
pub mod place;
pub mod progress;
pub mod run;
pub mod tools;
pub mod verify;
pub mod verilator;
pub mod yosys;

mod harness;
mod process;
mod verdict;

pub use chip_dir::ChipDir;
pub use error::Error;
pub use run::{Run, StimulusResult};
pub use verify::{Options, Report, verify};
