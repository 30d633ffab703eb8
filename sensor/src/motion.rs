//! The angle of the scale over time.

use std::f64::consts::TAU;

use crate::sensor::Sensor;

/// Samples that a simulated motion has at least and at most.
const SAMPLES: (f64, f64) = (2_000.0, 2_000_000.0);

/// True angle at each sample, one every 1/`adc.sample_rate_hz` seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Seconds.
    pub time_s: Vec<f64>,
    /// α, radians, continuous.
    pub alpha: Vec<f64>,
}

impl Motion {
    /// To and fro once, a sine from rest to rest: as far and as fast as the sensor was moved, where the number of samples
    /// allows.
    #[must_use]
    pub fn to_and_fro(sensor: &Sensor) -> Self {
        let (way, top) = (
            sensor.motion.periods_travelled,
            sensor.motion.speed_max_periods_per_s,
        );
        let rate = sensor.adc.sample_rate_hz;
        // The way is four swings; the speed of a sine of swing A is A ω.
        let wanted = TAU * (way / 4.0) / top * rate;
        let samples = wanted.clamp(SAMPLES.0, SAMPLES.1).ceil();
        let swing = way / 4.0 * (samples / wanted).min(1.0);
        let (time_s, alpha) = (0..samples as usize)
            .map(|k| {
                let k = k as f64;
                (k / rate, TAU * swing * (1.0 - (TAU * k / samples).cos()))
            })
            .unzip();
        Self { time_s, alpha }
    }
}
