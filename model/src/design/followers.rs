//! Words that follow from those of the budget: what each adds, and how short it may be.

use std::f64::consts::TAU;

use super::budget::{dead_band, rounding};
use super::constants::lock_window;
use super::formats::{held, multiplied, skew_top, speed_top};
use super::lengths::{Followers, Words};
use super::limits::absent;
use super::ranges::ranges;
use super::skew::{delay, phase_max};
use super::{Loop, normalisation};
use crate::format::{Quantiser, exp2};
use crate::spec::{CalibrationMethod, Spec};

/// Whether a shorter word of `key` costs accuracy. The upper part of a rate is parted from the lower, whose product counts
/// as well; and lock takes as long as the loop takes to settle.
pub(super) fn adds(key: &str) -> bool {
    !matches!(key, "rate_high_bits" | "lock_level_bits")
}

impl Followers {
    /// What the word of `key` adds to the angle, radians rms, with its source; `None` where the chip has no such word, where
    /// it [adds] nothing, and for harmonics as they are read, which are counted [together](super::harmonics::terms).
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
