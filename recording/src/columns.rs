//! The header: which column is what.

use crate::cells::{Cells, number};
use crate::declared::Overrides;
use crate::error::{Error, ErrorKind, Place};
use crate::lines::Lines;

/// What the cells of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Time,
    Cos,
    Sin,
    Reference,
    Temperature,
    /// Kept by name, with the place among the other columns.
    Other(usize),
    /// Without a name, as a separator at the end of the header makes it.
    Nameless,
}

impl Role {
    /// Whether no number has to be in its cells.
    pub(crate) fn is_unused(self) -> bool {
        matches!(self, Self::Other(_) | Self::Nameless)
    }
}

/// The header.
#[derive(Debug)]
pub(crate) struct Header {
    /// `,`, `;` or a tab.
    pub(crate) separator: char,
    pub(crate) names: Vec<String>,
    pub(crate) roles: Vec<Role>,
}

impl Header {
    /// Reads the header from `line`, which is the line that `lines` read last.
    pub(crate) fn read<R: std::io::BufRead>(
        line: &str,
        lines: &Lines<R>,
        overrides: &Overrides,
    ) -> Result<Self, Error> {
        let separator = separator(line).map_err(|(at, kind)| lines.error(at, kind))?;
        let mut names: Vec<String> = Vec::new();
        let mut twice = None;
        for cell in Cells::new(line, separator) {
            let cell = cell.map_err(|open| lines.error(open.0, ErrorKind::UnclosedQuote))?;
            let name = cell.text.into_owned();
            if !name.is_empty() && names.contains(&name) {
                twice.get_or_insert((cell.at, name.clone()));
            }
            names.push(name);
        }
        let comma = has_decimal_comma(separator);
        let is_number = |n: &String| number(n, comma).is_some();
        if names.iter().filter(|n| !n.is_empty()).all(is_number) {
            return Err(lines.error(0, ErrorKind::NoHeader));
        }
        let place = Place::line(&lines.file, lines.number);
        let roles = roles(&names, overrides, &place)?;
        if let Some((at, name)) = twice {
            return Err(lines.error(at, ErrorKind::DuplicateColumn { name }));
        }
        Ok(Self {
            separator,
            names,
            roles,
        })
    }

    /// Whether numbers may have a decimal comma.
    pub(crate) fn has_decimal_comma(&self) -> bool {
        has_decimal_comma(self.separator)
    }

    /// The name of the first column that has a role.
    pub(crate) fn name(&self, role: Role) -> Option<&str> {
        let at = self.roles.iter().position(|r| *r == role)?;
        Some(&self.names[at])
    }

    /// Names of the columns that are kept and ignored.
    pub(crate) fn others(&self) -> impl Iterator<Item = &str> {
        let named = self.names.iter().zip(&self.roles);
        named
            .filter(|(_, r)| matches!(r, Role::Other(_)))
            .map(|(n, _)| n.as_str())
    }
}

/// Whether numbers between such separators may have a decimal comma.
fn has_decimal_comma(separator: char) -> bool {
    separator != ','
}

fn separator(line: &str) -> Result<char, (usize, ErrorKind)> {
    let mut quoted = false;
    let outside: Vec<(usize, char)> = line
        .char_indices()
        .filter(|&(_, c)| {
            quoted ^= c == '"';
            !quoted
        })
        .collect();
    let find = |wanted: char| {
        outside
            .iter()
            .find(|(_, c)| *c == wanted)
            .map(|(at, _)| *at)
    };
    if find(';').is_some() {
        return Ok(';');
    }
    if find(',').is_some() {
        return Ok(',');
    }
    let ends = line.len() - line.trim_start().len()..line.trim_end().len();
    let inside = |mark: char| outside.iter().find(|(i, c)| *c == mark && ends.contains(i));
    if inside('\t').is_some() {
        return Ok('\t');
    }
    for (mark, found) in [('|', "`|`"), (' ', "spaces")] {
        if let Some(at) = inside(mark) {
            return Err((at.0, ErrorKind::UnknownSeparator { found }));
        }
    }
    Ok(',')
}

/// Name of the column of times, in seconds.
const USUAL_TIME: &str = "time_s";

fn roles(names: &[String], overrides: &Overrides, place: &Place) -> Result<Vec<Role>, Error> {
    let refuse = |kind| Err(Error::new(place.clone(), kind));
    let mut roles = vec![Role::Nameless; names.len()];
    let wanted = overrides.time_column.as_deref().map(str::trim);
    let time = find(names, wanted.unwrap_or(USUAL_TIME), place)?;
    if let (Some(wanted), None) = (wanted, time) {
        return refuse(missing(wanted, "--time", names));
    }
    let reference = find(names, "reference_rad", place)?;
    let temperature = find(names, "temperature_c", place)?;
    let fixed = [
        (time, Role::Time),
        (reference, Role::Reference),
        (temperature, Role::Temperature),
    ];
    for (column, role) in fixed {
        let Some(column) = column else { continue };
        if roles[column] != Role::Nameless {
            let name = names[column].clone();
            let option = "--time";
            return refuse(ErrorKind::ReservedColumn { name, option });
        }
        roles[column] = role;
    }
    let signals = [
        (Role::Cos, "--cos", "cos", &overrides.cos_column),
        (Role::Sin, "--sin", "sin", &overrides.sin_column),
    ];
    for (role, option, usual, given) in signals {
        let wanted = given.as_deref().unwrap_or(usual).trim();
        let Some(column) = find(names, wanted, place)? else {
            return refuse(missing(wanted, option, names));
        };
        match roles[column] {
            Role::Nameless => roles[column] = role,
            Role::Cos => {
                return refuse(ErrorKind::SameColumn {
                    name: wanted.to_owned(),
                });
            }
            _ => {
                let name = wanted.to_owned();
                return refuse(ErrorKind::ReservedColumn { name, option });
            }
        }
    }
    let mut others = 0;
    for (role, name) in roles.iter_mut().zip(names) {
        if *role == Role::Nameless && !name.is_empty() {
            *role = Role::Other(others);
            others += 1;
        }
    }
    Ok(roles)
}

