//! A line's cells and the numbers in them.

use std::borrow::Cow;

/// One cell, without the spaces and quotes around it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Cell<'a> {
    pub(crate) text: Cow<'a, str>,
    /// Byte of the line at which it begins.
    pub(crate) at: usize,
}

/// A quote that opens at this byte and does not close.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Unclosed(pub(crate) usize);

/// Iterates over the cells of a line.
pub(crate) struct Cells<'a> {
    line: &'a str,
    separator: char,
    /// Where the next cell begins; `None` after the last.
    next: Option<usize>,
}

impl<'a> Cells<'a> {
    /// `separator` is an ASCII character: `,`, `;` or a tab.
    pub(crate) fn new(line: &'a str, separator: char) -> Self {
        Self {
            line,
            separator,
            next: Some(0),
        }
    }

    /// The cell from byte `from` on, and where the cell after it begins.
    fn cell(&self, from: usize) -> Result<(Cell<'a>, Option<usize>), Unclosed> {
        let rest = &self.line[from..];
        // A tab may be the separator.
        let blank = |c: char| c.is_whitespace() && c != self.separator;
        let at = from + (rest.len() - rest.trim_start_matches(blank).len());
        // The end of the quoted part: a separator counts only behind it.
        let body = match self.line[at..].strip_prefix('"') {
            Some(quoted) => at + 1 + closing_quote(quoted).ok_or(Unclosed(at))? + 1,
            None => at.min(from + rest.find(self.separator).unwrap_or(rest.len())),
        };
        let end = self.line[body..]
            .find(self.separator)
            .map_or(self.line.len(), |i| body + i);
        let next = (end < self.line.len()).then_some(end + 1);
        let text = self.line[at.min(end)..end].trim_end();
        let text = match text.strip_prefix('"').and_then(|t| t.strip_suffix('"')) {
            Some(inner) if inner.contains("\"\"") => Cow::Owned(inner.replace("\"\"", "\"")),
            Some(inner) => Cow::Borrowed(inner.trim()),
            None => Cow::Borrowed(text),
        };
        Ok((Cell { text, at }, next))
    }
}

impl<'a> Iterator for Cells<'a> {
    type Item = Result<Cell<'a>, Unclosed>;

    fn next(&mut self) -> Option<Self::Item> {
        let from = self.next?;
        Some(match self.cell(from) {
            Ok((cell, next)) => {
                self.next = next;
                Ok(cell)
            }
            Err(unclosed) => {
                self.next = None;
                Err(unclosed)
            }
        })
    }
}

/// The byte of the quote that closes `text`; a doubled quote does not.
fn closing_quote(text: &str) -> Option<usize> {
    let mut quotes = text.match_indices('"').map(|(i, _)| i).peekable();
    while let Some(i) = quotes.next() {
        if quotes.next_if_eq(&(i + 1)).is_none() {
            return Some(i);
        }
    }
    None
}

/// The number in a cell, or `None`. May be infinite or NaN.
pub(crate) fn number(text: &str, decimal_comma: bool) -> Option<f64> {
    if decimal_comma && text.contains(',') && !text.contains('.') {
        return text.replacen(',', ".", 1).parse().ok();
    }
    text.parse().ok()
}

/// How finely a column of numbers is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Digits {
    /// Most digits behind the point in any cell; negative for 1e3.
    decimals: i32,
    /// Most digits of the mantissa in any cell.
    significant: i32,
}

impl Default for Digits {
    fn default() -> Self {
        Self {
            decimals: i32::MIN,
            significant: 0,
        }
    }
}

impl Digits {
    /// Takes the cell `text` into account.
    pub(crate) fn see(&mut self, text: &str) {
        let (mantissa, exponent) = match text.find(['e', 'E']) {
            Some(i) => (&text[..i], text[i + 1..].parse::<i32>().unwrap_or(0)),
            None => (text, 0),
        };
        let digits = |t: &str| t.bytes().filter(u8::is_ascii_digit).count() as i32;
        let behind = mantissa
            .find(['.', ','])
            .map_or(0, |i| digits(&mantissa[i..]));
        let all = digits(mantissa.trim_start_matches(['-', '+', '0', '.', ',']));
        self.decimals = self.decimals.max(behind.saturating_sub(exponent));
        self.significant = self.significant.max(all);
    }

    /// The step of the text in a column whose largest magnitude is `largest`; 0 where it is unknown.
    pub(crate) fn quantum(self, largest: f64) -> f64 {
        if self.decimals == i32::MIN {
            return 0.0;
        }
        let leading = if largest > 0.0 {
            largest.log10().floor() as i32 + 1
        } else {
            0
        };
        let decimals = self.decimals.min(self.significant.saturating_sub(leading));
        // Whole numbers with trailing zeros still count ones.
        10f64.powi(-decimals.max(self.decimals.min(0)).clamp(-30, 30))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(line: &str, separator: char) -> Vec<String> {
        Cells::new(line, separator)
            .map(|c| c.expect("a cell").text.into_owned())
            .collect()
    }

    #[test]
    fn spaces_and_quotes_around_cells_go() {
        assert_eq!(cells(" a , \"b\" ,c", ','), ["a", "b", "c"]);
        assert_eq!(cells("\"a,\"\"x\"\"\",2", ','), ["a,\"x\"", "2"]);
        assert_eq!(cells("1;;", ';'), ["1", "", ""]);
        assert_eq!(cells("", ','), [""]);
        assert_eq!(cells(" , ", ','), ["", ""]);
    }

    #[test]
    fn cells_know_their_place() {
        let at: Vec<_> = Cells::new("1, 22 ,\"3\"", ',')
            .map(|c| c.expect("a cell").at)
            .collect();
        assert_eq!(at, [0, 3, 7]);
    }

    #[test]
    fn an_open_quote_is_an_error() {
        let all: Vec<_> = Cells::new("1,\"2,3", ',').collect();
        assert_eq!(all[1], Err(Unclosed(2)));
        assert_eq!(all.len(), 2);
    }

    #[test]
    fn decimal_commas_only_where_they_are_meant() {
        assert_eq!(number("1,5", true), Some(1.5));
        assert_eq!(number("-2.5e-3", true), Some(-0.0025));
        assert_eq!(number("1,5", false), None);
        assert_eq!(number("1.000,5", true), None);
        assert_eq!(number("1,000,5", true), None);
        assert_eq!(number("", true), None);
    }

    #[test]
    fn digits_give_the_step_of_the_text() {
        let quantum = |cells: &[&str], largest| {
            let mut digits = Digits::default();
            cells.iter().for_each(|c| digits.see(c));
            digits.quantum(largest)
        };
        assert_eq!(quantum(&["0.5", "0.4350"], 0.5), 1e-4);
        assert_eq!(quantum(&["100", "4000"], 4000.0), 1.0);
        assert_eq!(quantum(&["1.234e-4", "5.678e-1"], 0.5678), 1e-4);
        assert_eq!(quantum(&[], 1.0), 0.0);
    }
}
