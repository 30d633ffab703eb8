//! Words that follow from those of the budget: what each adds, and how short it may be.

use std::f64::consts::TAU;

use super::budget::{dead_band, rounding};
use super::formats::{held, level_bits, lock_window, multiplied, skew_top, speed_top};
use super::limits::{absent, gathered_most, of_followers};
use super::ranges::ranges;
use super::skew::{delay, phase_max};
use super::{Loop, Words, normalisation};
use crate::format::{Quantiser, exp2};
use crate::spec::{CalibrationMethod, Spec};

macro_rules! followers {
    ($($key:ident),* $(,)?) => {
        /// The words; see [`Overrides`](crate::spec::Overrides) for what each is.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "described where the user gives them")]
        pub struct Followers {
            $(pub $key: u32,)*
        }

        impl Followers {
            /// Their keys, in the order in which they are shortened.
            pub(super) const KEYS: &'static [&'static str] = &[$(stringify!($key)),*];

            /// The word of `key`; 0 where there is none.
            pub(super) fn word(&self, key: &str) -> u32 {
                match key {
                    $(stringify!($key) => self.$key,)*
                    _ => 0,
                }
            }

            /// With another word of `key`.
            pub(super) fn with(mut self, key: &str, bits: u32) -> Self {
                match key {
                    $(stringify!($key) => self.$key = bits,)*
                    _ => {}
                }
                self
            }
        }
    };
}

followers! {
    sine_value_fraction,
    sine_slope_fraction,
    harmonic_fraction,
    harmonic_value_fraction,
    harmonic_slope_fraction,
    gain_bits,
    cross_bits,
    bend_bits,
    cubic_bits,
    coefficient_bits,
    rate_high_bits,
    residual_fraction,
    sensitivity_fraction,
    gathered_fraction,
    skew_rate_bits,
    skew_bits,
    lock_level_bits,
}

impl Followers {
    /// As the user says, else as long as the words of the budget can make worth it: two bits below a signal's last in a
    /// table, as wide as a signal where one multiplier serves all.
    pub(super) fn generous(words: &Words, spec: &Spec, tracking: &Loop) -> Self {
        let (o, f) = (&spec.formats, words.signal_fraction);
        let or = |given: Option<u32>, chosen: u32| given.unwrap_or(chosen);
        let slope = |fraction: u32, rows: u32| fraction.saturating_sub(rows).max(1);
        let harmonic = or(o.harmonic_fraction, f);
        let width = f + 2;
        Self {
            sine_value_fraction: or(o.sine_value_fraction, f + 2),
            sine_slope_fraction: or(o.sine_slope_fraction, slope(f + 1, words.sine_rows_log2)),
            harmonic_fraction: harmonic,
            harmonic_value_fraction: or(o.harmonic_value_fraction, harmonic + 2),
            // A segment is so much longer than those of the quarter-wave table.
            harmonic_slope_fraction: or(
                o.harmonic_slope_fraction,
                slope(harmonic + 3, words.harmonic_rows_log2),
            ),
            gain_bits: or(o.gain_bits, width),
            cross_bits: or(o.cross_bits, width),
            bend_bits: or(o.bend_bits, width),
            cubic_bits: or(o.cubic_bits, width),
            coefficient_bits: or(o.coefficient_bits, width),
            rate_high_bits: or(
                o.rate_high_bits,
                width.min(words.phase_bits.saturating_sub(2)),
            ),
            residual_fraction: or(o.residual_fraction, f),
            sensitivity_fraction: or(o.sensitivity_fraction, words.phase_bits),
            gathered_fraction: or(
                o.gathered_fraction,
                if spec.calibration.starts() {
                    f
                } else {
                    words.accumulator_fraction.min(gathered_most(spec))
                },
            ),
            skew_rate_bits: or(
                o.skew_rate_bits,
                held(speed_top(spec), width, words.phase_bits).format.width,
            ),
            skew_bits: or(o.skew_bits, held(skew_top(spec), width, f + 6).format.width),
            lock_level_bits: or(o.lock_level_bits, level_bits(tracking)),
        }
    }

