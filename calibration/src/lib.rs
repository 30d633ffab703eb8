//! Off-line calibration: from two columns of samples to the parameters of equation (4), with standard errors.
//!
//! [`calibrate`] runs one [`Method`] of the paper's section 5; [`Method::Unbiased`] is the default. Signals are in any
//! unit, both in the same one. [`cramer_rao`] is what no estimator can beat, [`report()`] the result to be read.

mod calibrate;
mod check;
mod clipped;
pub mod conic;
pub mod cramer_rao;
pub mod curve;
mod estimate;
pub mod extremes;
pub mod gradient;
mod method;
mod noise;
mod nothing;
mod places;
mod report;
mod residual;
mod result;
mod samples;
mod sandwich;
mod seen;
pub mod set;
pub mod set_bound;
mod shape;
mod together;
mod told;
pub mod unbiased;
mod words;

pub use calibrate::{calibrate, undetermined};
pub use curve::Curve;
pub use method::{Error, Method, Options};
pub use nonius_recording::Ellipse;
pub use nothing::no_ellipse;
pub use report::report;
pub use result::{Calibration, Correlations, Parameter, RatioSource};
pub use shape::Shape;
pub use together::Together;
