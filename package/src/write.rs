//! A folder that appears whole or not at all.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Why a folder could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// Something else is there.
    #[error("{} exists and was not written by this command; name another folder", .0.display())]
    NotOurs(PathBuf),
    /// The folder that this command runs in, or one around it.
    #[error("{} is replaced as a whole, and this command runs in it; run it from outside", .0.display())]
    Inside(PathBuf),
    /// The operating system refuses.
    #[error("cannot write {}: {error}", path.display())]
    Io {
        /// Which file or folder.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
}

/// Names of the files that were written, one a line: what else stands in the folder is the user's.
const MANIFEST: &str = ".nonius-files";

/// Where a folder is written: through a link, and what it holds of ours.
struct Place {
    output: PathBuf,
    there: bool,
    manifest: Option<String>,
}

impl Place {
    fn of(output: &Path) -> Result<Self, WriteError> {
        let meta = output.symlink_metadata().ok();
        let there = meta.is_some();
        if there && runs_in(output) {
            return Err(WriteError::Inside(output.to_owned()));
        }
        // A link stays one: what it leads to is replaced.
        let output = match meta {
            Some(meta) if meta.is_symlink() => fs::canonicalize(output).map_err(refuse(output))?,
            _ => output.to_owned(),
        };
        let manifest = fs::read_to_string(output.join(MANIFEST)).ok();
        if there && manifest.is_none() && !is_empty(&output) {
            return Err(WriteError::NotOurs(output));
        }
        Ok(Self {
            output,
            there,
            manifest,
        })
    }
}

fn refuse(path: &Path) -> impl FnOnce(io::Error) -> WriteError {
    let path = path.to_owned();
    move |error| WriteError::Io { path, error }
}

/// Whether [`write()`] would write into the folder `output`: to be asked before work that takes long.
///
/// # Errors
/// A folder of somebody else, or the one that the command runs in.
pub fn may_write(output: &Path) -> Result<(), WriteError> {
    Place::of(output).map(|_| ())
}

/// Writes the files into the folder `output`. A folder that was written so before is replaced; what stood in it is
/// there until the new one is complete, and files that were not written here stay.
///
/// # Errors
/// A folder of somebody else, the one that the command runs in, or what the operating system says.
pub fn write(files: &[(String, Vec<u8>)], output: &Path) -> Result<(), WriteError> {
    let Place {
        output,
        there,
        manifest,
    } = Place::of(output)?;
    let output = output.as_path();
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
    let names: Vec<&str> = files.iter().map(|(path, _)| path.as_str()).collect();
    let list = fresh.join(MANIFEST);
    fs::write(&list, names.join("\n") + "\n").map_err(refuse(&list))?;
    if let Some(manifest) = manifest {
        let ours: Vec<PathBuf> = manifest.lines().map(|name| output.join(name)).collect();
        keep(output, &fresh, &ours)?;
    }
    let placed = if there {
        swap(&fresh, output, &scratch.path().join("old"))
    } else {
        fs::rename(&fresh, output)
    };
    placed.map_err(refuse(output))
}

/// Whether the working directory is this folder or one in it.
fn runs_in(folder: &Path) -> bool {
    let here = std::env::current_dir().and_then(fs::canonicalize);
    let folder = fs::canonicalize(folder);
    matches!((here, folder), (Ok(here), Ok(folder)) if here.starts_with(&folder))
}

/// Puts `fresh` in the place of `output`. Where the system can exchange two names in one go, there is never nothing at the
/// place; elsewhere the old one steps aside to `old`, and comes back if the new one cannot take its place.
fn swap(fresh: &Path, output: &Path, old: &Path) -> io::Result<()> {
    #[cfg(any(target_os = "linux", target_vendor = "apple"))]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        if renameat_with(CWD, fresh, CWD, output, RenameFlags::EXCHANGE).is_ok() {
            return Ok(());
        }
    }
    fs::rename(output, old)?;
    fs::rename(fresh, output).inspect_err(|_| {
        let _ = fs::rename(old, output);
    })
}

