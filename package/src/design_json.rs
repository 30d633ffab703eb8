//! `design.json`: every number that was derived.

use nonius_model::design::{Design, Word};
use nonius_model::physical::{metres, radians_of_revolution};
use nonius_model::spec::Spec;
use serde::Serialize;

use crate::channel_skew::ChannelSkew;
use crate::coefficient::{Coefficient, coefficients};
use crate::harmonics::HarmonicTable;
use crate::pull_in::PullIn;
use crate::signals::Signal;
use crate::simulation::Accuracy;
use crate::sine::{SineError, sine_error};
use crate::slow_lock::SlowLock;
use crate::tracking::Tracking;

/// The whole file.
#[derive(Clone, Debug, Serialize)]
pub struct DesignJson {
    /// Version of this layout.
    pub schema: &'static str,
    /// Name of the design and of its top module.
    pub name: String,
    /// Hash of all that went in.
    pub hash: String,
    /// Clocks from one sample to the next, and from `sample_valid` to `valid`.
    pub clocks_per_sample: usize,
    /// Products of a sample.
    pub products: usize,
    /// Multipliers they are computed on: as many as the chip has, which may be fewer than `spec.chip.multipliers` allows.
    pub multipliers: usize,
    /// Latencies.
    pub latency: Latency,
    /// The loop.
    #[serde(rename = "loop")]
    pub tracking: Tracking,
    /// The correction of channel skew, where the design has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel_skew: Option<ChannelSkew>,
    /// The table of harmonics, where the design has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub harmonics: Option<HarmonicTable>,
    /// The position at the output.
    pub position: Position,
    /// Every coefficient with its rounding error.
    pub coefficients: Vec<Coefficient>,
    /// Every signal with a name.
    pub formats: Vec<Signal>,
    /// The sine table and what is made of it.
    pub sine_table: SineTable,
    /// Where the error of the angle comes from.
    pub budget: Budget,
    /// The bit-true chip, measured.
    pub simulated: Accuracy,
    /// The same with the weakest signals that are promised.
    pub simulated_weakest: Accuracy,
    /// From power-up into full speed, measured likewise.
    pub pull_in: PullIn,
    /// How promised sensors are learned at slow speed, where bends are calibrated.
    pub slow_lock: Option<SlowLock>,
    /// What was asked for.
    pub spec: Spec,
}

/// Latencies.
#[derive(Clone, Debug, Serialize)]
pub struct Latency {
    /// From `sample_valid` to `valid`.
    pub clocks: usize,
    /// The slowest clock that serves the sample rate, hertz.
    pub clock_hz_min: f64,
    /// The design's clock; without one the slowest, hertz.
    pub clock_hz: f64,
    /// `clocks` at that clock, seconds.
    pub seconds_at_that_clock: f64,
    /// The position is the estimate for so many samples after the one that came in.
    pub position_is_ahead_by_samples: u32,
}

/// The position that the chip puts out, equation (1) at its edge.
#[derive(Clone, Debug, Serialize)]
pub struct Position {
    /// Bits of whole periods.
    pub period_bits: u32,
    /// Bits of the fraction of a period.
    pub fraction_bits: u32,
    /// Weight of the last bit, periods.
    pub step_periods: f64,
    /// Metres per scale period, where the design says.
    pub metres_per_period: Option<f64>,
    /// Weight of the last bit, metres.
    pub step_m: Option<f64>,
    /// Largest displacement either way, metres.
    pub range_m: Option<f64>,
    /// Radians of the revolution per scale period, where the design says how many make one.
    pub radians_per_period: Option<f64>,
}

impl Position {
    fn of(design: &Design) -> Self {
        let (f, spec) = (&design.structure.formats, &design.spec);
        let step = f.alpha.format.lsb();
        Self {
            period_bits: f.count.format.width,
            fraction_bits: f.alpha.format.width,
            step_periods: step,
            metres_per_period: metres(spec, 1.0),
            step_m: metres(spec, step),
            range_m: metres(spec, 2f64.powi(f.count.format.width as i32 - 1)),
            radians_per_period: radians_of_revolution(spec, 1.0),
        }
    }
}

