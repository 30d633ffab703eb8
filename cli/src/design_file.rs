//! Reading a design.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::{Context, Result, bail};
use nonius_model::spec::Spec;

/// A design is a page of text; what is longer is something else.
const LONGEST: u64 = 1 << 20;

/// The design in a file.
pub(crate) fn read(path: &Path) -> Result<Spec> {
    let file = path.display().to_string();
    let mut text = String::new();
    let opened = File::open(path).with_context(|| format!("cannot read {file}"))?;
    let length = opened.take(LONGEST + 1).read_to_string(&mut text);
    if length.with_context(|| format!("cannot read {file}"))? as u64 > LONGEST {
        bail!("{file} is longer than {LONGEST} bytes: it is no design");
    }
    Ok(Spec::from_toml(&text, &file)?)
}
