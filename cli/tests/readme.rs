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

/// A row's cells, or a paragraph, as a title of a link writes them.
fn written(row: &str) -> String {
    let cells = row.trim_matches('|').split('|').map(str::trim);
    cells.collect::<Vec<_>>().join(", ")
}

/// Whether the numbers of `group` are in what follows the first cell of the row, in order.
fn holds(row: &str, group: &str) -> bool {
    let cells = row.strip_prefix('|').and_then(|row| row.split_once('|'));
    let mut there = numbers(cells.map_or(row, |(_, rest)| rest)).into_iter();
    let asked = numbers(group);
    !asked.is_empty() && asked.iter().all(|number| there.any(|it| it == *number))
}

/// A page of docs/ that a cell links to, and the beginning of the row that is meant: the link's title.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Link<'a> {
    page: &'a str,
    row: Option<&'a str>,
}

/// Pages whose rows are sentences, of which several may hold the same numbers: there it is said which row is meant.
fn is_labelled(page: &str) -> bool {
    page.starts_with("blind") || page == "figures.md"
}

/// Whether the numbers of `group`, in a row with the label `own`, stand together, in order, in the row of the page that is meant: that which
/// the link's title begins; that of the same label; that whose label the group names; else in one place of the page and no other.
fn quoted(group: &str, own: &str, link: Link, page: &[String]) -> bool {
    let any = |meant: &dyn Fn(&str) -> bool, group: &str| {
        let mut rows = page.iter().filter(|row| meant(row));
        rows.any(|row| holds(row, group))
    };
    if let Some(begins) = link.row {
        return any(&|row| written(row).starts_with(begins), group);
    }
    if page.iter().any(|row| label(row) == Some(own)) {
        return any(&|row| label(row) == Some(own), group);
    }
    let labels = page.iter().filter_map(|row| label(row));
    let named = labels.filter(|label| group.contains(label));
    if let Some(name) = named.max_by_key(|label| label.len()) {
        return any(
            &|row| label(row) == Some(name),
            &group.replacen(name, "", 1),
        );
    }
    // The first cell may be one of the numbers.
    let whole = page.iter().map(|row| row.replace('|', " "));
    !is_labelled(link.page) && whole.filter(|row| holds(row, group)).count() == 1
}

/// Pages of docs/ that a cell of a page in `folder` links to.
fn links<'a>(cell: &'a str, folder: &str) -> Vec<Link<'a>> {
    cell.split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .map(|link| match link.split_once(" \"") {
            Some((page, title)) => (page, Some(title.trim_end_matches('"'))),
            None => (link, None),
        })
        .filter(|(page, _)| !page.contains(".."))
        .filter_map(|(page, row)| {
            let page = match folder {
                "" => page.strip_prefix("docs/")?,
                _ => page,
            };
            Some(Link { page, row })
        })
        .collect()
}

/// The groups of numbers in a cell, each with the link that is its own; all are one where a single link says which row is meant.
fn groups<'a>(measured: &'a str, links: &[Link<'a>]) -> Vec<(&'a str, Link<'a>)> {
    match links {
        [link] if link.row.is_some() => vec![(measured, *link)],
        [link] => measured.split(';').map(|group| (group, *link)).collect(),
        links => {
            let groups: Vec<&str> = measured.split(';').collect();
            assert_eq!(groups.len(), links.len(), "{measured}: {links:?}");
            groups.into_iter().zip(links.iter().copied()).collect()
        }
    }
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
        let [_, own, _, measured, by, _] = cells.as_slice() else {
            continue;
        };
        let links = links(by, folder);
        if links.is_empty() {
            continue;
        }
        for (group, link) in groups(measured, &links) {
            let text = fs::read_to_string(root.join("docs").join(link.page));
            let mut page = together(&text.expect("a page that is linked"));
            if link.page == "figures.md" {
                page = figures_of(by, page);
            }
            assert!(
                quoted(group, own.trim(), link, &page),
                "{group:?} does not stand in the row of {link:?} that is meant: {line}"
            );
            compared += numbers(group).len();
        }
    }
    assert!(compared > 400, "only {compared} numbers were compared");
}

