//! What goes to standard output, and whether it arrived.

use std::fmt::Arguments;
use std::io::{ErrorKind, Write as _};
use std::sync::OnceLock;

use anyhow::{Result, bail};

/// Why the first line that did not arrive did not.
static LOST: OnceLock<String> = OnceLock::new();

/// Writes to standard output. A reader that has seen enough is no failure; a disk that is full is one, which [`arrived`] tells.
pub(crate) fn say(text: Arguments) {
    note(std::io::stdout().write_fmt(text));
}

fn note(written: std::io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
    {
        LOST.get_or_init(|| error.to_string());
    }
}

/// Whether all that was said arrived.
pub(crate) fn arrived() -> Result<()> {
    note(std::io::stdout().flush());
    match LOST.get() {
        Some(why) => bail!("standard output: {why}; what it was to hold is not there"),
        None => Ok(()),
    }
}
