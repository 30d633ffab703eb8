//! What keeps a tool from giving a verdict. A chip that fails its check is not an error but
//! a [`Run`](crate::Run) that did not pass.

use std::io;
use std::path::PathBuf;

use crate::chip_dir::NotAChip;
use crate::tools::MissingTools;

/// Why there is no verdict.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A tool is not installed.
    #[error(transparent)]
    Missing(#[from] MissingTools),
    /// The directory is not one that `nonius build` wrote.
    #[error(transparent)]
    NotAChip(#[from] NotAChip),
    /// A program exists and could not be started or waited for.
    #[error("cannot run {}: {source}", program.display())]
    Start {
        /// The program.
        program: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The scratch directory could not be used.
    #[error("cannot use a scratch directory for the tools' output: {0}")]
    Scratch(#[source] io::Error),
    /// A tool gave up, or said something that cannot be read.
    #[error("{tool} {did}:\n{detail}")]
    Tool {
        /// Program name.
        tool: &'static str,
        /// What it did, as the rest of a sentence.
        did: String,
        /// The end of its output.
        detail: String,
    },
}
