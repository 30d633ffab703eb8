//! Stimuli and the vector files of the testbench.

pub mod stimulus;
pub mod vectors;
