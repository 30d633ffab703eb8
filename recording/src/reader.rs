//! The CSV text, line by line, into columns.

use std::io::BufRead;

use crate::columns::{Header, Role};
use crate::declared::{self, Declared, Overrides};
use crate::error::{Error, ErrorKind, Place};
use crate::lines::Lines;
use crate::recording::Columns;
use crate::table::{Table, is_blank};

/// Reads all of it.
pub(crate) fn read(
    source: impl BufRead,
    name: &str,
    overrides: &Overrides,
) -> Result<(Columns, Declared), Error> {
    let mut lines = Lines::new(source, name);
    let (header, mut declared) = head(&mut lines, overrides)?;
    if declared.sample_rate_hz.is_none() && !header.roles.contains(&Role::Time) {
        return Err(Error::new(
            Place::line(name, lines.number),
            ErrorKind::NoRate,
        ));
    }
    let mut table = Table::new(&header, lines.number);
    while let Some(line) = lines.next()? {
        table
            .take(line, &header)
            .map_err(|(at, kind)| lines.error(at, kind))?;
    }
    declared.notes.extend(table.note());
    Ok((table.columns, declared))
}

/// The `# key: value` lines and the header.
fn head<R: BufRead>(
    lines: &mut Lines<R>,
    overrides: &Overrides,
) -> Result<(Header, Declared), Error> {
    let mut said = declared::Lines::default();
    loop {
        let Some(line) = lines.next()?.map(str::to_owned) else {
            return Err(Error::new(Place::file(&lines.file), ErrorKind::Empty));
        };
        // A spreadsheet may have put quotes around the whole line.
        let text = line.trim_start_matches([' ', '\t', '"']);
        if let Some(text) = text.strip_prefix('#') {
            said.take(text, Place::line(&lines.file, lines.number))?;
        } else if !is_blank(&line) {
            let header = Header::read(&line, lines, overrides)?;
            let declared = said.finish(header.separator == ';', overrides)?;
            return Ok((header, declared));
        }
    }
}
