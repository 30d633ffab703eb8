//! Chips of the shipped design and its variants, written to a folder.

#[path = "../../../designs/shipped.rs"]
pub(crate) mod shipped;

pub(crate) use shipped::optical;

use std::path::Path;

use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_testvectors::stimulus;

/// Writes what `nonius build` writes; `rows` samples of every stimulus.
pub(crate) fn write(spec: &Spec, rows: usize, dir: &Path) {
    write_with(spec, rows, dir, |_| true);
}

/// The same with the stimuli of these names only.
pub(crate) fn write_with(spec: &Spec, rows: usize, dir: &Path, wanted: fn(&str) -> bool) {
    let design = Design::new(spec).expect("a design that works");
    let mut stimuli = stimulus::named(&design, rows);
    stimuli.retain(|one| wanted(&one.name));
    let package = nonius_package::package_with(&design, stimuli, "sweep").expect("a package");
    nonius_package::write(&package.files, dir).expect("a folder");
}
