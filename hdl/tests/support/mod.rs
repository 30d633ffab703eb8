//! A copy of the toy chip in `tests/toy` that a test may break.

#![allow(dead_code, missing_docs, unreachable_pub)]

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
        let folder = tempfile::tempdir().unwrap();
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/toy");
        for (name, content) in contents(&from) {
            let to = folder.path().join(name);
            fs::create_dir_all(to.parent().unwrap()).unwrap();
            fs::write(to, content).unwrap();
        }
        Toy { folder }
    }

    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub fn open(&self) -> ChipDir {
        ChipDir::open(self.path()).unwrap()
    }

    /// Replaces a text that must occur exactly once.
    pub fn replace(self, file: &str, old: &str, new: &str) -> Toy {
        let path = self.path().join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text.matches(old).count(), 1, "{old:?} in {file}");
        fs::write(path, text.replace(old, new)).unwrap();
        self
    }

    pub fn write(self, file: &str, text: &str) -> Toy {
        fs::write(self.path().join(file), text).unwrap();
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
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(root).unwrap().to_owned();
                files.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    files
}
