//! Where something stands in a `design.toml`.

use std::fmt;

use toml::de::{DeTable, DeValue};

/// Line and column, counted from 1, of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

impl Place {
    /// Of the character at this byte.
    pub(super) fn of_byte(text: &str, byte: usize) -> Self {
        let before = text.get(..byte).unwrap_or_default();
        Self {
            line: before.matches('\n').count() + 1,
            column: before.rsplit('\n').next().map_or(0, |l| l.chars().count()) + 1,
        }
    }

    /// Where a `design.toml` gives `field` (`loop.type`, say, or `correction.harmonics[2].order` in the second of them): its key;
    /// `None` where the field is not given.
    #[must_use]
    pub fn of_field(text: &str, field: &str) -> Option<Self> {
        let parsed = DeTable::parse(text).ok()?;
        let (mut table, mut place) = (parsed.get_ref(), None);
        let mut parts = field.split('.').peekable();
        while let Some(part) = parts.next() {
            let (name, entry) = match part.strip_suffix(']').and_then(|it| it.split_once('[')) {
                Some((name, entry)) => (name, entry.parse::<usize>().ok()?.checked_sub(1)),
                None => (part, None),
            };
            let (key, value) = table.iter().find(|(key, _)| key.get_ref() == name)?;
            place = Some(key.span().start);
            let value = match (entry, value.get_ref()) {
                (Some(entry), DeValue::Array(entries)) => entries.get(entry)?.get_ref(),
                (_, value) => value,
            };
            if parts.peek().is_some() {
                let DeValue::Table(inner) = value else {
                    return None;
                };
                table = inner;
            }
        }
        place.map(|byte| Self::of_byte(text, byte))
    }
}

/// The field whose value stands at this byte, with its section: `adc.bits`, or `correction.harmonics[2].order`. `None` where
/// the text is not TOML or nothing has its value there.
pub(super) fn field_at(text: &str, byte: usize) -> Option<String> {
    let parsed = DeTable::parse(text).ok()?;
    within(parsed.get_ref(), byte)
}

fn within(table: &DeTable, byte: usize) -> Option<String> {
    // A section's own span is its head, so what stands in it is looked for first.
    let inside = table.iter().find_map(|(key, value)| {
        let key = key.get_ref();
        match value.get_ref() {
            DeValue::Table(inner) => within(inner, byte).map(|field| format!("{key}.{field}")),
            DeValue::Array(entries) => (1..).zip(entries.iter()).find_map(|(n, entry)| {
                let DeValue::Table(inner) = entry.get_ref() else {
                    return None;
                };
                within(inner, byte).map(|field| format!("{key}[{n}].{field}"))
            }),
            _ => None,
        }
    });
    inside.or_else(|| {
        let here = |value: std::ops::Range<usize>| value.contains(&byte);
        let found = table.iter().find(|(_, value)| here(value.span()));
        found.map(|(key, _)| key.get_ref().to_string())
    })
}
