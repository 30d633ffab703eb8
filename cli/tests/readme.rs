//! The README quotes numbers that commands have measured and written to docs/: each stands there as it is quoted.

use std::fs;
use std::path::Path;

/// Numbers with a point, and those of two digits and more.
fn numbers(text: &str) -> Vec<String> {
    let inside = |c: char| c.is_ascii_digit() || c == '.' || c == 'e' || c == '-';
    text.split(|c: char| !inside(c))
        .map(|word| word.trim_matches(['.', '-', 'e']))
        .filter(|word| word.len() > 1 && word.parse::<f64>().is_ok())
        .map(str::to_owned)
        .collect()
}

/// Pages of docs/ that a cell links to.
fn pages(cell: &str) -> Vec<&str> {
    cell.split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .filter(|link| link.starts_with("docs/"))
        .collect()
}

#[test]
fn numbers_in_the_readme_stand_in_the_pages_behind_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let readme = fs::read_to_string(root.join("README.md")).expect("README.md");
    let mut compared = 0;
    for line in readme.lines().filter(|l| l.starts_with('|')) {
        let cells: Vec<&str> = line.split('|').collect();
        let [_, _, measured, by, _] = cells.as_slice() else {
            continue;
        };
        let pages = pages(by);
        if pages.is_empty() {
            continue;
        }
        let text: String = pages
            .iter()
            .map(|page| fs::read_to_string(root.join(page)).expect("a page that is linked"))
            .collect();
        // Rows of the page of figures are quoted as they are.
        if pages == ["docs/figures.md"] {
            let quoted = |row: &str| row.starts_with(&format!("|{}|{measured}|", cells[1]));
            assert!(text.lines().any(quoted), "not in docs/figures.md: {line}");
            compared += 1;
            continue;
        }
        let known = numbers(&text);
        for number in numbers(measured) {
            assert!(
                known.contains(&number),
                "{number} is not in {pages:?}: {line}"
            );
            compared += 1;
        }
    }
    assert!(compared > 20, "only {compared} numbers were compared");
}

/// A page that says FAIL is no proof of anything that the README says.
#[test]
fn no_page_says_fail() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let mut pages = 0;
    for entry in fs::read_dir(docs).expect("docs") {
        let path = entry.expect("an entry").path();
        if path.extension().is_some_and(|e| e == "md") {
            let text = fs::read_to_string(&path).expect("a page");
            assert!(!text.contains("FAIL"), "{}", path.display());
            pages += 1;
        }
    }
    assert!(pages > 10, "only {pages} pages were read");
}

#[test]
fn files_that_are_named_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut named = 0;
    for page in ["README.md", "ARCHITECTURE.md"] {
        let text = fs::read_to_string(root.join(page)).expect("a page");
        let mut last = String::new();
        for word in text.split('`').skip(1).step_by(2) {
            if !word.ends_with(".rs") && !word.ends_with('/') || word.contains(char::is_whitespace)
            {
                continue;
            }
            // `codegen/src/schedule.rs`, `settle.rs`: the second lies beside the first or in it.
            let beside = Path::new(&last).parent().unwrap_or(Path::new(""));
            let inside = Path::new(&last);
            let places = [
                Path::new(word).to_owned(),
                beside.join(word),
                inside.join(word),
                inside.join("src").join(word),
            ];
            let found = places.into_iter().find(|path| root.join(path).exists());
            let found = found.unwrap_or_else(|| panic!("{page}: {word} is not there"));
            last = found.to_string_lossy().into_owned();
            named += 1;
        }
    }
    assert!(named > 60, "only {named} files are named");
}
