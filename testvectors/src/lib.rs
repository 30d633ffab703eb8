//! Stimuli and the vector files of the testbench.

mod fades;
mod limits;
mod motions;
mod plant;
pub mod read_vectors;
pub mod stimulus;
pub mod ties;
pub mod vectors;
pub mod waves;