#[test]
fn a_number_of_another_row_is_no_quotation() {
    let page = together(
        "Of 7 seeds\nthe worst is 0.5 and 0.25.\n\n| design | LUT4 | MHz |\n|---|---|---|\n| optical | 3152 | 62.9 |\n\
         | magnetic | 2839 | 63.1 |\n| 300 to 400 | 0.25 | 9 |\n",
    );
    let link = |row| Link {
        page: "synthesis.md",
        row,
    };
    for (group, own, row, stands) in [
        ("3152 LUT4, 62.9 MHz", "", None, true),
        ("optical 3152, 62.9", "", None, true),
        ("3152, 62.9", "optical", None, true),
        ("3152, 62.9", "a design", Some("optical, 3152"), true),
        ("0.5, 0.25", "", None, true),
        ("7 … 0.25", "", None, true),
        ("400: 0.25, 9", "", None, true),
        // Of two rows, of another row, in another order, part of a number, and nothing.
        ("3152, 63.1", "", None, false),
        ("magnetic 3152", "", None, false),
        ("3152, 62.9", "magnetic", None, false),
        ("3152", "optical", Some("magnetic"), false),
        ("3152", "optical", Some("LUT4"), false),
        ("62.9, 3152", "", None, false),
        ("0.25, 0.5", "", None, false),
        ("315", "", None, false),
        ("2.9", "", None, false),
        ("LUT4", "", None, false),
        ("0.5, 3152", "", None, false),
        // In two places, and a number of the label.
        ("0.25", "", None, false),
        ("400", "", Some("300 to 400"), false),
    ] {
        let found = quoted(group, own, link(row), &page);
        assert_eq!(found, stands, "{group}, {own}, {row:?}");
    }
}

/// Two rows of the campaign with one and the same number: whichever changes, the row of its label is the one that no longer stands.
#[test]
fn the_same_number_in_another_row_of_the_campaign_is_no_quotation() {
    let labels = [
        "nothing hidden: a sensor cause named",
        "nothing hidden: unexplained",
    ];
    let page = |[named, unexplained]: [&str; 2]| {
        together(&format!(
            "|  | target | reversing |\n| {} | ≤ 0.5 % | {named} |\n| {} | ≤ 1 % | {unexplained} |\n",
            labels[0], labels[1]
        ))
    };
    let (said, other) = ("0.2 % (1/543)", "0.4 % (2/543)");
    let link = Link {
        page: "blind-reversing.md",
        row: None,
    };
    for (page, stand) in [
        (page([said, said]), [true, true]),
        (page([said, other]), [true, false]),
        (page([other, said]), [false, true]),
    ] {
        let found = labels.map(|own| quoted(said, own, link, &page));
        assert_eq!(found, stand);
        // Under a label that the page does not have nothing stands, however single it is.
        assert!(!quoted(said, "said to hold something", link, &page));
    }
}

/// Each group has the link of its place, so a number of one draw is none of another.
#[test]
fn groups_go_with_their_links() {
    let cell = r#"[one](docs/blind.md), [two](docs/blind-many.md "causes named"), `a/test.rs`"#;
    let found = links(cell, "");
    let [one, two] = found.as_slice() else {
        panic!("{found:?}")
    };
    assert_eq!((one.page, one.row), ("blind.md", None));
    assert_eq!((two.page, two.row), ("blind-many.md", Some("causes named")));
    let zipped = groups("0.2 %; 0.3 %", &found);
    assert_eq!(zipped, [("0.2 %", *one), (" 0.3 %", *two)]);
    assert_eq!(groups("1; 2", &[*two]), [("1; 2", *two)]);
    assert_eq!(groups("1; 2", &[*one]), [("1", *one), (" 2", *one)]);
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
