//! AC coupling: a first-order high pass of each channel.

use std::f64::consts::TAU;

use crate::cause::Cause;
use crate::sensor::Sensor;

/// High passes in a row; their capacitors are discharged when the recording begins.
pub(crate) struct Coupling {
    /// Share by which each follows its input in a sample, and the slow part of each channel.
    stages: Vec<(f64, [f64; 2])>,
}

impl Coupling {
    pub(crate) fn of(sensor: &Sensor) -> Self {
        let rate = sensor.adc.sample_rate_hz;
        let stage = |cause: &Cause| match *cause {
            Cause::AcCoupling { corner_hz } => {
                Some(((TAU * corner_hz / rate).clamp(0.0, 0.5), [0.0; 2]))
            }
            _ => None,
        };
        Self {
            stages: sensor.causes.iter().filter_map(stage).collect(),
        }
    }

    /// A sample of both channels behind the high passes.
    pub(crate) fn passed(&mut self, mut pair: [f64; 2]) -> [f64; 2] {
        for (share, slow) in &mut self.stages {
            for (y, slow) in pair.iter_mut().zip(slow) {
                *slow += *share * (*y - *slow);
                *y -= *slow;
            }
        }
        pair
    }
}