/// The sine table.
#[derive(Clone, Debug, Serialize)]
pub struct SineTable {
    /// Rows.
    pub rows: usize,
    /// Bits of a row.
    pub row_bits: u32,
    /// Bits altogether.
    pub bits: u64,
    /// Errors of sine and cosine.
    pub error: SineError,
}

/// The error budget in periods rms.
#[derive(Clone, Debug, Serialize)]
pub struct Budget {
    /// Asked for.
    pub asked: f64,
    /// The ADC's part.
    pub adc: f64,
    /// The sensor's noise through the loop.
    pub noise: f64,
    /// Noise that the calibration at its last gamma lets into the parameters.
    pub calibration: f64,
    /// What the design promises of the sensor and does not calibrate, at its worst.
    pub uncorrected: f64,
    /// What the arithmetic may add.
    pub arithmetic_allowed: f64,
    /// What it adds.
    pub arithmetic: f64,
    /// Everything.
    pub total: f64,
    /// The arithmetic's part by source.
    pub terms: Vec<Term>,
    /// The word lengths that make it, each by the key that overrides it.
    pub words: Vec<Word>,
}

/// A source of error.
#[derive(Clone, Debug, Serialize)]
pub struct Term {
    /// What it is.
    pub source: &'static str,
    /// Its part, periods rms.
    pub rms_periods: f64,
}

impl DesignJson {
    /// The accuracy is simulated worse than what was asked for.
    #[must_use]
    pub fn misses(&self) -> bool {
        self.simulated.rms_periods > self.budget.asked || !self.simulated.locked
    }

    /// The weakest sensor that is promised is simulated worse than what was asked for.
    #[must_use]
    pub fn misses_with_the_weakest(&self) -> bool {
        let weakest = self.simulated_weakest;
        weakest.rms_periods > self.budget.asked || !weakest.locked
    }

    /// With half of the promised errors the accuracy holds, and every promised sensor locks into full speed; the weakest signals and slow
    /// motion are only told.
    #[must_use]
    pub fn holds(&self) -> bool {
        !self.misses() && self.pull_in.holds()
    }

    /// All of it, of a chip with so many clocks per sample and multipliers; measures the sine.
    #[must_use]
    pub fn of(
        design: &Design,
        hash: &str,
        (clocks, multipliers): (usize, usize),
        [simulated, simulated_weakest]: [Accuracy; 2],
        pull_in: PullIn,
        slow_lock: Option<SlowLock>,
    ) -> Self {
        let (spec, b) = (&design.spec, &design.budget);
        let (rate, products) = (spec.adc.sample_rate_hz, design.graph.products());
        let least = rate * clocks as f64;
        let clock = spec.chip.clock_hz.unwrap_or(least);
        let rom = &design.structure.sine;
        Self {
            schema: "nonius.design/1",
            name: spec.name.clone(),
            hash: hash.into(),
            clocks_per_sample: clocks,
            products,
            multipliers,
            latency: Latency {
                clocks,
                clock_hz_min: least,
                clock_hz: clock,
                seconds_at_that_clock: clocks as f64 / clock,
                position_is_ahead_by_samples: 1,
            },
            tracking: Tracking::of(design),
            channel_skew: ChannelSkew::of(design),
            harmonics: HarmonicTable::of(design),
            position: Position::of(design),
            coefficients: coefficients(design),
            formats: crate::signals::signals(design),
            sine_table: SineTable {
                rows: rom.rows(),
                row_bits: rom.row_width(),
                bits: rom.bits(),
                error: sine_error(design),
            },
            budget: Budget {
                asked: spec.accuracy.rms_periods,
                adc: b.adc,
                noise: b.noise,
                calibration: b.calibration,
                uncorrected: b.uncorrected,
                arithmetic_allowed: b.allowed,
                arithmetic: b.arithmetic(),
                total: b.total(),
                terms: b
                    .terms
                    .iter()
                    .map(|t| Term {
                        source: t.source,
                        rms_periods: t.rms_periods,
                    })
                    .collect(),
                words: design.word_lengths(),
            },
            simulated,
            simulated_weakest,
            pull_in,
            slow_lock,
            spec: spec.clone(),
        }
    }
}
