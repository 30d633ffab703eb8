//! Diagnosis: what the simulation of a sensor gets wrong, why, the model extended by it, and the gain measured.
//!
//! Each sample has two numbers and one unknown angle. What changes the radius is always seen; what changes the angle is
//! seen above the motion, or whole against a reference. [`diagnose`] fits the five parameters, takes the motion off as a
//! spline, and asks of every cause of the catalogue how much of the rest it explains. A name is given only to a shape
//! that holds; what cannot be named is said to be unexplained.

mod ahead;
mod beside;
mod block;
mod calm;
mod cause;
mod causes;
mod channels;
mod checks;
mod choice;
mod codes;
mod contender;
mod context;
mod correlate;
mod curves;
mod delays;
mod diagnose;
mod doubt;
mod edges;
mod exact;
mod finding;
mod first;
mod flicker;
mod generic;
mod glitches;
mod held;
mod jumps;
mod knots;
mod late;
mod left;
mod library;
mod lines;
mod matched;
mod missing;
mod model;
mod motion;
mod names;
mod noise;
mod one_over_f;
mod pair;
mod part;
mod polygon;
mod polynomial;
mod rail;
mod reference;
mod repair;
mod report;
mod rivals;
mod score;
mod select;
mod selection;
mod sensor;
mod sides;
mod silent;
mod simpler;
mod simulation;
mod slips;
mod solve;
mod spline;
mod stairs;
mod statistics;
mod steps;
mod sweep;
mod taken;
mod telegraph;
mod timebase;
mod trig;
mod unexplained;
mod units;
mod unseen;
mod variance;
mod whereabouts;
mod whiten;

pub use context::{Context, ContextError};
pub use diagnose::{Diagnosis, Extended, diagnose};
pub use finding::{Chip, Effect, Finding, Gain, OTHER_ORDER, Parameter, Place};
pub use motion::motion_csv;
pub use report::{plots, report};
pub use sensor::{MOTION, sensor_toml};
pub use simulation::{SimulatedCause, Simulation};
pub use unexplained::Unexplained;
pub use unseen::unseen;
