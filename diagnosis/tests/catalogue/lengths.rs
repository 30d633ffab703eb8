//! Recordings of any length: short ones, and those whose last block of samples is nearly empty.

use crate::harness::{PLAIN, diagnosed_of};

#[test]
fn every_length_is_diagnosed_or_refused() {
    // Blocks of 1024 samples, twenty parts of a recording, and a few samples more.
    let edges = (20_478..20_488).chain([20_500, 20_580, 40_980, 41_000]);
    for samples in (16..200).chain(edges) {
        if let Ok(found) = diagnosed_of(&PLAIN, samples) {
            assert_eq!(found.positions.len(), samples);
        }
    }
}
