//! Discrete Fourier transforms of complex values, in place and not scaled: `rustfft` behind two functions.
//!
//! Its code is built anew in every crate that plans a transform itself.

// A program of unit tests would be all of it once more, for none.
#[cfg(not(test))]
mod transform;

#[cfg(not(test))]
pub use transform::{Complex, forward, inverse};
