//! The rows of the table, cell by cell, into columns.

use crate::cells::{Cell, Cells, number};
use crate::columns::{Header, Role};
use crate::error::{ErrorKind, shorten};
use crate::recording::{Columns, OtherColumn};
use crate::time::Clock;
use crate::units::Units;

/// Magnitude beyond which a number is no measurement.
pub(crate) const LARGEST: f64 = 1e30;

/// The rows read so far.
pub(crate) struct Table {
    pub(crate) columns: Columns,
    clock: Clock,
    row: Vec<f64>,
    previous: Vec<f64>,
    /// Seconds in the unit of the times.
    seconds: f64,
    /// A row may have no cells in columns that are only kept: such a header names what one row alone has.
    may_be_short: bool,
    /// Line read last.
    line: u64,
    /// The first blank line, and the same once a row stands behind it.
    blank: Option<u64>,
    blank_inside: Option<u64>,
}

impl Table {
    /// `line` is the line of the header, `seconds` the unit of the times.
    pub(crate) fn new(header: &Header, line: u64, seconds: f64) -> Self {
        let column = |role| header.roles.contains(&role).then(Vec::new);
        let name = |role| header.name(role).unwrap_or_default().to_owned();
        let other = |n: &str| OtherColumn {
            name: n.to_owned(),
            values: Vec::new(),
        };
        let columns = Columns {
            time_s: column(Role::Time),
            reference_rad: column(Role::Reference),
            temperature_c: column(Role::Temperature),
            other: header.others().map(other).collect(),
            cos_name: name(Role::Cos),
            sin_name: name(Role::Sin),
            ..Columns::default()
        };
        Self {
            columns,
            clock: Clock::default(),
            seconds,
            may_be_short: false,
            line,
            row: Vec::new(),
            previous: Vec::new(),
            blank: None,
            blank_inside: None,
        }
    }

    /// Takes the row of units below the header.
    pub(crate) fn take_units(&mut self, units: &Units) {
        self.line += 1;
        self.seconds = units.seconds.unwrap_or(self.seconds);
        self.may_be_short = true;
    }

    /// Takes the next line; an error comes with its byte in the line.
    pub(crate) fn take(&mut self, line: &str, header: &Header) -> Result<(), (usize, ErrorKind)> {
        self.line += 1;
        if is_blank(line) {
            if !self.columns.cos.is_empty() {
                self.blank.get_or_insert(self.line);
            }
            return Ok(());
        }
        if line.trim_start().starts_with('#') {
            return Err((0, ErrorKind::CommentInData));
        }
        self.blank_inside = self.blank_inside.or(self.blank);
        self.row.clear();
        let mut time_at = 0;
        for cell in Cells::new(line, header.separator) {
            let cell = cell.map_err(|open| (open.0, ErrorKind::UnclosedQuote))?;
            let Some(role) = header.roles.get(self.row.len()) else {
                return Err((cell.at, ragged(line, header)));
            };
            if *role == Role::Time {
                time_at = cell.at;
            }
            let value = self.value(&cell, *role, header)?;
            self.row.push(value);
        }
        let mut missing = header.roles.iter().skip(self.row.len());
        if missing.any(|role| !(self.may_be_short && role.is_unused())) {
            return Err((line.len(), ragged(line, header)));
        }
        self.row.resize(header.roles.len(), f64::NAN);
        self.push(header).map_err(|kind| (time_at, kind))?;
        std::mem::swap(&mut self.row, &mut self.previous);
        Ok(())
    }

    fn value(
        &mut self,
        cell: &Cell<'_>,
        role: Role,
        header: &Header,
    ) -> Result<f64, (usize, ErrorKind)> {
        let comma = header.has_decimal_comma();
        let value = number(&cell.text, comma);
        match role {
            Role::Cos => self.columns.cos_digits.see(&cell.text),
            Role::Sin => self.columns.sin_digits.see(&cell.text),
            _ if role.is_unused() => return Ok(value.unwrap_or(f64::NAN)),
            _ => {}
        }
        let names = || (header.names[self.row.len()].clone(), shorten(&cell.text));
        let Some(value) = value else {
            let (column, text) = names();
            let hint = hint(&cell.text, comma);
            return Err((
                cell.at,
                ErrorKind::NotANumber {
                    column,
                    cell: text,
                    hint,
                },
            ));
        };
        let value = in_range(value, names).map_err(|kind| (cell.at, kind))?;
        Ok(if role == Role::Time {
            value * self.seconds
        } else {
            value
        })
    }

