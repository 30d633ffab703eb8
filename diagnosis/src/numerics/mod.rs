//! Least squares, tail probabilities, spectra and curves, as any program has them.

pub(crate) mod continuous;
pub(crate) mod correlate;
pub(crate) mod ends;
pub(crate) mod lines;
pub(crate) mod pair;
pub(crate) mod polygon;
pub(crate) mod polynomial;
pub(crate) mod repeated;
pub(crate) mod slopes;
pub(crate) mod solve;
pub(crate) mod spread;
pub(crate) mod statistics;
