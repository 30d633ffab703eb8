//! Diagnosis: what the simulation of a sensor gets wrong, why, the model extended by it, and the gain measured.
//!
//! Each sample has two numbers and one unknown angle. What changes the radius is always seen; what changes the angle is
//! seen above the motion, or whole against a reference. [`diagnose`] fits the five parameters, takes the motion off as a
//! spline, and asks of every cause of the catalogue how much of the rest it explains. A name is given only to a shape
//! that holds; what cannot be named is said to be unexplained.
//!
//! The way of a recording through the folders is that of [`diagnose`]: `checks` mends its time base, `motion` is taken off,
//! `causes` are made of `shapes` and weighed in a `model`, `select` accepts them, `drifts` and `noise` say of what is slow or
//! random which of its kinds it is, `doubt` takes names back, and what is left is `unnamed`.

mod causes;
mod checks;
mod clipped;
mod conclude;
mod context;
mod diagnose;
mod doubt;
mod drifts;
mod finding;
mod model;
mod motion;
mod noise;
mod numerics;
mod report;
mod select;
mod shapes;
mod simulation;
mod unnamed;

pub use context::{Context, ContextError};
pub use diagnose::{Diagnosis, Extended, diagnose};
pub use finding::{Cause, Chip, Effect, Finding, Gain, OTHER_ORDER, Parameter, Place};
pub use report::{plots, report};
pub use select::selection::VAGUE;
pub use simulation::motion::motion_csv;
pub use simulation::sensor::{MOTION, sensor_toml};
pub use simulation::{SimulatedCause, Simulation};
pub use unnamed::unexplained::Unexplained;
pub use unnamed::unseen::unseen;
