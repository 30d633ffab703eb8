//! A copy of the toy chip in `tests/toy` that a test may break.

#![allow(missing_docs, unreachable_pub)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use nonius_hdl::ChipDir;
use tempfile::TempDir;

pub struct Toy {
    folder: TempDir,
}

impl Toy {
    pub fn new() -> Toy {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/toy");
        for (name, content) in contents(&from) {
            let to = folder.path().join(name);
            fs::create_dir_all(to.parent().expect("a folder")).expect("a file");
            fs::write(to, content).expect("a file");
        }
        Toy { folder }
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub fn open(&self) -> ChipDir {
        ChipDir::open(self.path()).expect("a chip")
    }

    /// Replaces a text that must occur exactly once.
    pub fn replace(self, file: &str, old: &str, new: &str) -> Toy {
        let path = self.path().join(file);
        let text = fs::read_to_string(&path).expect("a file");
        assert_eq!(text.matches(old).count(), 1, "{old:?} in {file}");
        fs::write(path, text.replace(old, new)).expect("a file");
        self
    }

    pub fn write(self, file: &str, text: &str) -> Toy {
        fs::write(self.path().join(file), text).expect("a file");
        self
    }

    /// Every file with its content.
    pub fn contents(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        contents(self.path())
    }
}

fn contents(root: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a file") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root).expect("below").to_owned();
                files.insert(name, fs::read(&path).expect("a file"));
            }
        }
    }
    files
}
