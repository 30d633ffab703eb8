//! For tests: files that are kept in the repository are compared with what is made now, and written anew where
//! `NONIUS_BLESS` is set; and recordings that are kept elsewhere.

mod figures;
mod recordings;

pub use figures::{figure, figure_of_all, figure_of_short};
pub use recordings::{recording, recordings, units};

use std::fs;
use std::path::Path;

/// Whether the long form of a campaign is asked for: `NONIUS_LONG` is set.
#[must_use]
pub fn long() -> bool {
    std::env::var_os("NONIUS_LONG").is_some()
}

/// Every `nth` of these; in the long form all.
pub fn every<T>(nth: usize, all: impl IntoIterator<Item = T>) -> impl Iterator<Item = T> {
    all.into_iter().step_by(if long() { 1 } else { nth })
}

/// Whether kept files are to be written anew.
#[must_use]
pub fn blessed() -> bool {
    std::env::var_os("NONIUS_BLESS").is_some()
}

/// Writes the file anew where that is asked for.
///
/// # Panics
/// The file cannot be written.
fn bless(file: &Path, text: &str) {
    if blessed() {
        let folder = file.parent().unwrap_or(Path::new(""));
        let written = fs::create_dir_all(folder).and_then(|()| fs::write(file, text));
        written.unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    }
}

/// The file says exactly this; `how` makes it anew.
///
/// # Panics
/// The file says something else.
#[track_caller]
pub fn same(file: &Path, text: &str, how: &str) {
    near(file, text, |_| 0.0, how);
}

/// The file says this, its numbers within `slack` of what another machine may change; `how` makes it anew.
///
/// # Panics
/// The file says something else.
#[track_caller]
pub fn near(file: &Path, text: &str, slack: impl Fn(f64) -> f64, how: &str) {
    bless(file, text);
    let kept = fs::read_to_string(file).unwrap_or_default();
    if let Some((was, is)) = first_difference(&kept, text, slack) {
        panic!("{}: {was:?} is {is:?} now; stale: {how}", file.display());
    }
}

/// Every file of tests of a package is a module of the program that `root` is the text of, but for those that are programs of their
/// own.
///
/// # Panics
/// One is not.
#[track_caller]
pub fn every_module(package: &str, root: &str, alone: &[&str]) {
    let tests = Path::new(package).join("tests");
    let files = fs::read_dir(&tests).unwrap_or_else(|e| panic!("{}: {e}", tests.display()));
    for file in files {
        let path = file
            .unwrap_or_else(|e| panic!("{}: {e}", tests.display()))
            .path();
        let name = path
            .file_stem()
            .and_then(|n| n.to_str())
            .unwrap_or_default();
        let source = path.extension().is_some_and(|e| e == "rs");
        if source && !alone.contains(&name) && name != "all" {
            let here = root.contains(&format!("\nmod {name};\n"));
            assert!(here, "{}: no module of all.rs", path.display());
        }
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
            (Some(x), Some(y)) if was != is => (x - y).abs() <= slack(x) && slack(x) > 0.0,
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
    assert!(first_difference("1.0", "1.00", |_| 0.0).is_some());
    assert!(!differs("M1.00 2.00h0, 3 °", "M1.001 2.01h0, 3 °"));
    assert!(differs("M1.00 2.00h0", "M1.00 2.10h0"));
    assert!(differs("order 3", "order 3 of"));
    assert!(differs("order 3", "runout 3"));
}
