//! Reading a design.

use std::path::Path;

use anyhow::{Context, Result};
use nonius_model::spec::Spec;

/// The design in a file.
pub(crate) fn read(path: &Path) -> Result<Spec> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {file}"))?;
    Ok(Spec::from_toml(&text, &file)?)
}
