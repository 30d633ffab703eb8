//! Slow motion of a sensor that is not calibrated yet: whether lock lasts long enough to learn it.

use nonius_model::chip::Chip;
use nonius_model::design::Design;
use nonius_model::spec::CalibrationStart;
use rayon::prelude::*;
use serde::Serialize;

use crate::pull_in::{Start, Worst, sensors, shares};
use crate::sensor::Sensor;

/// Part of the loop's bandwidth that is slow: the loop follows every bend of the signals.
const SLOW: f64 = 0.1;
/// Most samples of a period: a slower machine is simulated faster than it is.
const LONGEST: f64 = 4000.0;
/// Periods in a row in lock that show that it is learned, and how many it is given.
const QUIET: u64 = 3;
const PATIENCE: u64 = 24;

/// How the sensors at the ends of the promise are learned at slow speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlowLock {
    /// Periods per second.
    pub speed_periods_per_s: f64,
    /// Sensors: all combinations of the ends.
    pub sensors: u32,
    /// Sensors that do not stay in lock for three periods in a row within 24: their ellipse is not learned.
    pub not_learned: u32,
    /// One of them.
    pub worst: Option<Worst>,
    /// All of them are learned with `calibration.start = "least_squares"`.
    pub least_squares_helps: bool,
}

impl SlowLock {
    /// `None` where bends are not calibrated: with fewer parameters no such sensor is known, and none is looked for.
    #[must_use]
    pub fn of(design: &Design) -> Option<Self> {
        let spec = &design.spec;
        if !spec.calibration.has_bend() {
            return None;
        }
        let not_learned = not_learned(design);
        let helps = || {
            let mut spec = spec.clone();
            spec.calibration.start = CalibrationStart::LeastSquares;
            Design::new(&spec).is_ok_and(|design| {
                let each = starts(&design);
                each.all(|start| is_learned(&design, &start))
            })
        };
        let lost = !not_learned.is_empty();
        Some(Self {
            speed_periods_per_s: speed(design) * spec.adc.sample_rate_hz,
            sensors: sensors(spec),
            not_learned: not_learned.len() as u32,
            worst: not_learned.first().map(|start| Worst::of(spec, start, 1)),
            least_squares_helps: lost && !spec.calibration.starts() && helps(),
        })
    }

    /// Which sensors are not learned, and what helps; nothing where every one is.
    #[must_use]
    pub fn missed(&self) -> Option<String> {
        let worst = self.worst.as_ref()?;
        let way = if self.least_squares_helps {
            "every one is learned with calibration.start = \"least_squares\""
        } else {
            "promise less of amplitudes, offsets, phase or bends"
        };
        Some(format!(
            "{} of the {} sensors at the ends of the promise do not stay in lock for {QUIET} periods within {PATIENCE} of slow motion, and are not \
             learned: {worst}; {way}",
            self.not_learned, self.sensors
        ))
    }
}

/// Periods per sample.
fn speed(design: &Design) -> f64 {
    let spec = &design.spec;
    let slow = SLOW * spec.tracking.bandwidth_hz;
    let slow = slow.min(spec.sensor.speed_max_periods_per_s);
    (slow / spec.adc.sample_rate_hz).max(1.0 / LONGEST)
}

/// Of each sensor.
fn starts(design: &Design) -> impl ParallelIterator<Item = Start> {
    let speed = speed(design);
    let each = (0..sensors(&design.spec)).into_par_iter();
    each.map(move |signs| Start {
        signs,
        speed,
        place: 0.0,
    })
}

fn not_learned(design: &Design) -> Vec<Start> {
    let each = starts(design);
    each.filter(|start| !is_learned(design, start)).collect()
}

fn is_learned(design: &Design, start: &Start) -> bool {
    let spec = &design.spec;
    let shares = shares(spec, start.signs);
    let mut sensor = Sensor::of(spec, &shares, spec.sensor.amplitude, 1);
    let mut chip = Chip::bit_true(design);
    let period = (1.0 / start.speed).ceil() as u64;
    let mut quiet = 0;
    for k in 0..PATIENCE * period {
        let at = start.place + start.speed * k as f64;
        let sample = sensor.sample(at, start.speed);
        chip.step_codes(sample.cos, sample.sin, false, true);
        quiet = if chip.state.locked { quiet + 1 } else { 0 };
        if quiet > QUIET * period {
            return true;
        }
    }
    false
}
