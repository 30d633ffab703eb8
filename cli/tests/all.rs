//! The tests of the program in one program: one for each file would each be built and linked with all that they share.

mod browser;
mod build;
mod calibrate;
mod calibrate_json;
mod commands;
mod diagnose;
mod diagnosed_recordings;
mod followed_recordings;
mod new;
mod paper_and_chip_over_recordings;
mod readme;
mod replayed;
mod report_in_chromium;
mod simulate;
mod support;
mod tour;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
