//! A folder that appears whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Why a folder could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// Something else is there.
    #[error("{} exists and was not written by nonius build; name another folder", .0.display())]
    NotOurs(PathBuf),
    /// The operating system refuses.
    #[error("cannot write {}: {error}", path.display())]
    Io {
        /// Which file or folder.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

/// Writes the files into the folder `output`. A folder that was written so before is replaced; what stood in it is
/// there until the new one is complete.
///
/// # Errors
/// A folder of somebody else, or what the operating system says.
pub fn write(files: &[(String, Vec<u8>)], output: &Path) -> Result<(), WriteError> {
    let refuse = |path: &Path| {
        let path = path.to_owned();
        move |error| WriteError::Io { path, error }
    };
    let there = output.symlink_metadata().is_ok();
    if there && !output.join("design.json").is_file() && !is_empty(output) {
        return Err(WriteError::NotOurs(output.to_owned()));
    }
    let parent = output
        .parent()
        .filter(|p| !p.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(refuse(parent))?;
    let scratch = tempfile::Builder::new()
        .prefix(".nonius-")
        .tempdir_in(parent)
        .map_err(refuse(parent))?;
    let fresh = scratch.path().join("new");
    for (path, content) in files {
        let path = fresh.join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(refuse(folder))?;
        }
        fs::write(&path, content).map_err(refuse(&path))?;
    }
    // The old one steps aside and comes back if the new one cannot take its place.
    let old = scratch.path().join("old");
    if there {
        fs::rename(output, &old).map_err(refuse(output))?;
    }
    if let Err(error) = fs::rename(&fresh, output) {
        if there {
            let _ = fs::rename(&old, output);
        }
        return Err(WriteError::Io {
            path: output.to_owned(),
            error,
        });
    }
    Ok(())
}

fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::{WriteError, write};
    use std::fs;

    fn files(text: &str) -> Vec<(String, Vec<u8>)> {
        vec![
            ("design.json".into(), text.into()),
            ("rtl/a.v".into(), text.into()),
        ]
    }

    #[test]
    fn a_folder_is_replaced_as_a_whole_and_strangers_are_left_alone() {
        let dir = tempfile::tempdir().expect("scratch");
        let out = dir.path().join("deep/out");
        write(&files("1"), &out).expect("first");
        fs::write(out.join("rtl/stale.v"), "").expect("stale");
        write(&files("2"), &out).expect("second");
        assert!(!out.join("rtl/stale.v").exists());
        assert_eq!(fs::read_to_string(out.join("rtl/a.v")).expect("a.v"), "2");
        let left: Vec<_> = fs::read_dir(dir.path().join("deep"))
            .expect("folder")
            .collect();
        assert_eq!(left.len(), 1, "{left:?}");
        let mine = dir.path().join("mine");
        fs::create_dir(&mine).expect("folder");
        fs::write(mine.join("letter"), "dear").expect("file");
        assert!(matches!(
            write(&files("3"), &mine),
            Err(WriteError::NotOurs(_))
        ));
        assert!(mine.join("letter").is_file());
        let file = dir.path().join("file");
        fs::write(&file, "").expect("file");
        assert!(write(&files("4"), &file).is_err());
    }
}
