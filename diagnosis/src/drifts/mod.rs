//! What changes with time, and how: as a polynomial, as an exponential, in steps, between two levels.

pub(crate) mod channels;
pub(crate) mod courses;
pub(crate) mod stairs;
mod steps;
pub(crate) mod telegraph;
pub(crate) mod warming;
