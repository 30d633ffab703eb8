//! The shipped designs, for tests and examples: `#[path = "../../designs/shipped.rs"] mod shipped;`.
#![allow(dead_code, reason = "each test uses its own part")]

use nonius_model::design::Design;
use nonius_model::spec::{CalibrationMethod, CalibrationStart, Spec};

/// All of them.
pub(crate) const NAMES: [&str; 3] = ["optical", "magnetic", "interferometer"];

/// What a shipped design asks for.
pub(crate) fn spec(name: &str) -> Spec {
    let path = format!("{}/../designs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped design");
    Spec::from_toml(&text, name).expect("a shipped design")
}

/// The optical one, which most tests alter.
pub(crate) fn optical() -> Spec {
    spec("optical")
}

/// Quantised.
pub(crate) fn design(name: &str) -> Design {
    Design::new(&spec(name)).expect("a shipped design")
}

/// The shipped designs, the magnetic one with its offset binary codes, and the optical one with every other search.
pub(crate) fn kinds() -> Vec<(String, Design)> {
    use CalibrationMethod::{Batch, Exact, Final, SumOfSquares};
    let mut kinds: Vec<_> = NAMES.map(|name| (name.to_owned(), design(name))).into();
    for (method, parameters, completion) in [
        (Final, 0, false),
        (Final, 4, false),
        (Final, 8, true),
        (Final, 9, true),
        (Final, 9, false),
        (Exact, 5, false),
        (SumOfSquares, 5, false),
        (Batch, 5, false),
    ] {
        let mut spec = optical();
        spec.calibration.method = method;
        spec.calibration.parameters = parameters;
        spec.calibration.completion = completion;
        let what = format!("{method:?}, {parameters} parameters, completed {completion}");
        kinds.push((what, Design::new(&spec).expect("a search of the paper")));
    }
    let mut spec = optical();
    spec.calibration.start = CalibrationStart::LeastSquares;
    let started = Design::new(&spec).expect("a started search");
    kinds.push(("started".into(), started));
    kinds
}
