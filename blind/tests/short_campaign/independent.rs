//! The generator is not the model that it tests.

use std::path::Path;

/// A generator that used the diagnosis' code would be the model looking at itself.
#[test]
fn nothing_that_simulates_uses_the_rest_of_the_project() {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let effects = sources.join("effects");
    let files = [&sources, &effects].map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let mut read = 0;
    for file in files
        .into_iter()
        .flatten()
        .map(|f| f.expect("a file").path())
    {
        let name = file
            .file_name()
            .and_then(|n| n.to_str())
            .unwrap_or("")
            .to_owned();
        // It calls the diagnosis with the file.
        if file.is_dir() || name == "verdict.rs" {
            continue;
        }
        read += 1;
        let text = std::fs::read_to_string(&file).expect("a text");
        let code = text.lines().filter(|l| !l.trim_start().starts_with("//"));
        for line in code.filter(|l| l.contains("nonius_")) {
            let transform = name == "spectrum.rs" && line.contains("nonius_fourier");
            assert!(transform, "{name}: {line}");
        }
    }
    assert!(read > 20, "{read} files");
}
