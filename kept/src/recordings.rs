//! Recordings that stand beside the workspace and are no part of it.

use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder `../shared/data`, seen from the workspace. Where it is absent, says that `check` was not run and gives `None`.
#[must_use]
pub fn recordings(check: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    if folder.is_dir() {
        return Some(folder);
    }
    not_run(check, "");
    None
}

/// The file `name` in it, likewise.
#[must_use]
pub fn recording(check: &str, name: &str) -> Option<PathBuf> {
    let file = recordings(check)?.join(name);
    if file.is_file() {
        return Some(file);
    }
    not_run(check, &format!("/{name}"));
    None
}

/// Past the capture of test output, on a line of its own, whatever the test harness has begun. A test that cannot say so
/// still must not fail for it.
fn not_run(check: &str, name: &str) {
    let _ = writeln!(
        std::io::stderr(),
        "\nNOT RUN: {check}: ../shared/data{name} is not there"
    );
}
