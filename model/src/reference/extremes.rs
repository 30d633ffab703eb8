//! Offsets and gains from the extremes of the signals: the baseline that the paper's introduction argues against.
//!
//! Noise and distortion go into the extremes undiminished, and the phase β cannot be seen at all.

use super::{ReferenceError, Sensor};

/// Largest and smallest value of both channels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    low: [f64; 2],
    high: [f64; 2],
}

impl Default for Extremes {
    fn default() -> Self {
        Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        }
    }
}

impl Extremes {
    /// Takes one sample in.
    pub fn see(&mut self, y: [f64; 2]) {
        for (i, y) in y.into_iter().enumerate() {
            self.low[i] = self.low[i].min(y);
            self.high[i] = self.high[i].max(y);
        }
    }

    /// Offset = middle, amplitude = half the span, β = 0.
    ///
    /// # Errors
    /// A channel that did not change.
    pub fn sensor(&self) -> Result<Sensor, ReferenceError> {
        let [c, s] = [0, 1].map(|i| {
            (
                (self.high[i] - self.low[i]) / 2.0,
                (self.high[i] + self.low[i]) / 2.0,
            )
        });
        let sensor = Sensor {
            a_c: c.0,
            b_c: c.1,
            a_s: s.0,
            b_s: s.1,
            beta: 0.0,
        };
        sensor
            .check()
            .map_err(|_| ReferenceError::Data("a channel did not change"))?;
        Ok(sensor)
    }
}

/// Off line, over a record that should hold at least one whole period.
///
/// # Errors
/// A channel that did not change.
pub fn calibrate(samples: &[[f64; 2]]) -> Result<Sensor, ReferenceError> {
    let mut extremes = Extremes::default();
    samples.iter().for_each(|&y| extremes.see(y));
    extremes.sensor()
}

/// On line: the extremes of each whole period of travel correct the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodExtremes {
    running: Extremes,
    /// α̂ where the running period began, radians, unwrapped.
    began: Option<f64>,
    theta: [f64; 5],
}

impl PeriodExtremes {
    /// Before the first period the signals have this amplitude and no offset.
    #[must_use]
    pub fn new(amplitude: f64) -> Self {
        Self {
            running: Extremes::default(),
            began: None,
            theta: Sensor {
                a_c: amplitude,
                a_s: amplitude,
                ..Sensor::IDEAL
            }
            .theta(),
        }
    }

    /// The parameters, in the form of section 5.3; θ5 is 0.
    #[must_use]
    pub fn theta(&self) -> [f64; 5] {
        self.theta
    }

    /// Takes a sample and the unwrapped angle estimate, radians, that belongs to it.
    pub fn step(&mut self, y: [f64; 2], alpha_hat: f64) {
        let began = *self.began.get_or_insert(alpha_hat);
        self.running.see(y);
        if (alpha_hat - began).abs() >= std::f64::consts::TAU {
            if let Ok(sensor) = self.running.sensor() {
                self.theta = sensor.theta();
            }
            self.running = Extremes::default();
            self.began = Some(alpha_hat);
        }
    }
}
