//! What the sensor does: signals, motion, noise.

use std::f64::consts::TAU;

use nonius_model::reference::Sensor;
use rand::rngs::StdRng;
use rand::{Rng, SeedableRng};

/// Speed of the travelling parts, radians per sample: 126 samples per period.
pub(crate) const SPEED: f64 = 0.05;
/// Samples of a run: some 1600 periods of travel.
pub(crate) const SAMPLES: u32 = 200_000;

/// Offsets 10 %, gain ratio 1.2, β = 5°.
pub(crate) const SENSOR: Sensor = Sensor {
    a_c: 1.1,
    b_c: 0.11,
    a_s: 0.9167,
    b_s: -0.0917,
    beta: 0.087_266,
};

/// The same without a phase error, for sets that cannot express one.
pub(crate) const IN_PHASE: Sensor = Sensor {
    beta: 0.0,
    ..SENSOR
};

/// The cases of the comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scenario {
    /// 0.01 % noise.
    Quiet,
    /// 1 % noise.
    Noisy,
    /// The cosine's offset drifts by 10 % of the amplitude, to next to nothing; 0.1 % noise from here on.
    Drift,
    /// At rest for a quarter of the time.
    Standstill,
    /// At the end to and fro over a tenth of a period.
    SmallArc,
    /// Third harmonics of 3 % besides.
    ThirdHarmonic,
}

impl Scenario {
    pub(crate) const ALL: [Self; 6] = [
        Self::Quiet,
        Self::Noisy,
        Self::Drift,
        Self::Standstill,
        Self::SmallArc,
        Self::ThirdHarmonic,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Quiet => "quiet",
            Self::Noisy => "noisy",
            Self::Drift => "drift",
            Self::Standstill => "standstill",
            Self::SmallArc => "small arc",
            Self::ThirdHarmonic => "third harmonic",
        }
    }

    /// Rms noise of each channel, as a fraction of the amplitude.
    pub(crate) fn sigma(self) -> f64 {
        match self {
            Self::Quiet => 1e-4,
            Self::Noisy => 1e-2,
            _ => 1e-3,
        }
    }

    /// Noise-free signals of a sensor at the angle α and sample k.
    pub(crate) fn signals(self, sensor: &Sensor, alpha: f64, k: u32) -> [f64; 2] {
        let [c, s] = sensor.signals(alpha);
        match self {
            Self::Drift => [c - 0.1 * f64::from(k) / f64::from(SAMPLES), s],
            Self::ThirdHarmonic => [
                c + 0.03 * (3.0 * alpha).cos(),
                s + 0.03 * (3.0 * alpha).sin(),
            ],
            _ => [c, s],
        }
    }

    /// Speed at sample k, radians per sample.
    fn speed(self, k: u32) -> f64 {
        let k = f64::from(k) / f64::from(SAMPLES);
        // Ramps of a hundredth of the run.
        let ramp = |from: f64| ((k - from) / 0.01).clamp(0.0, 1.0);
        match self {
            Self::Standstill => SPEED * (1.0 - ramp(0.4) + ramp(0.65)),
            Self::SmallArc => {
                let to_and_fro = TAU / 20.0 * 0.01 * (0.01 * k * f64::from(SAMPLES)).cos();
                SPEED * (1.0 - ramp(0.6)) + to_and_fro * ramp(0.61)
            }
            _ => SPEED,
        }
    }
}

/// One sample: the true angle and what the sensor gives.
pub(crate) struct Sample {
    pub(crate) alpha: f64,
    pub(crate) y: [f64; 2],
}

/// All samples of a sensor in a scenario, the same for every method.
pub(crate) fn samples(scenario: Scenario, sensor: &Sensor) -> impl Iterator<Item = Sample> {
    let mut random = StdRng::seed_from_u64(20);
    let mut alpha = 0.0;
    (0..SAMPLES).map(move |k| {
        let [c, s] = scenario.signals(sensor, alpha, k);
        // Box and Muller.
        let radius = (-2.0 * (1.0 - random.random::<f64>()).ln()).sqrt() * scenario.sigma();
        let (sin, cos) = (TAU * random.random::<f64>()).sin_cos();
        let sample = Sample {
            alpha,
            y: [c + radius * cos, s + radius * sin],
        };
        alpha += scenario.speed(k);
        sample
    })
}
