//! A simulated sensor as `sensor.toml` describes it: equation (4), its ADC, its noise, and the causes that
//! `nonius diagnose` found in a recording.
//!
//! It is written apart from the diagnosis: that one knows shapes, this one signals. A test brings them together.

mod cause;
mod motion;
mod sensor;
mod signals;

pub use cause::Cause;
pub use motion::Motion;
pub use sensor::{Adc, Sensor, SensorError, Signals};
pub use signals::Samples;
