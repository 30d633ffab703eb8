//! The Verilog can be read: its names say what they are, its lines end where a page does.

use std::sync::LazyLock;

use crate::shipped::variants;
use nonius_codegen::generate;

/// What it is, and its Verilog: path and text.
type Chip = (String, Vec<(String, String)>);

/// Every variant's.
static CHIPS: LazyLock<Vec<Chip>> = LazyLock::new(|| {
    let chip = |variant: variants::Variant| {
        let files = generate(&variant.design(), "0", &[]).expect("templates render");
        let verilog = files.files.into_iter().filter(|f| f.0.ends_with(".v"));
        (variant.what.to_string(), verilog.collect())
    };
    variants::everything().into_iter().map(chip).collect()
});

/// A decision that is named after what it goes into alone says nothing of itself.
#[test]
fn every_decision_has_a_name_of_its_own() {
    for (what, verilog) in CHIPS.iter() {
        let (_, chip) = verilog.first().expect("a chip");
        let nameless: Vec<&str> = chip
            .split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
            .filter(|word| word.contains("_condition"))
            .collect();
        assert!(nameless.is_empty(), "{what}: {nameless:?}");
    }
}

#[test]
fn no_line_is_longer_than_a_page_is_wide() {
    for (what, verilog) in CHIPS.iter() {
        for (path, text) in verilog {
            let long = text.lines().find(|line| line.chars().count() > 120);
            assert_eq!(long, None, "{what}, {path}");
        }
    }
}
