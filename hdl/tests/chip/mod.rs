//! Chips of the shipped design and its variants, written to a folder.

#![allow(dead_code, reason = "each test binary uses its own part")]

#[path = "../../../designs/shipped.rs"]
pub(crate) mod shipped;

#[allow(unused_imports, reason = "each test binary uses its own part")]
pub(crate) use shipped::optical;

use std::path::Path;

use nonius_model::design::Design;
use nonius_model::spec::Spec;

/// Writes what `nonius build` writes; `rows` samples of every stimulus.
pub(crate) fn write(spec: &Spec, rows: usize, dir: &Path) {
    let design = Design::new(spec).expect("a design that works");
    let package = nonius_package::package(&design, rows).expect("a package");
    nonius_package::write(&package.files, dir).expect("a folder");
}
