//! A directory that `nonius build` wrote.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;

/// The chip in a directory: what the tools need to know of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChipDir {
    /// The directory. Tools run in it, and all paths below are relative to it, so that no
    /// message carries a path of this machine.
    pub root: PathBuf,
    /// Name of the design and of its top module.
    pub name: String,
    /// Clock cycles from one sample to the next, as `design.json` states them.
    pub clocks_per_sample: Option<u64>,
    /// `rtl/*.v`, sorted.
    pub rtl: Vec<String>,
    /// `tb/*.v`, sorted.
    pub testbench: Vec<String>,
    /// `example/*.v`, sorted; none if there is no such folder.
    pub example: Vec<String>,
    /// Names of the stimuli: `vectors/*.vec` without folder and ending, sorted.
    pub stimuli: Vec<String>,
    /// Lines of all vector files together.
    pub rows: u64,
}

/// Top module of the testbench.
pub const TESTBENCH: &str = "chip_tb";

/// Why a directory cannot be used.
#[derive(Debug, thiserror::Error)]
#[error(
    "{}: {reason}. Expected a directory that `nonius build DESIGN.toml -o DIR` wrote.",
    path.display()
)]
pub struct NotAChip {
    /// File or folder at fault.
    pub path: PathBuf,
    /// What is wrong with it.
    pub reason: String,
}

#[derive(Deserialize)]
struct DesignJson {
    name: String,
    clocks_per_sample: Option<u64>,
}

impl ChipDir {
    /// Looks at the directory; reads `design.json` and the names of the files.
    pub fn open(root: impl AsRef<Path>) -> Result<ChipDir, NotAChip> {
        let root = root.as_ref();
        let json = root.join("design.json");
        let text = fs::read_to_string(&json).map_err(|it| refuse(&json, it.to_string()))?;
        let design: DesignJson =
            serde_json::from_str(&text).map_err(|it| refuse(&json, it.to_string()))?;
        let rtl = files(root, "rtl", ".v")?;
        let testbench = files(root, "tb", ".v")?;
        for (list, needed) in [
            (&rtl, format!("rtl/{}.v", design.name)),
            (&testbench, format!("tb/{TESTBENCH}.v")),
        ] {
            if !list.contains(&needed) {
                return Err(refuse(
                    &root.join(needed),
                    "there is no such file".to_owned(),
                ));
            }
        }
        let vectors = files(root, "vectors", ".vec")?;
        if vectors.is_empty() {
            return Err(refuse(
                &root.join("vectors"),
                "it holds no .vec file".to_owned(),
            ));
        }
        let mut rows = 0;
        for file in &vectors {
            let path = root.join(file);
            let bytes = fs::read(&path).map_err(|it| refuse(&path, it.to_string()))?;
            rows += bytes.iter().filter(|&&byte| byte == b'\n').count() as u64;
        }
        Ok(ChipDir {
            root: root.to_owned(),
            name: design.name,
            clocks_per_sample: design.clocks_per_sample,
            rtl,
            testbench,
            example: if root.join("example").is_dir() {
                files(root, "example", ".v")?
            } else {
                vec![]
            },
            stimuli: vectors.iter().map(|it| stem(it)).collect(),
            rows,
        })
    }
}

fn refuse(path: &Path, reason: String) -> NotAChip {
    NotAChip {
        path: path.to_owned(),
        reason,
    }
}

/// `folder/*ending`, sorted, relative to the root.
fn files(root: &Path, folder: &str, ending: &str) -> Result<Vec<String>, NotAChip> {
    let path = root.join(folder);
    let mut names = Vec::new();
    for entry in fs::read_dir(&path).map_err(|it| refuse(&path, it.to_string()))? {
        let entry = entry.map_err(|it| refuse(&path, it.to_string()))?;
        if let Some(name) = entry.file_name().to_str()
            && name.ends_with(ending)
        {
            names.push(format!("{folder}/{name}"));
        }
    }
    names.sort();
    Ok(names)
}

fn stem(file: &str) -> String {
    let name = file.rsplit('/').next().unwrap_or(file);
    name.strip_suffix(".vec").unwrap_or(name).to_owned()
}
