//! The README's tour without a recording, as a new user takes it.

use std::fs;
use std::path::Path;

use crate::support::nonius;

/// A line without its numbers, whose last digits other machines may have otherwise.
fn words(line: &str) -> String {
    let number = |c: char| c.is_ascii_digit() || c == '.';
    line.trim().replace(number, "")
}

/// Commands of the README's tour, and what it shows of what the diagnosis says.
fn tour(readme: &str) -> (Vec<Vec<&str>>, Vec<&str>) {
    let (_, from) = readme.split_once("## Without a recording").expect("a tour");
    let (tour, _) = from.split_once("\n## ").expect("what follows it");
    let code = tour.lines().filter_map(|line| line.strip_prefix("    "));
    let (commands, shown): (Vec<&str>, Vec<&str>) = code.partition(|l| l.starts_with("nonius "));
    let commands = commands
        .iter()
        .map(|line| line.split(' ').skip(1).collect());
    (commands.collect(), shown)
}

#[test]
fn the_tour_shows_what_the_readme_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let readme = fs::read_to_string(root.join("README.md")).expect("README.md");
    let (commands, shown) = tour(&readme);
    assert!(
        commands.len() >= 4 && shown.len() >= 3,
        "{commands:?} {shown:?}"
    );
    let dir = tempfile::tempdir().expect("scratch");
    for folder in ["designs", "sensor"] {
        let to = dir.path().join(folder);
        std::os::unix::fs::symlink(root.join(folder).canonicalize().expect("a folder"), to)
            .expect("a link");
    }
    let mut said = String::new();
    for command in &commands {
        let output = nonius(dir.path(), command);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command:?}: {error}");
        if command[0] == "diagnose" {
            said = String::from_utf8(output.stdout).expect("words");
        }
    }
    let said: Vec<String> = said.lines().map(words).collect();
    for line in shown {
        assert!(said.contains(&words(line)), "{line:?} is not in {said:?}");
    }
    // Both are corrected.
    let all = fs::read_to_string(dir.path().join("out/worn/design.toml")).expect("a design");
    assert!(
        all.contains("channel_skew_s") && all.contains("harmonics"),
        "{all}"
    );
}
