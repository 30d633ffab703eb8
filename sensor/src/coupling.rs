//! AC coupling: a first-order high pass of each channel.

use std::f64::consts::TAU;

use crate::cause::Cause;
use crate::sensor::Sensor;

/// One of them.
struct Stage {
    /// What is left of the charge after a sample, and the shares of the input before it and at its end that come to it: exact for an
    /// input that goes from one to the other along a line.
    keeps: f64,
    takes: [f64; 2],
    /// Of either channel the charge, which is the slow part of the input, and the input of the sample before.
    charge: [f64; 2],
    before: Option<[f64; 2]>,
}

impl Stage {
    fn new(corner_hz: f64, sample_rate_hz: f64) -> Self {
        let x = (TAU * corner_hz / sample_rate_hz).max(0.0);
        let keeps = (-x).exp();
        let mean = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
        Self {
            keeps,
            takes: [mean - keeps, 1.0 - mean],
            charge: [0.0; 2],
            before: None,
        }
    }

    fn passed(&mut self, pair: [f64; 2]) -> [f64; 2] {
        if let Some(before) = self.before {
            for ((charge, now), before) in self.charge.iter_mut().zip(pair).zip(before) {
                *charge = self.keeps * *charge + self.takes[0] * before + self.takes[1] * now;
            }
        }
        self.before = Some(pair);
        [0, 1].map(|which: usize| pair[which] - self.charge[which])
    }
}

/// High passes in a row; their capacitors are discharged when the recording begins.
pub(crate) struct Coupling(Vec<Stage>);

impl Coupling {
    pub(crate) fn of(sensor: &Sensor) -> Self {
        let rate = sensor.adc.sample_rate_hz;
        let stage = |cause: &Cause| match *cause {
            Cause::AcCoupling { corner_hz } => Some(Stage::new(corner_hz, rate)),
            _ => None,
        };
        Self(sensor.causes.iter().filter_map(stage).collect())
    }

    /// A sample of both channels behind the high passes.
    pub(crate) fn passed(&mut self, pair: [f64; 2]) -> [f64; 2] {
        let stages = self.0.iter_mut();
        stages.fold(pair, |pair, stage| stage.passed(pair))
    }
}
