//! Whether a kept file still says what is measured, its numbers within what another machine may change.

use std::path::Path;

/// Whether files are to be written anew.
pub(crate) fn blessed() -> bool {
    std::env::var_os("NONIUS_BLESS").is_some()
}

/// Fails where the file says something else, or a number that is off by more than `slack` of it; `how` makes it anew.
pub(crate) fn check(file: &Path, text: &str, slack: impl Fn(f64) -> f64, how: &str) {
    let kept = std::fs::read_to_string(file).unwrap_or_default();
    if let Some((was, is)) = first_difference(&kept, text, slack) {
        panic!("{}: {was:?} is {is:?} now; stale: {how}", file.display());
    }
}

/// Words and numbers, one after the other.
fn parts(text: &str) -> impl Iterator<Item = &str> {
    let number = |c: char| c.is_ascii_digit() || c == '.' || c == '-';
    let mut rest = text;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let kind = number(first);
        let end = rest.find(|c| number(c) != kind).unwrap_or(rest.len());
        let (part, left) = rest.split_at(end);
        rest = left;
        Some(part)
    })
}

fn first_difference(
    kept: &str,
    text: &str,
    slack: impl Fn(f64) -> f64,
) -> Option<(String, String)> {
    let (mut a, mut b) = (parts(kept), parts(text));
    loop {
        let (was, is) = (a.next(), b.next());
        let number = |part: Option<&str>| part?.parse::<f64>().ok();
        let near = match (number(was), number(is)) {
            (Some(x), Some(y)) => (x - y).abs() <= slack(x),
            _ => was == is,
        };
        if !near {
            return Some((was.unwrap_or("").into(), is.unwrap_or("").into()));
        }
        was?;
    }
}

#[test]
fn differences_are_seen() {
    let differs = |a: &str, b: &str| first_difference(a, b, |x| 0.01 * x.abs()).is_some();
    assert!(!differs("M1.00 2.00h0, 3 °", "M1.001 2.01h0, 3 °"));
    assert!(differs("M1.00 2.00h0", "M1.00 2.10h0"));
    assert!(differs("order 3", "order 3 of"));
    assert!(differs("order 3", "runout 3"));
}
