//! The tests of the calibration in one program: one for each file would each be built and linked with all that they share.

mod beyond;
mod codes;
mod cubic;
mod methods;
mod places;
mod properties;
mod recordings;
mod report;
mod set_bound;
mod standstill;
mod statistics;
mod statistics_files;
mod support;

/// A file that is not named above would never run.
#[test]
fn every_file_is_here() {
    nonius_kept::every_module(env!("CARGO_MANIFEST_DIR"), include_str!("all.rs"), &[]);
}
