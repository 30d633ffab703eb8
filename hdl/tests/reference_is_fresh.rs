//! `hdl/reference/` holds one generated chip to read, and it is what the generator writes today.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::chip::optical;
use nonius_model::design::Design;

/// Samples of each stimulus: enough to run, few enough to keep.
const ROWS: usize = 24;
const HOW: &str = "NONIUS_BLESS=1 cargo test -p nonius-hdl reference_is_fresh::";

fn generated() -> BTreeMap<String, String> {
    let design = Design::new(&optical()).expect("a shipped design");
    let package = nonius_package::package(&design, ROWS).expect("a package");
    // What a reader reads, and what the testbench needs.
    let kept = |path: &str| {
        ["rtl/", "tb/", "example/", "vectors/"]
            .iter()
            .any(|folder| path.starts_with(folder))
            || path == "coefficients/sine_table.mem"
    };
    let files = package.files.into_iter().filter(|f| kept(&f.0));
    files
        .map(|(path, text)| (path, String::from_utf8(text).expect("text")))
        .collect()
}

fn found(root: &Path, folder: &Path, into: &mut BTreeMap<String, String>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found(root, &path, into);
        } else {
            let name = path
                .strip_prefix(root)
                .expect("below")
                .display()
                .to_string();
            into.insert(name, fs::read_to_string(&path).expect("text"));
        }
    }
}

#[test]
fn the_kept_chip_is_what_the_generator_writes() {
    let root = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("reference");
    let fresh = generated();
    if nonius_kept::blessed() {
        let _ = fs::remove_dir_all(&root);
    }
    for (path, text) in &fresh {
        nonius_kept::same(&root.join(path), text, HOW);
    }
    let mut kept = BTreeMap::new();
    found(&root, &root, &mut kept);
    let names = |files: &BTreeMap<String, String>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&kept), names(&fresh), "stale: {HOW}");
}
