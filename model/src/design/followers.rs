//! Words that follow from those of the budget, unless the user says otherwise.

use super::budget::{dead_band, rounding};
use super::formats::{held, level_bits, multiplied, skew_top, speed_top};
use super::{Loop, Words};
use crate::format::exp2;
use crate::spec::{CalibrationMethod, Spec};

/// The words; see [`Overrides`](crate::spec::Overrides) for what each is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "described where the user gives them")]
pub struct Followers {
    pub sine_value_fraction: u32,
    pub sine_slope_fraction: u32,
    pub harmonic_fraction: u32,
    pub harmonic_value_fraction: u32,
    pub harmonic_slope_fraction: u32,
    pub gain_bits: u32,
    pub cross_bits: u32,
    pub bend_bits: u32,
    pub cubic_bits: u32,
    pub coefficient_bits: u32,
    pub rate_high_bits: u32,
    pub residual_fraction: u32,
    pub sensitivity_fraction: u32,
    pub gathered_fraction: u32,
    pub skew_rate_bits: u32,
    pub skew_bits: u32,
    pub lock_level_bits: u32,
}

impl Followers {
    /// As the user says, else as wide as the words of the budget make worth it: two bits below a signal's last in a table,
    /// as wide as a signal where one multiplier serves all.
    pub(super) fn of(words: &Words, spec: &Spec, tracking: &Loop) -> Self {
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
            rate_high_bits: or(o.rate_high_bits, width),
            residual_fraction: or(o.residual_fraction, f),
            sensitivity_fraction: or(o.sensitivity_fraction, words.phase_bits),
            gathered_fraction: or(
                o.gathered_fraction,
                if spec.calibration.starts() {
                    f
                } else {
                    words.accumulator_fraction
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

    /// What these words add to the angle where the user wants them coarser than `chosen` for a `free` design, radians rms. Those that the analysis
    /// chooses are so fine that the terms of the budget hold them.
    pub(super) fn terms(
        &self,
        (free, chosen): (&Spec, &Self),
        words: &Words,
        spec: &Spec,
    ) -> Vec<(&'static str, f64)> {
        let c = &spec.calibration;
        // Over a segment, in turns.
        let slope =
            |fraction: u32, half_segment: f64| rounding(fraction) * half_segment / 3f64.sqrt();
        let half_sine = exp2(-i64::from(words.sine_rows_log2) - 3);
        let half_harmonic = exp2(-i64::from(words.harmonic_rows_log2) - 1);
        let (m, fine) = (multiplied(spec, self), multiplied(free, chosen));
        let skew = held(skew_top(spec), self.skew_bits, words.signal_fraction + 6);
        let speed = held(speed_top(spec), self.skew_rate_bits, words.phase_bits);
        // Below half the last bit nothing is gathered.
        let gathered = match c.method {
            _ if c.starts() => rounding(self.gathered_fraction) / 8.0,
            CalibrationMethod::Batch => rounding(self.gathered_fraction) / 8.0,
            _ => exp2(c.forgetting.into()) * dead_band(self.gathered_fraction),
        };
        [
            (
                self.sine_value_fraction < chosen.sine_value_fraction,
                "sine table values",
                rounding(self.sine_value_fraction),
            ),
            (
                self.sine_slope_fraction < chosen.sine_slope_fraction,
                "sine table slopes",
                slope(self.sine_slope_fraction, half_sine),
            ),
            (
                self.harmonic_slope_fraction < chosen.harmonic_slope_fraction,
                "harmonic table slopes",
                slope(self.harmonic_slope_fraction, half_harmonic),
            ),
            // As multiplied by u, of which a half is left on average.
            (
                m.bend.format.fraction < fine.bend.format.fraction,
                "even bends as multiplied",
                rounding(m.bend.format.fraction) / 2.0,
            ),
            (
                m.cubic.format.fraction < fine.cubic.format.fraction,
                "odd bends as multiplied",
                rounding(m.cubic.format.fraction) / 2.0,
            ),
            (
                self.residual_fraction < chosen.residual_fraction,
                "residual as it moves the parameters",
                dead_band(self.residual_fraction),
            ),
            (
                self.gathered_fraction < chosen.gathered_fraction,
                "gathered gradients",
                gathered,
            ),
            (
                self.skew_rate_bits < chosen.skew_rate_bits,
                "speed in the channel skew",
                (super::skew::delay(spec) * rounding(speed.format.fraction)).abs() / 2.0,
            ),
            (
                self.skew_bits < chosen.skew_bits,
                "phase of the channel skew",
                rounding(skew.format.fraction) / 2.0,
            ),
        ]
        .into_iter()
        .filter(|(coarser, ..)| *coarser)
        .map(|(_, source, radians)| (source, radians))
        .collect()
    }
}
