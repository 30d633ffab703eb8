//! A page of figures: one row for each, written by the test that measures it.

use std::fs;
use std::path::Path;
use std::sync::Mutex;

/// Other machines have other last digits of the sine, and noise takes it from there.
const SLACK: f64 = 0.1;

/// One test at a time writes the page.
static PAGE: Mutex<()> = Mutex::new(());

/// The row of figure `name` on the page, docs/figures.md, says `measured`, its numbers to a tenth where they are no counts, and names `test`.
///
/// # Panics
/// The row is not there or says something else; with `NONIUS_BLESS` set it is written, and only a page that cannot be
/// panics.
#[track_caller]
pub fn figure(name: &str, measured: &str, test: &str) {
    let page = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/figures.md"));
    let lock = PAGE.lock();
    let text = fs::read_to_string(page).unwrap_or_else(|e| panic!("{}: {e}", page.display()));
    let row = format!("| {name} | {measured} | `{test}` |");
    if super::blessed() {
        let written = fs::write(page, with_row(&text, name, &row));
        written.unwrap_or_else(|e| panic!("{}: {e}", page.display()));
        return;
    }
    drop(lock);
    let kept = text.lines().find(|line| is_of(line, name)).unwrap_or("");
    // What is counted is exact.
    let measures = measured.contains('.');
    let slack = |x: f64| if measures { SLACK * x.abs() } else { 0.0 };
    if let Some((was, is)) = super::first_difference(kept, &row, slack) {
        panic!(
            "{}: {name}: {was:?} is {is:?} now ({measured}); if that is right: NONIUS_BLESS=1 cargo test",
            page.display()
        );
    }
}

/// The same where the long form ([`long`](super::long)) is not asked for: that has other figures, which are printed.
///
/// # Panics
/// As above.
#[track_caller]
pub fn figure_of_short(name: &str, measured: &str, test: &str) {
    if super::long() {
        println!("{name}: {measured}");
    } else {
        figure(name, measured, test);
    }
}

/// The same of a count of all that the long form tries, where the short form tries a part: compared at any time, written in the long
/// form only.
///
/// # Panics
/// As above.
#[track_caller]
pub fn figure_of_all(name: &str, measured: &str, test: &str) {
    if super::long() || !super::blessed() {
        figure(name, measured, test);
    }
}

fn is_of(line: &str, name: &str) -> bool {
    let rest = line.strip_prefix("| ").and_then(|l| l.strip_prefix(name));
    rest.is_some_and(|rest| rest.starts_with(" | "))
}

/// The page with this row in the table, which is its end, in the order of names.
fn with_row(text: &str, name: &str, row: &str) -> String {
    let (head, table) = match text.find("|---") {
        Some(at) => {
            let end = text[at..].find('\n').map_or(text.len(), |end| at + end + 1);
            text.split_at(end)
        }
        None => (text, ""),
    };
    let others = table.lines().filter(|line| !is_of(line, name));
    let mut rows: Vec<&str> = others.chain([row]).filter(|l| !l.is_empty()).collect();
    rows.sort_unstable();
    format!("{head}{}\n", rows.join("\n"))
}

#[test]
fn a_row_is_replaced_or_put_in_its_place() {
    let page = "# Page\n\n| a | b | c |\n|---|---|---|\n| one | 1 | `t` |\n| two | 2 | `t` |\n";
    let again = with_row(page, "one", "| one | 3 | `t` |");
    assert_eq!(again, page.replace("| 1 |", "| 3 |"));
    let more = with_row(page, "other", "| other | 4 | `t` |");
    assert_eq!(
        more,
        page.replace("| two |", "| other | 4 | `t` |\n| two |")
    );
    assert_eq!(with_row(&more, "other", "| other | 4 | `t` |"), more);
}