/// Copies what is not `ours` from a folder into another, where nothing stands in its place.
fn keep(from: &Path, to: &Path, ours: &[PathBuf]) -> Result<(), WriteError> {
    for entry in fs::read_dir(from).map_err(refuse(from))? {
        let (old, name) = {
            let entry = entry.map_err(refuse(from))?;
            (entry.path(), entry.file_name())
        };
        let new = to.join(name);
        let link = old.is_symlink();
        if old.is_dir() && !link {
            keep(&old, &new, ours)?;
        } else if !ours.contains(&old) && !new.exists() {
            fs::create_dir_all(to).map_err(refuse(to))?;
            let copied = if link {
                copy_link(&old, &new)
            } else {
                fs::copy(&old, &new).map(drop)
            };
            copied.map_err(refuse(&old))?;
        }
    }
    Ok(())
}

#[cfg(unix)]
fn copy_link(from: &Path, to: &Path) -> io::Result<()> {
    std::os::unix::fs::symlink(fs::read_link(from)?, to)
}

/// Elsewhere a link has to know what it leads to: that is copied.
#[cfg(not(unix))]
fn copy_link(from: &Path, to: &Path) -> io::Result<()> {
    fs::copy(from, to).map(drop)
}

fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::{WriteError, swap, write};
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
        let mut more = files("1");
        more.push(("rtl/stale.v".into(), vec![]));
        write(&more, &out).expect("once more");
        fs::write(out.join("rtl/notes"), "mine").expect("the user's own");
        fs::create_dir(out.join("own")).expect("the user's own");
        fs::write(out.join("own/letter"), "dear").expect("the user's own");
        write(&files("2"), &out).expect("second");
        assert!(!out.join("rtl/stale.v").exists());
        assert_eq!(
            fs::read_to_string(out.join("rtl/notes")).expect("kept"),
            "mine"
        );
        assert_eq!(
            fs::read_to_string(out.join("own/letter")).expect("kept"),
            "dear"
        );
        assert_eq!(fs::read_to_string(out.join("rtl/a.v")).expect("a.v"), "2");
        let left: Vec<_> = fs::read_dir(dir.path().join("deep"))
            .expect("folder")
            .collect();
        assert_eq!(left.len(), 1, "{left:?}");
        let mine = dir.path().join("mine");
        fs::create_dir(&mine).expect("folder");
        fs::write(mine.join("letter"), "dear").expect("file");
        fs::write(mine.join("design.json"), "{}").expect("file");
        assert!(matches!(
            write(&files("3"), &mine),
            Err(WriteError::NotOurs(_))
        ));
        assert!(mine.join("letter").is_file());
        let file = dir.path().join("file");
        fs::write(&file, "").expect("file");
        assert!(write(&files("4"), &file).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links() {
        use std::os::unix::fs::symlink;
        let dir = tempfile::tempdir().expect("scratch");
        let (out, link) = (dir.path().join("out"), dir.path().join("link"));
        write(&files("1"), &out).expect("first");
        symlink("nowhere", out.join("dangling")).expect("the user's own");
        symlink(".", out.join("loop")).expect("the user's own");
        symlink(&out, &link).expect("a link");
        write(&files("2"), &link).expect("second");
        assert!(
            link.is_symlink() && out.join("dangling").is_symlink() && out.join("loop").is_symlink()
        );
        assert_eq!(fs::read_to_string(out.join("rtl/a.v")).expect("a.v"), "2");
    }

    #[test]
    fn the_folder_that_the_command_runs_in_is_not_replaced() {
        let refused = write(&files("1"), std::path::Path::new(".")).expect_err("in use");
        assert!(matches!(refused, WriteError::Inside(_)), "{refused}");
    }

    #[test]
    fn two_folders_change_places() {
        let dir = tempfile::tempdir().expect("scratch");
        let [new, old, place] = ["new", "old", "place"].map(|name| dir.path().join(name));
        fs::create_dir(&new).expect("folder");
        fs::write(new.join("a"), "new").expect("file");
        fs::create_dir(&place).expect("folder");
        swap(&new, &place, &old).expect("changed");
        assert!(place.join("a").is_file());
        assert!(swap(&dir.path().join("none"), &place, &old).is_err());
        assert!(place.join("a").is_file(), "the old one came back");
    }
}
