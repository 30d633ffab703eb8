//! The tests of recordings in one program: one for each file would each be built and linked with all that they share.

mod adc;
mod fuzz;
mod instruments;
mod reader;
mod refusals;
mod shared_recordings;
mod survey;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
