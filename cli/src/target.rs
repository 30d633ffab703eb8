//! A file that appears whole or not at all: written under a temporary name beside its place, then renamed.

use std::fs::File;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use tempfile::NamedTempFile;

/// A file being written.
pub(crate) struct Target {
    file: NamedTempFile,
    path: PathBuf,
}

impl Target {
    /// Begins a file at `path`.
    pub(crate) fn new(path: &Path) -> Result<Self> {
        if path.is_dir() {
            bail!("{} is a folder; name a file", path.display());
        }
        if path.exists() && !path.is_file() {
            bail!("{} is no ordinary file; name one", path.display());
        }
        let folder = path
            .parent()
            .filter(|p| !p.as_os_str().is_empty())
            .unwrap_or(Path::new("."));
        let cannot = || format!("cannot write into {}", folder.display());
        std::fs::create_dir_all(folder).with_context(cannot)?;
        let file = by_umask().tempfile_in(folder).with_context(cannot)?;
        Ok(Self {
            file,
            path: path.to_owned(),
        })
    }

    /// Where to write.
    pub(crate) fn file(&self) -> &File {
        self.file.as_file()
    }

    /// Gives the file its name; what stood there before is replaced.
    pub(crate) fn keep(self) -> Result<()> {
        self.file
            .persist(&self.path)
            .with_context(|| format!("cannot write {}", self.path.display()))?;
        Ok(())
    }

    /// Gives the file its name, unless a file of that name is there.
    pub(crate) fn keep_new(self) -> Result<()> {
        self.file
            .persist_noclobber(&self.path)
            .with_context(|| format!("{} is left as it is", self.path.display()))?;
        Ok(())
    }
}

/// A temporary file would be the owner's alone; a result is for whom the umask lets.
fn by_umask() -> tempfile::Builder<'static, 'static> {
    #[cfg_attr(not(unix), allow(unused_mut))]
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder
}
