//! Discrete Fourier transforms of complex values, in place and not scaled: `rustfft` behind two functions.
//!
//! Its code is made anew, for a minute, in every crate that plans a transform itself. And what a plan holds is worth keeping: for a
//! transform of some thousand values making it takes longer than using it.

// A program of unit tests would be all of it once more, for none.
#[cfg(not(test))]
mod transform;

#[cfg(not(test))]
pub use transform::{Complex, forward, inverse};
