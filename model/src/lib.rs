//! What the chip computes.
//!
//! One arithmetic with three readings ([`signal`]), the formulas written in it ([`kernel`]), the chip they make
//! ([`chip`]), and the way from a design in physical units to integers ([`spec`], [`design`]). [`mod@reference`] is the
//! paper in plain `f64`, independent of all of it.

pub mod bits;
mod bundle;
pub mod chip;
pub mod design;
pub mod format;
pub mod graph;
pub mod kernel;
pub mod physical;
mod real;
pub mod reference;
pub mod registers;
pub mod rom;
pub mod signal;
pub mod spec;
