//! What each method makes of the measured recordings: writes the tables in docs/offline-calibration.md.
//!
//!     cargo run -p nonius-calibration --example recordings

#[path = "../tests/support/recordings.rs"]
mod recordings;

fn main() -> std::io::Result<()> {
    let Some(folder) = nonius_kept::recordings("docs/offline-calibration.md") else {
        return Ok(());
    };
    let tables = recordings::tables(&folder);
    let page = recordings::with_tables(&std::fs::read_to_string(recordings::PAGE)?, &tables);
    let scratch = format!("{}.part", recordings::PAGE);
    std::fs::write(&scratch, &page)?;
    std::fs::rename(scratch, recordings::PAGE)?;
    print!("{tables}");
    Ok(())
}
