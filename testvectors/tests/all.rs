//! The tests of the vectors in one program: one for each file would each be built and linked with all that they share.

mod last_bits;
mod purpose;
mod read_back;
#[path = "../../designs/shipped.rs"]
mod shipped;
mod ties;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
