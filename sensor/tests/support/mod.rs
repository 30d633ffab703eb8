//! A plain sensor and its recordings.

use nonius_recording::{Overrides, Recording};
use nonius_sensor::{Motion, Sensor};

pub(crate) const PLAIN: &str = "
[signals]
a_c = 0.8
b_c = 0.03
a_s = 0.75
b_s = -0.02
beta = 0.04
noise_rms = 0.001
[adc]
bits = 14
lsb = 0.0001220703125
centre = 0.0
sample_rate_hz = 10000.0
[motion]
periods_travelled = 900.0
speed_max_periods_per_s = 700.0
periods_per_revolution = 16
";

/// What it records when it is moved to and fro.
pub(crate) fn recorded(sensor: &Sensor, seed: u64) -> Recording {
    let samples = sensor.simulate(&Motion::to_and_fro(sensor), seed);
    let overrides = Overrides {
        adc_bits: Some(sensor.adc.bits),
        full_scale: Some(sensor.adc.lsb * 2f64.powi(sensor.adc.bits as i32 - 1)),
        periods_per_revolution: sensor.motion.periods_per_revolution,
        ..Overrides::default()
    };
    Recording::from_samples(samples.time_s, samples.cos, samples.sin, &overrides)
        .expect("a recording")
}
