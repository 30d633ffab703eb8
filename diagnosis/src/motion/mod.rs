//! Motion is a nuisance: it is a spline in time, as close as the likelihood asks for, and what a drive does at its corners.

pub(crate) mod calm;
pub(crate) mod in_step;
pub(crate) mod knots;
mod moves;
pub(crate) mod spline;
