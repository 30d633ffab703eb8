//! The truth, written and hashed before anybody looks, opened after.

use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

use crate::truth::Truth;

/// A truth that cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum SealError {
    /// The file cannot be written or read.
    #[error("{path}: {source}; is the folder there and writable?")]
    Io {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// What is in the file is not what was sealed.
    #[error(
        "{path}: the hash is {found}, sealed was {sealed}: the truth was changed after the verdict"
    )]
    Broken {
        /// Which.
        path: PathBuf,
        /// Hash of the file now.
        found: String,
        /// Hash when it was sealed.
        sealed: String,
    },
    /// Not a truth.
    #[error("{path}: {source}")]
    Json {
        /// Which.
        path: PathBuf,
        /// Why.
        source: serde_json::Error,
    },
}

/// A truth in a file, by its hash.
#[derive(Clone, Debug)]
pub struct Sealed {
    path: PathBuf,
    /// SHA-256 of the file, hexadecimal.
    pub hash: String,
}

/// Writes a truth into a folder.
///
/// # Errors
/// Where the file cannot be written.
pub fn seal(truth: &Truth, folder: &Path) -> Result<Sealed, SealError> {
    let path = folder.join(format!("truth-{}.json", truth.seed));
    let json = |source| SealError::Json {
        path: path.clone(),
        source,
    };
    let text = serde_json::to_string_pretty(truth).map_err(json)? + "\n";
    std::fs::write(&path, &text).map_err(|source| SealError::Io {
        path: path.clone(),
        source,
    })?;
    Ok(Sealed {
        path,
        hash: hash(text.as_bytes()),
    })
}

impl Sealed {
    /// Opens it.
    ///
    /// # Errors
    /// Where the file cannot be read or is not the one that was sealed.
    pub fn open(&self) -> Result<Truth, SealError> {
        let text = std::fs::read(&self.path).map_err(|source| SealError::Io {
            path: self.path.clone(),
            source,
        })?;
        let found = hash(&text);
        if found != self.hash {
            return Err(SealError::Broken {
                path: self.path.clone(),
                found,
                sealed: self.hash.clone(),
            });
        }
        serde_json::from_slice(&text).map_err(|source| SealError::Json {
            path: self.path.clone(),
            source,
        })
    }
}

fn hash(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
