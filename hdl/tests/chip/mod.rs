//! Chips of the shipped design and its variants, written to a folder.

#![allow(dead_code, reason = "each test binary uses its own part")]

use std::fs;
use std::path::Path;

use nonius_model::design::Design;
use nonius_model::spec::Spec;

/// A shipped design.
pub(crate) fn shipped(name: &str) -> Spec {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../designs/{name}.toml"));
    let text = fs::read_to_string(path).expect("a shipped design");
    Spec::from_toml(&text, name).expect("a shipped design")
}

/// The optical one.
pub(crate) fn optical() -> Spec {
    shipped("optical")
}

/// Writes what `nonius build` writes; `rows` samples of every stimulus.
pub(crate) fn write(spec: &Spec, rows: usize, dir: &Path) {
    let design = Design::new(spec).expect("a design that works");
    let package = nonius_package::package(&design, rows).expect("a package");
    nonius_package::write(&package.files, dir).expect("a folder");
}
