//! What a caller may show while it waits.

use crate::tools::Tool;

/// A step of a job begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// The tool compiles the Verilog.
    Building(Tool),
    /// The tool simulates the testbench.
    Simulating(Tool),
    /// The tool is done.
    Finished(Tool),
    /// Yosys maps the chip to cells.
    Synthesising,
    /// nextpnr places and routes with this seed.
    Placing {
        /// The seed.
        seed: u32,
    },
}

/// Who listens. Two tools may report at once.
pub type Progress<'a> = &'a (dyn Fn(Event) + Sync);

/// Listens to nothing.
pub fn silent(_: Event) {}
