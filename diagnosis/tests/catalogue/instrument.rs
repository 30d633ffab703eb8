//! How an instrument that nobody describes records an axis.

use std::f64::consts::TAU;

use nonius_diagnosis::{Cause, Diagnosis, diagnose};
use nonius_kept::every;
use nonius_recording::{Ellipse, Overrides, Recording};
use rand::{SeedableRng, rngs::StdRng};
use rand_distr::{Distribution, StandardNormal};

use crate::harness::names;

pub(crate) const SAMPLES: usize = 16_000;
pub(crate) const RATE: f64 = 20e3;
pub(crate) const LENGTH: f64 = SAMPLES as f64 / RATE;

/// What becomes of the codes of sample `k`.
pub(crate) type Damage = fn(k: usize, codes: [i64; 2]) -> [i64; 2];

/// How a recording is made.
pub(crate) struct Instrument {
    /// Radians after a time in seconds.
    pub(crate) axis: fn(t: f64) -> f64,
    /// The two channels, in amplitudes, less what they have without an error.
    pub(crate) error: fn(alpha: f64) -> [f64; 2],
    /// Of the amplitude.
    pub(crate) noise: f64,
    /// Of the ADC, whose range is about a fourth more than the signals have.
    pub(crate) bits: i32,
    /// What becomes of the codes of cos and sin.
    pub(crate) damage: Damage,
    /// What stands before the columns.
    pub(crate) header: &'static str,
    /// What one code is.
    pub(crate) unit: f64,
    /// Steps of the reference in a period, where there is one.
    pub(crate) counts: Option<f64>,
}

pub(crate) const PLAIN: Instrument = Instrument {
    axis: swept,
    error: |_| [0.0; 2],
    noise: 1e-3,
    bits: 14,
    damage: |_, codes| codes,
    header: "",
    unit: 1.0,
    counts: None,
};

/// Over 60 periods and back.
pub(crate) fn swept(t: f64) -> f64 {
    60.0 * TAU * (TAU * 1.3 * t / LENGTH).sin() + 11.0 * TAU * t / LENGTH
}

/// How far positions, turns, are off the angle of each sample, radians: rms, but for where they count from.
pub(crate) fn off(turns: &[f64], angle: impl Fn(usize) -> f64) -> f64 {
    let off = turns.iter().enumerate().map(|(k, t)| t - angle(k) / TAU);
    let off: Vec<f64> = off.map(|off| off - off.round()).collect();
    let mean = off.iter().sum::<f64>() / off.len() as f64;
    let square: f64 = off.iter().map(|o| (o - mean).powi(2)).sum();
    TAU * (square / off.len() as f64).sqrt()
}

impl Instrument {
    pub(crate) fn diagnosed(&self, seed: u64) -> Diagnosis {
        self.diagnosed_of(&self.recorded(seed))
    }

    pub(crate) fn diagnosed_of(&self, recording: &Recording) -> Diagnosis {
        let found = diagnose(recording).expect("an ellipse");
        crate::words::well_said(&found);
        found
    }

    /// Errors of the diagnosis' positions and of those by the nearest ellipse, radians rms.
    pub(crate) fn position_errors(&self, recording: &Recording, found: &Diagnosis) -> [f64; 2] {
        let (cos, sin) = (&recording.cos, &recording.sin);
        let ellipse = Ellipse::fit(cos, sin).ellipse;
        let by_ellipse = cos.iter().zip(sin).map(|(c, s)| ellipse.angle(*c, *s));
        let all: [Vec<f64>; 2] = [found.positions.clone(), by_ellipse.collect()];
        all.map(|turns| off(&turns, |k| (self.axis)(k as f64 / RATE)))
    }

    pub(crate) fn recorded(&self, seed: u64) -> Recording {
        let mut random = StdRng::seed_from_u64(seed);
        let mut noise =
            || -> f64 { self.noise * Distribution::<f64>::sample(&StandardNormal, &mut random) };
        let half = 2f64.powi(self.bits - 1);
        let mut text = format!("{}time_s,cos,sin", self.header);
        text += if self.counts.is_some() {
            ",reference_rad\n"
        } else {
            "\n"
        };
        for k in 0..SAMPLES {
            let t = k as f64 / RATE;
            let alpha = (self.axis)(t);
            let [c, s] = (self.error)(alpha);
            let cos = 0.02 + 0.8 * (alpha.cos() + c + noise());
            let sin = -0.03 + 0.78 * ((alpha - 0.03).sin() + s + noise());
            let codes = [cos, sin].map(|v| (v * half).round() as i64);
            let [c, s] = (self.damage)(k, codes).map(|code| code as f64 * self.unit);
            text += &format!("{t:.7},{c},{s}");
            if let Some(counts) = self.counts {
                let step = TAU / counts;
                text += &format!(",{:.8}", ((alpha + 0.4) / step).floor() * step);
            }
            text += "\n";
        }
        Recording::read_from(text.as_bytes(), "test", &Overrides::default()).expect("a recording")
    }

    /// Bends of a few per cent are found, as such or as the second harmonic that they are.
    pub(crate) fn bent(self) -> Diagnosis {
        let bent = Self {
            error: |alpha| [0.03 * alpha.cos().powi(2), -0.02 * alpha.sin().powi(2)],
            ..self
        };
        let found = bent.diagnosed(0);
        let first = names(&found);
        let either = first == [Cause::EvenNonlinearity] || first == [Cause::SpatialHarmonic];
        assert!(either, "{first:?}: {}", found.unexplained.signature);
        found
    }

    /// With this noise, and two others in the long form.
    pub(crate) fn shows(&self, expected: &[Cause]) {
        for seed in every(3, 0..3) {
            let found = self.diagnosed(seed);
            let left = &found.unexplained;
            assert_eq!(names(&found), expected, "{seed}: {}", left.signature);
            assert!(!left.significant, "{seed}: {}", left.signature);
        }
    }
}
