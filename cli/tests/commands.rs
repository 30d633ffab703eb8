//! What holds of more than one command: one goes on where the other ends, nothing is written over, no input makes one panic.

use std::fs;

use crate::support::{design, nonius, recording, refused};
use proptest::prelude::*;

#[test]
fn new_writes_a_design_that_builds_and_never_overwrites() {
    let dir = tempfile::tempdir().expect("scratch");
    let read = || fs::read_to_string(dir.path().join("mine.toml")).expect("mine.toml");
    assert!(nonius(dir.path(), &["new", "mine"]).status.success());
    let written = read();
    refused(
        &nonius(dir.path(), &["new", "mine"]),
        &["mine.toml", "exists"],
    );
    assert_eq!(read(), written);
    let built = nonius(dir.path(), &["build", "mine.toml", "-o", "out/mine"]);
    assert!(
        built.status.success(),
        "{}",
        String::from_utf8_lossy(&built.stderr)
    );
    assert!(dir.path().join("out/mine/rtl/mine.v").is_file());
    let said = String::from_utf8_lossy(&built.stdout);
    assert!(said.contains("next: ") && !said.contains("note"), "{said}");
    refused(&nonius(dir.path(), &["new", "2nd"]), &["name", "2nd"]);
    assert!(!dir.path().join("2nd.toml").exists());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn damaged_recordings_never_panic(cut in 0usize..4000, byte in any::<u8>(), at in 0usize..4000) {
        let dir = tempfile::tempdir().expect("scratch");
        let mut bytes = recording(120, 40.0).into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(cut.max(10));
        fs::write(dir.path().join("r.csv"), bytes).expect("recording");
        for arguments in [
            vec!["new", "n", "--from", "r.csv"],
            vec!["simulate", &design(), "r.csv", "-o", "o.csv"],
            vec!["calibrate", "r.csv"],
            vec!["diagnose", "r.csv", "-o", "found"],
        ] {
            let output = nonius(dir.path(), &arguments);
            let said = String::from_utf8_lossy(&output.stderr);
            prop_assert!(matches!(output.status.code(), Some(0 | 2)), "{}", said);
            prop_assert!(!said.contains("panicked"), "{}", said);
        }
    }
}

#[test]
fn verify_refuses_what_it_cannot_run() {
    let dir = tempfile::tempdir().expect("scratch folder");
    refused(
        &nonius(dir.path(), &["verify", "chip", "--simulator", "modelsim"]),
        &["modelsim", "icarus", "verilator"],
    );
    refused(&nonius(dir.path(), &["verify", "nowhere"]), &["nowhere"]);
}

/// Writing destroys nothing: no device, no input, no file of the user's in an output folder.
#[test]
fn nothing_of_the_users_is_written_over() {
    let dir = tempfile::tempdir().expect("scratch folder");
    let at = |name: &str| dir.path().join(name);
    fs::write(at("r.csv"), recording(4000, 50.0)).expect("a recording");
    let before = fs::read(at("r.csv")).expect("a recording");
    let design = design();
    let simulate = |more: &[&str]| {
        nonius(
            dir.path(),
            &[&["simulate", &design, "r.csv"], more].concat(),
        )
    };
    refused(&simulate(&["-o", "r.csv"]), &["r.csv", "another file"]);
    refused(&simulate(&["-o", "o.csv", "--vcd", "./o.csv"]), &["o.csv"]);
    assert_eq!(fs::read(at("r.csv")).expect("a recording"), before);
    #[cfg(unix)]
    {
        let socket = std::os::unix::net::UnixListener::bind(at("socket")).expect("a socket");
        refused(&simulate(&["-o", "socket"]), &["no ordinary file"]);
        drop(socket);
    }
    assert!(
        nonius(dir.path(), &["build", &design, "-o", "chip"])
            .status
            .success()
    );
    fs::write(at("chip/notes.txt"), "mine").expect("the user's own");
    assert!(
        nonius(dir.path(), &["build", &design, "-o", "chip"])
            .status
            .success()
    );
    assert_eq!(
        fs::read_to_string(at("chip/notes.txt")).expect("kept"),
        "mine"
    );
    fs::create_dir(at("other")).expect("a folder");
    fs::write(at("other/design.json"), "{}").expect("somebody's");
    // Before anything is read, for a diagnosis takes its time.
    refused(
        &nonius(dir.path(), &["diagnose", "missing.csv", "-o", "other"]),
        &["other"],
    );
    refused(
        &nonius(dir.path(), &["build", &design, "-o", "other"]),
        &["other"],
    );
}
