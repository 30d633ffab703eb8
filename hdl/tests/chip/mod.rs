//! Chips of the shipped design and its variants, written to a folder.

use std::fs;
use std::path::Path;

use nonius_model::design::Design;
use nonius_model::spec::Spec;

/// The shipped optical design.
pub(crate) fn optical() -> Spec {
    shipped("optical")
}

/// A design of `designs/` by its name.
pub(crate) fn shipped(name: &str) -> Spec {
    let file = format!("{}/../designs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(&file).unwrap_or_else(|error| panic!("{name}.toml: {error}"));
    Spec::from_toml(&text, &format!("{name}.toml")).expect("a shipped design")
}

/// Writes what `nonius build` writes; `rows` samples of every stimulus.
pub(crate) fn write(spec: &Spec, rows: usize, dir: &Path) {
    let design = Design::new(spec).expect("a design that works");
    let package = nonius_package::package(&design, rows).expect("a package");
    nonius_package::write(&package.files, dir).expect("a folder");
}
