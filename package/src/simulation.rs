//! The bit-true chip with the sensor that the design promises, from power-up.

use std::f64::consts::TAU;

use nonius_model::chip::Chip;
use nonius_model::design::Design;
use serde::Serialize;

use crate::sensor::{Sensor, Shares};

/// Angle errors of the bit-true chip in periods.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Accuracy {
    /// Rms.
    pub rms_periods: f64,
    /// Largest.
    pub largest_periods: f64,
    /// The loop was locked at the end.
    pub locked: bool,
}

/// What the chip makes of that sensor.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// In the end, over a slow sweep through one period.
    pub accuracy: Accuracy,
    /// From power-up: periods of travel and the angle error over the last of them, periods rms; a period in fifty, later on.
    pub course: Vec<[f64; 2]>,
    /// The same of the arctangent of the raw signals, periods rms.
    pub raw_rms_periods: f64,
    /// In the end: place within the period and the angle error there, the mean over a 200th of the period.
    pub along: Vec<[f64; 2]>,
}

/// Samples that the calibration is given, and most where the machine is slow.
const CONVERGE: usize = 400_000;
const PATIENT: usize = 4_000_000;
/// Samples of a ramp down and of the sweep over a period.
const RAMP: usize = 5_000;
const SWEEP: usize = 100_000;
/// Of so many parts of the period the mean error is told.
const PARTS: usize = 200;

/// A sensor with half of the promised errors and the promised noise.
#[must_use]
pub fn simulate(design: &Design) -> Simulation {
    of(design, half(design, [0.5, -0.5]))
}

/// The same with the weakest signals that are promised: noise and steps of the ADC are larger beside them.
#[must_use]
pub fn simulate_weakest(design: &Design) -> Accuracy {
    of(design, half(design, [-1.0; 2])).accuracy
}

/// A fast stretch to converge on line, a ramp, and a slow sweep over one period.
fn of(design: &Design, mut sensor: Sensor) -> Simulation {
    let spec = &design.spec;
    let top = spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz;
    let fast = (top / 2.0).min(0.00713);
    // At the last gamma the slowest mode settles by an e-th in about 2/(64 gamma) periods.
    let last = 2f64.powi(spec.calibration.gamma_last() as i32);
    let periods = 60.0 + 10.0 * last / 64.0 * 2.0;
    // A slow machine moves up to its top speed, and takes its time; where that would take for ever, it is simulated faster
    // than it is.
    let fast = fast.max((periods / CONVERGE as f64).min(top));
    let fast = fast.max(periods / PATIENT as f64);
    let converge = ((periods / fast) as usize).clamp(5_000, PATIENT);
    // An axis slows down, the loop comes to rest behind the ramp, and a whole period is measured.
    let turns = spec.tracking.bandwidth_hz * TAU / spec.adc.sample_rate_hz;
    let settle = RAMP + ((20.0 / turns) as usize).min(100_000);
    let slow = 1.0 / SWEEP as f64;

    let mut chip = Chip::bit_true(design);
    let (mut course, mut period, mut raw) = (vec![], Squares::default(), Squares::default());
    let (mut whole, mut parts) = (Squares::default(), vec![Squares::default(); PARTS]);
    let start = 0.1;
    let mut at = start;
    for k in 0..converge + settle + SWEEP {
        let slowed = (k.saturating_sub(converge) as f64 / RAMP as f64).min(1.0);
        let speed = fast + (slow - fast) * slowed;
        at += speed;
        let sample = sensor.sample(at, speed);
        let error = wrapped(chip.position() - at);
        if k < converge {
            period.add(error);
            raw.add(wrapped(sample.arctangent - at));
            let travelled = at - start;
            if travelled.floor() > (travelled - speed).max(0.0).floor() {
                if due(&course, travelled) {
                    course.push([travelled, period.rms()]);
                }
                period = Squares::default();
            }
        } else if k >= converge + settle {
            whole.add(error);
            let part = (at.rem_euclid(1.0) * PARTS as f64) as usize;
            parts[part.min(PARTS - 1)].add(error);
        }
        chip.step_codes(sample.cos, sample.sin, false, true);
    }
    // A loop of type 1 lags by a constant at constant speed, which is no error of the angle.
    let lag = match spec.tracking.filter_type {
        1 => whole.mean(),
        _ => 0.0,
    };
    let place = |i: usize| (i as f64 + 0.5) / PARTS as f64;
    let seen = parts
        .iter()
        .enumerate()
        .filter(|(_, part)| part.count > 0.0);
    Simulation {
        accuracy: Accuracy {
            rms_periods: whole.rms_about(lag),
            largest_periods: whole.largest_about(lag),
            locked: chip.state.locked,
        },
        course,
        raw_rms_periods: raw.rms(),
        along: seen
            .map(|(i, part)| [place(i), part.mean() - lag])
            .collect(),
    }
}

/// Every period at first, later one in fifty.
fn due(course: &[[f64; 2]], travelled: f64) -> bool {
    course.last().is_none_or(|last| travelled > 1.02 * last[0])
}

/// Between −½ and ½.
fn wrapped(turns: f64) -> f64 {
    turns - turns.round()
}

#[derive(Clone, Default)]
struct Squares {
    count: f64,
    sum: f64,
    squares: f64,
    lowest: f64,
    highest: f64,
}

impl Squares {
    fn add(&mut self, error: f64) {
        if self.count == 0.0 {
            (self.lowest, self.highest) = (error, error);
        }
        self.count += 1.0;
        self.sum += error;
        self.squares += error * error;
        self.lowest = self.lowest.min(error);
        self.highest = self.highest.max(error);
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn rms(&self) -> f64 {
        self.rms_about(0.0)
    }

    /// Of what is left when `constant`, 0 or the mean, is taken off.
    fn rms_about(&self, constant: f64) -> f64 {
        (self.squares / self.count - constant * constant)
            .max(0.0)
            .sqrt()
    }

    /// The largest of it.
    fn largest_about(&self, constant: f64) -> f64 {
        (self.highest - constant).max(constant - self.lowest)
    }
}

/// Half of what the design promises of offsets and phase, the noise, and so much of what it promises of the gains; an amplitude that is
/// no round number of codes. Where that does not fit the ADC it clips, as on the axis.
fn half(design: &Design, gains: [f64; 2]) -> Sensor {
    let spec = &design.spec;
    let s = &spec.sensor;
    let shares = Shares {
        gains,
        offsets: [0.5, -0.5],
        phase: 0.5,
        bends: [0.0; 2],
    };
    Sensor::of(spec, &shares, 0.999 * s.amplitude, 1)
}
