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
//!
//! Words of this crate, and the field's:
//!
//! - *atom*: one function of the samples in one row, a basis function. *shape*: a weighted sum of atoms, a regressor. *amount*:
//!   how much of a shape there is, its coefficient, mostly in amplitudes.
//! - *row*: one of the residuals that are fitted together: along the radius, along the circle, real motion.
//! - *inner*: a number that a shape depends on non-linearly, as a frequency in hertz. A shape *follows* where the one such number
//!   is its own amount: it is made anew at each estimate.
//! - *given*: nuisance parameters of a cause, as the charge of a capacitor when the recording began: its last amounts, no part of its name.
//! - *carried*: accepted in the look before; the next one begins with it, its shapes tangents (linearised) at its amounts.
//! - *taken off*: subtracted from the signals, sample by sample; of motion, projected out of data and atoms.
//! - *every*, *tried*: decimation: of so many blocks of samples one is in the normal equations, of so many one is looked at when
//!   functions are tried.
//! - *held*: the share of what a generic basis explains that a name explains, a lack-of-fit test; *held out*: not fitted, cross-validation.
//! - *doubted*: accepted, and no longer a name in the end; its shapes stay in the fit, not in the simulation.
//! - *coded*: rms error that quantisation leaves of the channels, in amplitudes, where it is seen in the noise. *stepped*: the
//!   reference's quantisation shows.

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
