//! Which stimulus caught a fault the last time: it is simulated first, the others only where it no longer does.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{LazyLock, Mutex};

fn file() -> PathBuf {
    [
        env!("CARGO_MANIFEST_DIR"),
        "tests/planted_faults/seen_by.csv",
    ]
    .iter()
    .collect()
}

/// Stimulus by fault.
static SEEN: LazyLock<Mutex<BTreeMap<String, String>>> = LazyLock::new(|| {
    let text = std::fs::read_to_string(file()).unwrap_or_default();
    let rows = text.lines().filter_map(|line| line.rsplit_once(','));
    let seen = rows.map(|(fault, stimulus)| (fault.to_owned(), stimulus.to_owned()));
    Mutex::new(seen.collect())
});

/// What caught this fault the last time.
pub(crate) fn last(fault: &str) -> Option<String> {
    let seen = SEEN.lock().expect("no test has failed");
    seen.get(fault).cloned()
}

/// Keeps what catches it now, where kept files are written anew.
pub(crate) fn keep(fault: &str, stimulus: &str) {
    if !nonius_kept::blessed() {
        return;
    }
    let mut seen = SEEN.lock().expect("no test has failed");
    seen.insert(fault.to_owned(), stimulus.to_owned());
    let rows: String = seen.iter().map(|(f, s)| format!("{f},{s}\n")).collect();
    std::fs::write(file(), rows).expect("a file beside the test");
}
