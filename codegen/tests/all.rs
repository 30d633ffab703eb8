//! The tests of the generator in one program: one for each file would each be built and linked with all that they share.

mod any_design;
mod kernel_change;
mod names;
mod schedule;
#[path = "../../designs/shipped.rs"]
mod shipped;
mod snapshots;
mod tables;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
