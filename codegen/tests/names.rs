//! The Verilog can be read: its names say what they are, its lines end where a page does.

#[path = "../../designs/shipped.rs"]
mod shipped;

use nonius_codegen::generate;
use shipped::variants;

/// A decision that is named after what it goes into alone says nothing of itself.
#[test]
fn every_decision_has_a_name_of_its_own() {
    for variant in variants::everything() {
        let files = generate(&variant.design(), "0", &[]).expect("templates render");
        let chip = files.files.iter().find(|f| f.0.ends_with(".v"));
        let nameless: Vec<&str> = chip
            .expect("a chip")
            .1
            .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .filter(|word| word.contains("_condition"))
            .collect();
        assert!(nameless.is_empty(), "{}: {nameless:?}", variant.what);
    }
}

#[test]
fn no_line_is_longer_than_a_page_is_wide() {
    for variant in variants::everything() {
        let files = generate(&variant.design(), "0", &[]).expect("templates render");
        for (path, text) in files.files.iter().filter(|f| f.0.ends_with(".v")) {
            let long = text.lines().find(|line| line.chars().count() > 120);
            assert_eq!(long, None, "{}, {path}", variant.what);
        }
    }
}
