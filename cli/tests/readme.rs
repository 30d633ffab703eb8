//! The README and the page of more figures quote numbers that commands have measured and written to docs/: each stands there as it is
//! quoted.

use std::fs;
use std::path::Path;

/// Every number that stands by itself, as it is written.
fn numbers(text: &str) -> Vec<&str> {
    let inside = |c: char| c.is_alphanumeric() || c == '_' || c == '.' || c == '-';
    text.split(|c: char| !inside(c))
        .map(|word| word.trim_matches(['.', '-']))
        .filter(|word| {
            word.starts_with(|c: char| c.is_ascii_digit()) && word.parse::<f64>().is_ok()
        })
        .collect()
}

/// What belongs together on a page: a row of a table, or a paragraph.
fn together(page: &str) -> Vec<String> {
    let mut all = vec![String::new()];
    for line in page.lines() {
        if line.starts_with('|') {
            all.extend([line.to_owned(), String::new()]);
        } else if line.is_empty() {
            all.push(String::new());
        } else if let Some(last) = all.last_mut() {
            *last += line;
            *last += "\n";
        }
    }
    all
}

/// What a row of a table is about.
fn label(row: &str) -> Option<&str> {
    let cell = row.strip_prefix('|')?.split('|').next()?.trim();
    cell.starts_with(char::is_alphabetic).then_some(cell)
}

/// Whether the numbers of `group` stand together on the page, in order; where the group names a row by its first cell, in a row
/// of that name.
fn quoted(group: &str, page: &[String]) -> bool {
    let labels = page.iter().filter_map(|row| label(row));
    let name = labels
        .filter(|label| group.contains(label))
        .max_by_key(|label| label.len());
    let asked = numbers(group);
    !asked.is_empty()
        && page
            .iter()
            .filter(|row| name.is_none() || label(row) == name)
            .any(|row| {
                let mut there = numbers(row).into_iter();
                asked.iter().all(|number| there.any(|it| it == *number))
            })
}

/// Pages of docs/ that a cell of a page in `folder` links to.
fn pages(cell: &str, folder: &str) -> Vec<String> {
    cell.split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .map(|link| format!("{folder}{link}"))
        .filter(|link| link.starts_with("docs/") && !link.contains(".."))
        .collect()
}

/// Rows of the page of figures that the tests named in a cell have written.
fn figures_of(cell: &str, page: Vec<String>) -> Vec<String> {
    let tests: Vec<&str> = cell.split('`').skip(1).step_by(2).collect();
    let own = |row: &String| {
        tests
            .iter()
            .any(|test| row.contains(&format!("| `{test}` |")))
    };
    page.into_iter().filter(own).collect()
}

#[test]
fn numbers_in_the_readme_stand_in_the_pages_behind_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut compared = 0;
    let quoting = [("README.md", ""), ("docs/measured.md", "docs/")];
    let lines = quoting.map(|(page, folder)| {
        let text = fs::read_to_string(root.join(page)).expect("a page");
        let rows = text.lines().filter(|l| l.starts_with('|'));
        rows.map(|row| (row.to_owned(), folder)).collect::<Vec<_>>()
    });
    for (line, folder) in lines.concat() {
        let cells: Vec<&str> = line.split('|').collect();
        let [_, _, _, measured, by, _] = cells.as_slice() else {
            continue;
        };
        let pages = pages(by, folder);
        if pages.is_empty() {
            continue;
        }
        let text: String = pages
            .iter()
            .map(|page| fs::read_to_string(root.join(page)).expect("a page that is linked"))
            .collect();
        let mut page = together(&text);
        if pages == ["docs/figures.md"] {
            page = figures_of(by, page);
        }
        for group in measured.split(';') {
            assert!(
                quoted(group, &page),
                "{group:?} does not stand together in {pages:?}: {line}"
            );
            compared += 1;
        }
    }
    assert!(compared > 150, "only {compared} groups were compared");
}

#[test]
fn a_number_of_another_row_is_no_quotation() {
    let page = together(
        "Of 7 seeds\nthe worst is 0.5 and 0.25.\n\n| design | LUT4 | MHz |\n|---|---|---|\n| optical | 3152 | 62.9 |\n\
         | magnetic | 2839 | 63.1 |\n",
    );
    for (group, holds) in [
        ("3152 LUT4, 62.9 MHz", true),
        ("optical 3152, 62.9", true),
        ("0.5, 0.25", true),
        ("7 … 0.25", true),
        // Of two rows, of another row, in another order, part of a number, and nothing.
        ("3152, 63.1", false),
        ("magnetic 3152", false),
        ("62.9, 3152", false),
        ("0.25, 0.5", false),
        ("315", false),
        ("2.9", false),
        ("LUT4", false),
        ("0.5, 3152", false),
    ] {
        assert_eq!(quoted(group, &page), holds, "{group}");
    }
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
    for page in [
        "README.md",
        "docs/measured.md",
        "docs/limits.md",
        "ARCHITECTURE.md",
    ] {
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

/// Whoever writes a design finds each key of it explained.
#[test]
fn every_key_of_a_design_is_explained() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let page = |name: &str| fs::read_to_string(docs.join(name)).expect(name);
    let (keys, words) = (page("design-file.md"), page("word-lengths.md"));
    for (section, key) in nonius_model::spec::keys() {
        let page = match section {
            "formats" => words.as_str(),
            // Of its own section, where it has one.
            _ => keys
                .split("\n## ")
                .find(|part| part.starts_with(&format!("`[{section}]`")))
                .unwrap_or(&keys),
        };
        assert!(page.contains(&format!("`{key}`")), "{section}.{key}");
    }
}