/// The column of that name: exactly so written, else the only one that differs in case alone.
fn find(names: &[String], wanted: &str, place: &Place) -> Result<Option<usize>, Error> {
    if wanted.is_empty() {
        return Ok(None);
    }
    if let Some(exact) = names.iter().position(|n| n == wanted) {
        return Ok(Some(exact));
    }
    let mut alike = (0..names.len()).filter(|&i| names[i].eq_ignore_ascii_case(wanted));
    let first = alike.next();
    match alike.next() {
        Some(second) => {
            let name = names[second].clone();
            Err(Error::new(
                place.clone(),
                ErrorKind::DuplicateColumn { name },
            ))
        }
        None => Ok(first),
    }
}

fn missing(wanted: &str, option: &'static str, names: &[String]) -> ErrorKind {
    let present: Vec<String> = names.iter().filter(|n| !n.is_empty()).cloned().collect();
    let nearest = nearest(wanted, present.iter().map(String::as_str)).map(str::to_owned);
    ErrorKind::MissingColumn {
        wanted: wanted.to_owned(),
        option,
        present,
        nearest,
    }
}

/// The name most like `wanted`, where one is like it at all.
pub(crate) fn nearest<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = wanted.to_lowercase();
    let likeness = |name: &str| {
        let name = name.to_lowercase();
        let (short, long) = if name.len() < wanted.len() {
            (&name, &wanted)
        } else {
            (&wanted, &name)
        };
        let contained = short.len() > 2 && long.contains(short.as_str());
        strsim::jaro_winkler(&name, &wanted) + f64::from(u8::from(contained))
    };
    names
        .map(|n| (likeness(n), n))
        .filter(|(l, _)| *l > 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, n)| n)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(line: &str, overrides: &Overrides) -> Result<Header, Error> {
        let mut lines = Lines::new(line.as_bytes(), "f");
        let line = lines.next().expect("memory").expect("a line").to_owned();
        Header::read(&line, &lines, overrides)
    }

    fn message(line: &str) -> String {
        header(line, &Overrides::default())
            .expect_err("several records in one")
            .to_string()
    }

    #[test]
    fn columns_find_their_roles() {
        let h = header("Time_s;sin;x;cos;", &Overrides::default()).expect("a header");
        let expected = [
            Role::Time,
            Role::Sin,
            Role::Other(0),
            Role::Cos,
            Role::Nameless,
        ];
        assert_eq!(h.roles, expected);
        assert_eq!(h.others().collect::<Vec<_>>(), ["x"]);
    }

    #[test]
    fn the_command_line_names_the_signals() {
        let overrides = Overrides {
            cos_column: Some("A".into()),
            sin_column: Some("B".into()),
            ..Overrides::default()
        };
        let h = header("cos,A,B", &overrides).expect("a header");
        assert_eq!(h.roles, [Role::Other(0), Role::Cos, Role::Sin]);
        let same = Overrides {
            sin_column: Some("A".into()),
            ..overrides
        };
        let error = header("A,B", &same).expect_err("a refusal");
        assert!(
            matches!(*error.kind, ErrorKind::SameColumn { .. }),
            "{error}"
        );
        let time = Overrides {
            sin_column: Some("time_s".into()),
            ..same
        };
        let error = header("A,time_s", &time).expect_err("a refusal");
        assert!(
            matches!(*error.kind, ErrorKind::ReservedColumn { .. }),
            "{error}"
        );
    }

    #[test]
    fn a_missing_column_is_explained() {
        let text = message("time_s,cos_V,sin");
        assert_eq!(
            text,
            "f:1: there is no column 'cos' (nearest: 'cos_V'); the columns are 'time_s', 'cos_V', \
             'sin'; name the right one with --cos COLUMN"
        );
        assert!(!message("time_s,ch1,ch2").contains("nearest"));
    }

    #[test]
    fn twins_strange_separators_and_bare_numbers_are_refused() {
        assert!(message("cos,sin,cos").starts_with("f:1:9: the column 'cos' is there twice"));
        assert!(message("COS,Cos,sin").contains("twice"));
        assert!(message("cos|sin").starts_with("f:1:4: the columns seem to be separated by `|`"));
        assert!(message("time_s cos sin").contains("spaces"));
        assert!(message("0.1,0.2").contains("numbers where the header"));
        assert!(message("cos,\"sin").starts_with("f:1:5: the quote"));
    }
}
