//! The lines of a text, one at a time: UTF-8 checked, line ends and byte order mark removed.

use std::io::{BufRead, Read};

use crate::error::{Error, ErrorKind, Place};

/// Longest line accepted, in bytes.
const LIMIT: usize = 1 << 20;

pub(crate) struct Lines<R> {
    source: R,
    buffer: Vec<u8>,
    /// Name of the file, for messages.
    pub(crate) file: String,
    /// Number of the line read last, counted from 1.
    pub(crate) number: u64,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(source: R, file: &str) -> Self {
        Self {
            source,
            buffer: Vec::new(),
            file: file.to_owned(),
            number: 0,
        }
    }

    /// The next line, or `None` at the end.
    pub(crate) fn next(&mut self) -> Result<Option<&str>, Error> {
        self.buffer.clear();
        let mut limited = self.source.by_ref().take(LIMIT as u64 + 1);
        let read = limited.read_until(b'\n', &mut self.buffer);
        let read = read.map_err(|e| Error::new(Place::file(&self.file), ErrorKind::Io(e)))?;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        if self.number == 1 && matches!(self.buffer.get(..2), Some([0xFF, 0xFE] | [0xFE, 0xFF])) {
            return Err(self.error(0, ErrorKind::Utf16));
        }
        if read > LIMIT {
            return Err(self.error(LIMIT, ErrorKind::LineTooLong { limit: LIMIT }));
        }
        let end = self.buffer.strip_suffix(b"\n").unwrap_or(&self.buffer);
        let end = end.strip_suffix(b"\r").unwrap_or(end).len();
        self.buffer.truncate(end);
        if let Err(e) = std::str::from_utf8(&self.buffer) {
            return Err(self.error(e.valid_up_to(), ErrorKind::NotUtf8));
        }
        if let Some(at) = self.buffer.iter().position(|&b| b == b'\r') {
            return Err(self.error(at, ErrorKind::BareCarriageReturn));
        }
        if self.number == 1 && self.buffer.starts_with(b"\xEF\xBB\xBF") {
            self.buffer.drain(..3);
        }
        Ok(Some(std::str::from_utf8(&self.buffer).unwrap_or_default()))
    }

    /// The place of byte `at` of the line read last.
    pub(crate) fn place(&self, at: usize) -> Place {
        let before = self.buffer.get(..at).unwrap_or(&self.buffer);
        let characters = String::from_utf8_lossy(before).chars().count();
        Place::at(&self.file, self.number, characters as u64 + 1)
    }

    /// An error at byte `at` of the line read last.
    pub(crate) fn error(&self, at: usize, kind: ErrorKind) -> Error {
        Error::new(self.place(at), kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mark_and_line_ends_are_removed() {
        let mut lines = Lines::new("\u{feff}a\r\nb\n\nc".as_bytes(), "f");
        let mut all = Vec::new();
        while let Some(line) = lines.next().expect("memory") {
            all.push(line.to_owned());
        }
        assert_eq!(all, ["a", "b", "", "c"]);
        assert_eq!(lines.number, 4);
    }

    #[test]
    fn bytes_that_are_no_text_have_a_place() {
        let mut lines = Lines::new(&b"ok\n1,\xFF"[..], "f");
        lines.next().expect("memory");
        let error = lines.next().expect_err("a refusal");
        assert_eq!(error.place, Place::at("f", 2, 3));
        assert!(matches!(*error.kind, ErrorKind::NotUtf8));
    }

    #[test]
    fn utf_16_and_bare_carriage_returns_are_named() {
        let mut lines = Lines::new(&b"\xFF\xFEc\0o\0s\0"[..], "f");
        assert!(matches!(
            *lines.next().expect_err("a refusal").kind,
            ErrorKind::Utf16
        ));
        let mut lines = Lines::new(&b"cos,sin\r1,2\r"[..], "f");
        let error = lines.next().expect_err("a refusal");
        assert!(matches!(*error.kind, ErrorKind::BareCarriageReturn));
        assert_eq!(error.place.column, Some(8));
    }

    #[test]
    fn a_line_without_end_is_refused() {
        let mut lines = Lines::new(std::io::BufReader::new(std::io::repeat(b'1')), "f");
        let error = lines.next().expect_err("a refusal");
        assert!(matches!(*error.kind, ErrorKind::LineTooLong { .. }));
    }
}
