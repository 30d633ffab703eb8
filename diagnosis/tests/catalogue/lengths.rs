//! Recordings of any length: short ones, and those whose last block of samples is nearly empty.

use nonius_kept::every;

use crate::harness::{PLAIN, diagnosed_of};

#[test]
fn every_length_is_diagnosed_or_refused() {
    // Blocks of 1024 samples, twenty parts of a recording, and a few samples more; every sixth but in the long form.
    let edges = (20_478..20_488).chain([20_500, 20_580, 40_980, 41_000]);
    for samples in every(6, (16..200).chain(edges)) {
        if let Ok(found) = diagnosed_of(&PLAIN, samples) {
            assert_eq!(found.positions.len(), samples);
        }
    }
}
