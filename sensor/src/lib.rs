//! A simulated sensor as `sensor.toml` describes it: equation (4), its ADC, its noise, and the causes that
//! `nonius diagnose` found in a recording.
//!
//! It is written apart from the diagnosis: that one knows shapes, this one signals. A test brings them together.

mod along;
mod cause;
mod channel;
mod converter;
mod coupling;
mod drift;
mod flicker;
mod interference;
mod keys;
mod lag;
mod motion;
mod rows;
mod sensor;
mod side;
mod signals;

pub use along::MotionError;
pub use cause::{Cause, Channel};
pub use drift::Drift;
pub use interference::Interference;
pub use motion::Motion;
pub use sensor::{Adc, Grid, Moved, Sensor, SensorError, Signals};
pub use signals::Samples;