    /// Checks the time and appends the row to the columns.
    fn push(&mut self, header: &Header) -> Result<(), ErrorKind> {
        let value = |role| {
            let cell = header.roles.iter().position(|r| *r == role);
            cell.and_then(|i| self.row.get(i))
                .copied()
                .unwrap_or_default()
        };
        if header.roles.contains(&Role::Time) {
            let checked = self
                .clock
                .check(value(Role::Time), value(Role::Cos), value(Role::Sin));
            checked.map_err(|kind| self.explain(kind, header))?;
        }
        for (role, value) in header.roles.iter().zip(&self.row) {
            let columns = &mut self.columns;
            let column = match role {
                Role::Time => columns.time_s.as_mut(),
                Role::Cos => Some(&mut columns.cos),
                Role::Sin => Some(&mut columns.sin),
                Role::Reference => columns.reference_rad.as_mut(),
                Role::Temperature => columns.temperature_c.as_mut(),
                Role::Other(i) => columns.other.get_mut(*i).map(|o| &mut o.values),
                Role::Nameless => None,
            };
            if let Some(column) = column {
                column.push(*value);
            }
        }
        Ok(())
    }

    /// Says where time runs back because another record begins.
    fn explain(&self, kind: ErrorKind, header: &Header) -> ErrorKind {
        let ErrorKind::TimeBack {
            previous,
            time,
            hint,
        } = kind
        else {
            return kind;
        };
        let first = self
            .columns
            .time_s
            .as_ref()
            .and_then(|t| t.first())
            .copied();
        let mark = (0..header.roles.len()).find(|i| self.marks(*i, header.roles[*i]));
        let hint = match mark {
            Some(mark) => format!(
                "the file seems to hold several records, as the column '{}' changes at this row: \
                 give one record at a time",
                header.names[mark]
            ),
            None if first.is_some_and(|f| time <= f) => {
                "the file seems to hold several records: give one record at a time".to_owned()
            }
            None => hint,
        };
        ErrorKind::TimeBack {
            previous,
            time,
            hint,
        }
    }

    /// True where cell `i` of this row differs from the one constant value it had before.
    fn marks(&self, i: usize, role: Role) -> bool {
        let (Role::Other(j), Some(now), Some(last)) = (role, self.row.get(i), self.previous.get(i))
        else {
            return false;
        };
        let before = self.columns.other.get(j);
        now != last && before.is_some_and(|o| o.values.iter().all(|v| v == last))
    }

    /// What to say about blank lines.
    pub(crate) fn note(&self) -> Option<String> {
        let line = self.blank_inside?;
        Some(format!(
            "blank lines among the samples were skipped, the first is line {line}"
        ))
    }
}

/// True for a line without a cell that holds anything.
pub(crate) fn is_blank(line: &str) -> bool {
    line.chars().all(|c| c.is_whitespace() || ",;".contains(c))
}

/// The value, where it is finite and of a possible size; `names` gives column and cell.
pub(crate) fn in_range(value: f64, names: impl Fn() -> (String, String)) -> Result<f64, ErrorKind> {
    if value.abs() <= LARGEST {
        return Ok(value);
    }
    let (column, cell) = names();
    Err(if value.is_finite() {
        ErrorKind::TooLarge { column, cell }
    } else {
        ErrorKind::NotFinite { column, cell }
    })
}

fn hint(cell: &str, comma: bool) -> &'static str {
    if cell.is_empty() {
        "the cell is empty: fill it or remove the row"
    } else if cell.contains(',') && !comma {
        "a decimal comma needs `;` or tabs between the columns"
    } else if cell.contains(',') {
        "expected one decimal comma or point, and nothing between the thousands"
    } else {
        "expected a number such as -0.125 or 1.2e-3"
    }
}

fn ragged(line: &str, header: &Header) -> ErrorKind {
    let expected = header.roles.len();
    let found = Cells::new(line, header.separator).count();
    let hint = if header.separator == ',' && found == 2 * expected {
        "numbers with a decimal comma need `;` or tabs between the columns"
    } else if line.contains(';') && header.separator == ',' {
        "the header has `,` between the columns and this row `;`: use one of them"
    } else if found > expected {
        "remove the extra cells, or name their columns in the header"
    } else {
        "complete or remove the row"
    };
    ErrorKind::RaggedRow {
        expected,
        found,
        hint,
    }
}
