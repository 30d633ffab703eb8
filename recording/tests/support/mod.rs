//! Recordings that stand beside the workspace and are no part of it.

use std::io::Write;
use std::path::{Path, PathBuf};

/// The file `name` of `../shared/data`, seen from the workspace. Where it is absent, says on
/// standard error that `check` was not run (past the capture of test output) and gives `None`.
pub(crate) fn shared_recording(check: &str, name: &str) -> Option<PathBuf> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let file = data.join(name);
    if file.is_file() {
        return Some(file);
    }
    // On a line of its own, whatever the test harness has begun. A test that cannot say so still
    // must not fail for it.
    let _ = writeln!(
        std::io::stderr(),
        "\nNOT RUN: {check}: {} is not there",
        file.display()
    );
    None
}
