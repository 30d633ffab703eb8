//! The shipped designs, for tests and examples: `#[path = "../../designs/shipped.rs"] mod shipped;`.
#![allow(dead_code, reason = "each test uses its own part")]

use nonius_model::design::Design;
use nonius_model::spec::Spec;

pub(crate) mod variants;
pub(crate) mod words;

/// All of them.
pub(crate) const NAMES: [&str; 3] = ["optical", "magnetic", "interferometer"];

/// The text of a shipped design.
pub(crate) fn text(name: &str) -> String {
    let path = format!("{}/../designs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a shipped design")
}

/// What it asks for.
pub(crate) fn spec(name: &str) -> Spec {
    Spec::from_toml(&text(name), name).expect("a shipped design")
}

/// The optical one, which most tests alter.
pub(crate) fn optical() -> Spec {
    spec("optical")
}

/// Quantised.
pub(crate) fn design(name: &str) -> Design {
    Design::new(&spec(name)).expect("a shipped design")
}
