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

/// One CSV for each value of the last column, with the header each: of several records in one file, whose time starts again.
///
/// # Panics
/// There is no header.
#[must_use]
pub fn units(table: &str) -> Vec<String> {
    let (header, rows) = table.split_once('\n').expect("a header");
    let unit = |row: &str| row.rsplit(',').next().map(str::to_owned);
    let rows: Vec<&str> = rows.lines().collect();
    let parts = rows.chunk_by(|a, b| unit(a) == unit(b));
    let one = |part: &[&str]| format!("{header}\n{}\n", part.join("\n"));
    parts.map(one).collect()
}

/// Past the capture of test output, on a line of its own, whatever the test harness has begun. A test that cannot say so
/// still must not fail for it.
fn not_run(check: &str, name: &str) {
    let _ = writeln!(
        std::io::stderr(),
        "\nNOT RUN: {check}: ../shared/data{name} is not there"
    );
}
