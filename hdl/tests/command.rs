//! `nonius verify` from the command line: its exit code says what the simulators found.

use std::ffi::OsString;
use std::fs;
use std::path::Path;

fn nonius(arguments: &[&dyn AsRef<Path>]) -> u8 {
    let named = arguments.iter().map(|a| a.as_ref().as_os_str().to_owned());
    nonius::run(std::iter::once(OsString::from("nonius")).chain(named))
}

#[test]
fn one_wrong_digit_is_exit_code_1() {
    let dir = tempfile::tempdir().expect("scratch folder");
    let design = Path::new(env!("CARGO_MANIFEST_DIR")).join("../designs/optical.toml");
    let chip = dir.path().join("chip");
    let built = nonius(&[&"build", &design, &"-o", &chip, &"--rows", &"60"]);
    assert_eq!(built, 0);
    let verify =
        |simulator: &str| nonius(&[&"verify", &chip, &"--simulator", &simulator, &"--json"]);
    assert_eq!(verify("icarus"), 0);
    let vectors = chip.join("vectors/forwards.vec");
    let text = fs::read_to_string(&vectors).expect("vectors");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let last = lines[40].pop().expect("a digit");
    lines[40].push(if last == '0' { '1' } else { '0' });
    fs::write(&vectors, lines.join("\n") + "\n").expect("a file");
    assert_eq!(verify("icarus"), 1);
    assert_eq!(verify("both"), 1);
}
