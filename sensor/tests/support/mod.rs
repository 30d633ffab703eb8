//! A plain sensor and its recordings.

use nonius_recording::{Overrides, Recording};
use nonius_sensor::{Samples, Sensor};

pub(crate) const PLAIN: &str = include_str!("plain.toml");

/// Samples of a sensor as a recording of a known ADC.
pub(crate) fn recording(sensor: &Sensor, samples: Samples) -> Recording {
    let overrides = Overrides {
        adc_bits: Some(sensor.adc.bits),
        full_scale: Some(sensor.adc.lsb * 2f64.powi(sensor.adc.bits as i32 - 1)),
        periods_per_revolution: sensor.motion.periods_per_revolution,
        ..Overrides::default()
    };
    Recording::from_samples(samples.time_s, samples.cos, samples.sin, &overrides)
        .expect("a recording")
}
