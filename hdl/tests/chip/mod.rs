//! Chips of the shipped design and its variants, written to a folder.

use std::fs;
use std::path::Path;

use nonius_model::design::Design;
use nonius_model::spec::Spec;
use nonius_testvectors::{stimulus, vectors};

/// The shipped optical design.
pub(crate) fn optical() -> Spec {
    let text = fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../designs/optical.toml"
    ));
    Spec::from_toml(&text.expect("designs/optical.toml"), "optical.toml").expect("a shipped design")
}

/// Writes what the simulators need; `rows` samples of every stimulus.
pub(crate) fn write(spec: &Spec, rows: usize, dir: &Path) {
    let design = Design::new(spec).expect("a design that works");
    let stimuli = stimulus::named(&design, rows);
    let names: Vec<_> = stimuli
        .iter()
        .map(|s| (s.name.clone(), s.samples.len()))
        .collect();
    let chip = nonius_codegen::generate(&design, "test", &names).expect("templates render");
    let put = |path: &str, text: &str| {
        let path = dir.join(path);
        fs::create_dir_all(path.parent().expect("below dir")).expect("folder");
        fs::write(path, text).expect("file");
    };
    for (path, text) in &chip.files {
        put(path, text);
    }
    for one in &stimuli {
        put(
            &format!("vectors/{}.vec", one.name),
            &vectors::rows(&design, one, &chip.columns),
        );
    }
    let json = format!(
        "{{\"name\": \"{}\", \"clocks_per_sample\": {}}}",
        spec.name, chip.clocks
    );
    put("design.json", &json);
}
