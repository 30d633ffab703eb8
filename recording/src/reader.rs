//! The CSV text, line by line, into columns.

use std::io::BufRead;

use crate::columns::{Header, Role};
use crate::declared::{self, Declared, Overrides};
use crate::error::{Error, ErrorKind, Place};
use crate::lines::Lines;
use crate::recording::Columns;
use crate::table::{Table, is_blank};
use crate::units::{self, Units};

/// Most lines before the header that an instrument writes about itself.
const PREAMBLE: u64 = 100;

/// Reads all of it.
pub(crate) fn read(
    source: impl BufRead,
    name: &str,
    overrides: &Overrides,
) -> Result<(Columns, Declared), Error> {
    let mut lines = Lines::new(source, name);
    let (header, mut declared) = head(&mut lines, overrides)?;
    units::one_of_names(&header)
        .map_err(|kind| Error::new(Place::line(name, lines.number), kind))?;
    let time = header.name(Role::Time).map(str::to_owned);
    if declared.sample_rate_hz.is_none() && time.is_none() {
        return Err(Error::new(
            Place::line(name, lines.number),
            ErrorKind::NoRate,
        ));
    }
    let own = time.as_deref().and_then(units::of_name);
    let mut unit = own;
    let mut table = Table::new(&header, lines.number, own.unwrap_or(1.0));
    // A row of units is the first that is not blank.
    let mut first = true;
    while let Some(line) = lines.next()? {
        if first && !is_blank(line) {
            first = false;
            match Units::of(line, &header) {
                Ok(None) => {}
                Ok(Some(units)) => {
                    table.take_units(&units);
                    unit = units.seconds.or(own);
                    continue;
                }
                Err((at, kind)) => return Err(lines.error(at, kind)),
            }
        }
        table
            .take(line, &header)
            .map_err(|(at, kind)| lines.error(at, kind))?;
    }
    if own.is_some() && unit != own {
        let note =
            "the row of units has another unit of time than the name of its column, and is taken";
        declared.notes.push(note.into());
    }
    if let (Some(time), None) = (time, unit) {
        let note = format!("the column '{time}' has no unit and is taken to be in seconds");
        declared.notes.push(note);
    }
    declared.notes.extend(table.note());
    Ok((table.columns, declared))
}

/// The `# key: value` lines and the header. Before that an instrument may write lines about itself.
fn head<R: BufRead>(
    lines: &mut Lines<R>,
    overrides: &Overrides,
) -> Result<(Header, Declared), Error> {
    let mut said = declared::Lines::default();
    let mut refused: Option<Refused> = None;
    loop {
        let too_far = |refused: &Refused| lines.number >= refused.first + PREAMBLE;
        if refused.as_ref().is_some_and(too_far) {
            break;
        }
        let Some(line) = lines.next()?.map(str::to_owned) else {
            break;
        };
        // A spreadsheet may have put quotes around the whole line.
        let text = line.trim_start_matches([' ', '\t', '"']);
        if let Some(text) = text.strip_prefix('#') {
            said.take(text, Place::line(&lines.file, lines.number))?;
            continue;
        }
        if is_blank(&line) {
            continue;
        }
        match Header::read(&line, lines, overrides) {
            Ok(header) => {
                let mut declared = said.finish(header.has_decimal_comma(), overrides)?;
                let skipped = refused.map(|refused| refused.said(lines.number));
                declared.notes.extend(skipped);
                return Ok((header, declared));
            }
            Err(error) => match columns(&error) {
                Some(columns) => {
                    refused = Some(Refused::or(refused, error, columns, lines.number));
                }
                None => return Err(error),
            },
        }
    }
    let empty = || Error::new(Place::file(&lines.file), ErrorKind::Empty);
    Err(refused.map_or_else(empty, |refused| refused.error))
}

/// Lines before the header, or what stands in its place.
struct Refused {
    /// Why the line that is most like a header is none.
    error: Error,
    /// Columns of that line.
    columns: usize,
    /// Number of the first line.
    first: u64,
}

impl Refused {
    /// One line more: of those with most columns the first is most like a header.
    fn or(before: Option<Self>, error: Error, columns: usize, line: u64) -> Self {
        let first = before.as_ref().map_or(line, |before| before.first);
        let this = Self {
            error,
            columns,
            first,
        };
        match before {
            Some(before) if before.columns >= columns => before,
            _ => this,
        }
    }

    /// What is said of them above a header in this line.
    fn said(&self, header: u64) -> String {
        let (first, last) = (self.first, header - 1);
        let not_read = if first == last {
            format!("line {first} was")
        } else {
            format!("lines {first} to {last} were")
        };
        format!("the header is line {header}: {not_read} not read, but for `# key: value`")
    }
}

/// Columns of a line that an instrument may have written about itself: it has not their names. Of another error there is no other line.
fn columns(error: &Error) -> Option<usize> {
    match &*error.kind {
        ErrorKind::MissingColumn { present, .. } => Some(present.len()),
        ErrorKind::UnknownSeparator { .. } | ErrorKind::NoHeader => Some(1),
        _ => None,
    }
}
