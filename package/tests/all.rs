//! The tests of the package in one program: one for each file would each be built and linked with all that they share.

mod coefficients;
mod pull_in;
#[path = "../../designs/shipped.rs"]
mod shipped;
mod shipped_designs;
mod sine;
mod slow_lock;
mod words;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
