//! The paper in plain `f64`, written from the paper: the independent check of the equations.
//!
//! Nothing here knows the kernels, their formats or their graph, and the kernels know nothing of this. Angles are in
//! radians, as in the paper; Θ belongs to signals in the unit they are given in. Errata: equation (10) is a difference,
//! ∇e_k = w_k − ∇α̂_k, and calibration runs in lock, on travelled angle.

mod arctangent;
mod correction;
mod filter;
mod interpolator;
mod lock;
mod poles;
mod search;
mod sensor;

pub use arctangent::Arctangent;
pub use correction::ParameterSet;
pub use filter::{Filter, FilterError, Method};
pub use interpolator::{Calibration, Configuration, Estimate, Gamma, Interpolator};
pub use poles::Poles;
pub use search::{Objective, Search};
pub use sensor::Sensor;