    /// Each in turn as short as still `keeps` to the budget, with the others as they are.
    pub(super) fn shortened(
        self,
        words: &Words,
        spec: &Spec,
        keeps: impl Fn(&Self) -> bool,
    ) -> Self {
        Self::KEYS.iter().fold(self, |all, key| {
            if !Self::adds(key) || spec.formats.given(key).is_some() || absent(key, spec).is_some()
            {
                return all;
            }
            let limits = of_followers(&all, words, spec);
            let lowest = limits.iter().find(|l| l.key == *key).map(|l| l.lowest);
            let lowest = lowest.and_then(|n| u32::try_from(n).ok()).unwrap_or(0);
            let mut shorter = (lowest..all.word(key)).map(|n| all.with(key, n));
            shorter.find(|f| keeps(f)).unwrap_or(all)
        })
    }

    /// Whether a shorter word of `key` costs accuracy. The upper part of a rate is parted from the lower, whose product counts
    /// as well; and lock takes as long as the loop takes to settle.
    pub(super) fn adds(key: &str) -> bool {
        !matches!(key, "rate_high_bits" | "lock_level_bits")
    }

    /// What the word of `key` adds to the angle, radians rms, with its source; `None` where the chip has no such word, where
    /// it [adds](Self::adds) nothing, and for harmonics as they are read, which are counted [together](super::harmonics::terms).
    pub(super) fn term(
        &self,
        key: &str,
        words: &Words,
        spec: &Spec,
        tracking: &Loop,
    ) -> Option<(&'static str, f64)> {
        if absent(key, spec).is_some() {
            return None;
        }
        let amplitude = normalisation(spec).0;
        let reach = |n: usize| exp2(ranges(spec).deviation[n].into());
        let m = multiplied(spec, self);
        let of = |word: &Quantiser| rounding(word.format.fraction);
        // Over a segment, in turns.
        let slope =
            |fraction: u32, half_segment: f64| rounding(fraction) * half_segment / 3f64.sqrt();
        Some(match key {
            "sine_value_fraction" => ("sine table values", rounding(self.sine_value_fraction)),
            "sine_slope_fraction" => (
                "sine table slopes",
                slope(
                    self.sine_slope_fraction,
                    exp2(-i64::from(words.sine_rows_log2) - 3),
                ),
            ),
            "harmonic_slope_fraction" => (
                "harmonic table slopes",
                slope(
                    self.harmonic_slope_fraction,
                    exp2(-i64::from(words.harmonic_rows_log2) - 1),
                ),
            ),
            "gain_bits" => (
                "gains as multiplied",
                of(&m.theta[0]) * amplitude * 0.25f64.sqrt(),
            ),
            "cross_bits" => (
                "phase parameter as multiplied",
                of(&m.theta[2]) * amplitude * 0.375f64.sqrt(),
            ),
            // By u, of which a half is left on average.
            "bend_bits" => ("even bends as multiplied", of(&m.bend) / 2.0),
            "cubic_bits" => ("odd bends as multiplied", of(&m.cubic) / 2.0),
            // Of what the loop lags behind and what the sine runs ahead by, at their largest.
            "coefficient_bits" => (
                "coefficients",
                rounding(self.coefficient_bits.saturating_sub(2))
                    * lock_window(spec).hypot(phase_max(spec) / 2.0),
            ),
            "residual_fraction" => (
                "residual as it moves the parameters",
                dead_band(self.residual_fraction),
            ),
            // Of what the estimate follows a parameter by, at its largest.
            "sensitivity_fraction" => (
                "sensitivities and their increments",
                dead_band(self.sensitivity_fraction) / (TAU * tracking.ab)
                    * if spec.calibration.is_exact() {
                        (0..5).map(reach).fold(0.0, f64::max)
                    } else {
                        4.0 * reach(8)
                    },
            ),
            "gathered_fraction" => ("gathered gradients", self.gathered(spec)),
            "skew_rate_bits" => {
                let speed = held(speed_top(spec), self.skew_rate_bits, words.phase_bits);
                (
                    "speed in the channel skew",
                    (delay(spec) * of(&speed)).abs() / 2.0,
                )
            }
            "skew_bits" => {
                let skew = held(skew_top(spec), self.skew_bits, words.signal_fraction + 6);
                ("phase of the channel skew", of(&skew) / 2.0)
            }
            _ => return None,
        })
    }

    /// Below half the last bit nothing is gathered.
    fn gathered(&self, spec: &Spec) -> f64 {
        let c = &spec.calibration;
        if c.starts() || c.method == CalibrationMethod::Batch {
            rounding(self.gathered_fraction) / 8.0
        } else {
            exp2(c.forgetting.into()) * dead_band(self.gathered_fraction)
        }
    }
}
