//! Reading a design.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use anyhow::{Context, Error, Result, anyhow, bail};
use nonius_model::design::{Design, DesignError};
use nonius_model::spec::{Place, Spec};

/// A design is a page of text; what is longer is something else.
const LONGEST: u64 = 1 << 20;

/// The design in a file, quantised, and the file's text; an error names the place of the field that cannot be.
pub(crate) fn read(path: &Path) -> Result<(Design, String)> {
    let file = path.display().to_string();
    let text = text(path, &file)?;
    let spec = Spec::from_toml(&text, &file)?;
    let design = Design::new(&spec).map_err(|error| placed(path, &text, &error))?;
    Ok((design, text))
}

/// A refusal with the place of its field.
pub(crate) fn placed(path: &Path, text: &str, error: &DesignError) -> Error {
    anyhow!("{}: {error}", place(path, text, error.field()))
}

/// Where a field stands: file:line:column, or the file where it is left out.
pub(crate) fn place(path: &Path, text: &str, field: &str) -> String {
    let file = path.display();
    match Place::of_field(text, field) {
        Some(place) => format!("{file}:{place}"),
        None => file.to_string(),
    }
}

fn text(path: &Path, file: &str) -> Result<String> {
    let mut text = String::new();
    let opened = File::open(path).with_context(|| format!("cannot read {file}"))?;
    let length = opened.take(LONGEST + 1).read_to_string(&mut text);
    if length.with_context(|| format!("cannot read {file}"))? as u64 > LONGEST {
        bail!("{file} is longer than {LONGEST} bytes: it is no design");
    }
    Ok(text)
}
