//! Words that follow from those of the budget, unless the user says otherwise.

use std::borrow::Cow;

use super::formats::starts;
use super::formats::{gathered_power, held, level_bits, multiplied, power_of, skew_top, speed_top};
use super::ranges::{just, needs, ranges};
use super::refuse::number;
use super::word::Limits;
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
                if starts(spec) {
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

    /// What these words add to the angle where the user chose them, radians rms. Those that the analysis chooses are so fine
    /// that the terms of the budget hold them.
    pub(super) fn terms(&self, words: &Words, spec: &Spec) -> Vec<(&'static str, f64)> {
        let (o, c) = (&spec.formats, &spec.calibration);
        let rounding = |fraction: u32| exp2(-i64::from(fraction)) / 12f64.sqrt();
        let dead = |fraction: u32| exp2(-i64::from(fraction) - 1) / 3f64.sqrt();
        // Over a segment, in turns.
        let slope =
            |fraction: u32, half_segment: f64| rounding(fraction) * half_segment / 3f64.sqrt();
        let half_sine = exp2(-i64::from(words.sine_rows_log2) - 3);
        let half_harmonic = exp2(-i64::from(words.harmonic_rows_log2) - 1);
        let m = multiplied(spec, self);
        let skew = held(skew_top(spec), self.skew_bits, words.signal_fraction + 6);
        let speed = held(speed_top(spec), self.skew_rate_bits, words.phase_bits);
        // Below half the last bit nothing is gathered.
        let gathered = match c.method {
            _ if starts(spec) => rounding(self.gathered_fraction) / 8.0,
            CalibrationMethod::Batch => rounding(self.gathered_fraction) / 8.0,
            _ => exp2(c.forgetting.into()) * dead(self.gathered_fraction),
        };
        [
            (
                o.sine_value_fraction.is_some(),
                "sine table values",
                rounding(self.sine_value_fraction),
            ),
            (
                o.sine_slope_fraction.is_some(),
                "sine table slopes",
                slope(self.sine_slope_fraction, half_sine),
            ),
            (
                o.harmonic_slope_fraction.is_some(),
                "harmonic table slopes",
                slope(self.harmonic_slope_fraction, half_harmonic),
            ),
            // As multiplied by u, of which a half is left on average.
            (
                o.bend_bits.is_some(),
                "even bends as multiplied",
                rounding(m.bend.format.fraction) / 2.0,
            ),
            (
                o.cubic_bits.is_some(),
                "odd bends as multiplied",
                rounding(m.cubic.format.fraction) / 2.0,
            ),
            (
                o.residual_fraction.is_some(),
                "residual as it moves the parameters",
                dead(self.residual_fraction),
            ),
            (
                o.gathered_fraction.is_some(),
                "gathered gradients",
                gathered,
            ),
            (
                o.skew_rate_bits.is_some(),
                "speed in the channel skew",
                (super::skew::delay(spec) * rounding(speed.format.fraction)).abs() / 2.0,
            ),
            (
                o.skew_bits.is_some(),
                "phase of the channel skew",
                rounding(skew.format.fraction) / 2.0,
            ),
        ]
        .into_iter()
        .filter(|(given, ..)| *given)
        .map(|(_, source, radians)| (source, radians))
        .collect()
    }

    /// What each may be, with the reason of its ends.
    pub(super) fn limits(&self, words: &Words, spec: &Spec) -> Vec<Limits> {
        let (f, p) = (words.signal_fraction, words.phase_bits);
        let (c, r) = (&spec.calibration, ranges(spec));
        let calibrates = (c.parameters == 0).then_some("calibration.parameters is 0");
        let phase =
            (!matches!(c.parameters, 5 | 9)).then_some("θ5 needs 5 or 9 calibration.parameters");
        let bends = (c.parameters < 8).then_some("bends need 8 or 9 calibration.parameters");
        let harmonics = spec.correction.harmonics.is_empty();
        let harmonics = harmonics.then_some("there are no correction.harmonics");
        let skew = (!spec.correction.has_skew()).then_some("correction.channel_skew_s is 0");
        let sensitive = c.parameters >= 8 && c.completion
            || c.parameters > 0 && c.method == CalibrationMethod::Exact;
        let gathers = starts(spec)
            || c.parameters > 0
                && matches!(
                    c.method,
                    CalibrationMethod::SumOfSquares | CalibrationMethod::Batch
                );
        let mut list = vec![];
        let mut word = |key, value: u32, ends: (u32, u32), why: &str, absent| {
            list.push(Limits {
                key,
                value: value.into(),
                lowest: ends.0.into(),
                highest: ends.1.max(ends.0).into(),
                why: Cow::Owned(why.to_owned()),
                absent,
            });
        };
        let table = "a table's values hold half the last bit of what is read; below eight more bits nothing counts";
        let slopes = "a slope has a bit behind its point, and below a signal's last bit eight count for nothing";
        word(
            "sine_value_fraction",
            self.sine_value_fraction,
            (f + 1, f + 8),
            table,
            None,
        );
        word(
            "sine_slope_fraction",
            self.sine_slope_fraction,
            (1, f + 8),
            slopes,
            None,
        );
        let h = self.harmonic_fraction;
        let read = "a harmonic is a quarter of the amplitude at most, and is taken off a signal";
        word("harmonic_fraction", h, (4, f + 2), read, harmonics);
        word(
            "harmonic_value_fraction",
            self.harmonic_value_fraction,
            (h.saturating_add(1), h.saturating_add(8)),
            table,
            harmonics,
        );
        word(
            "harmonic_slope_fraction",
            self.harmonic_slope_fraction,
            (1, f + 8),
            slopes,
            harmonics,
        );
        let least = |largest: f64| u32::try_from(power_of(largest) + 2).unwrap_or(0).max(6);
        let reach = |n: usize| exp2(r.deviation[n].into());
        let factor = "the largest of these parameters needs a bit behind its point, and eight bits more than a signal's count \
                      for nothing";
        word(
            "gain_bits",
            self.gain_bits,
            (least(r.nominal + reach(0)), f + 8),
            factor,
            None,
        );
        word(
            "cross_bits",
            self.cross_bits,
            (least(reach(4)), f + 8),
            factor,
            phase,
        );
        word(
            "bend_bits",
            self.bend_bits,
            (least(reach(5)), f + 8),
            factor,
            bends,
        );
        word(
            "cubic_bits",
            self.cubic_bits,
            (least(8.0 * reach(7)), f + 8),
            factor,
            bends,
        );
        let coefficient = "with fewer the loop is another one, and eight bits more than a signal's count for nothing";
        word(
            "coefficient_bits",
            self.coefficient_bits,
            (8, f + 8),
            coefficient,
            None,
        );
        let upper = "the rate has so many bits, of which the lower part keeps some";
        let one = (spec.tracking.filter_type == 2).then_some("a loop of type 2 multiplies no rate");
        word(
            "rate_high_bits",
            self.rate_high_bits,
            (4, p - 2),
            upper,
            one,
        );
        let residual = "a quarter of the radius at most moves the parameters, as fine as a signal";
        word(
            "residual_fraction",
            self.residual_fraction,
            (4, f),
            residual,
            calibrates,
        );
        let sensitivity = (!sensitive).then_some(
            "sensitivities are of calibration.method = \"exact\" and of calibration.completion",
        );
        let container = "fewer lose what is summed up; more do not fit";
        word(
            "sensitivity_fraction",
            self.sensitivity_fraction,
            (8, 44),
            container,
            sensitivity,
        );
        let gather = (!gathers).then_some(
            "gradients are gathered by the sum of squares, the batch and the start by least squares",
        );
        let most = 44 - gathered_power(spec).unsigned_abs();
        word(
            "gathered_fraction",
            self.gathered_fraction,
            (8, most),
            container,
            gather,
        );
        // As wide as its finest bit allows.
        let most = |largest: f64, finest: u32| held(largest, 64, finest).format.width;
        let delay = "fewer are no number, and more are finer than what they are made of";
        let rate = (4, most(speed_top(spec), p));
        word("skew_rate_bits", self.skew_rate_bits, rate, delay, skew);
        word(
            "skew_bits",
            self.skew_bits,
            (4, most(skew_top(spec), f + 6)),
            delay,
            skew,
        );
        let level = "lock takes as many samples as the loop takes to settle: 32 to 4096";
        word(
            "lock_level_bits",
            self.lock_level_bits,
            (5, 12),
            level,
            None,
        );
        list.extend(range_limits(spec, [calibrates, calibrates, phase, bends]));
        list
    }
}

/// log2 of the largest range of a parameter.
const WIDEST: i64 = 4;

/// Ranges of the parameters: each holds what the promised sensors need at their worst.
fn range_limits(spec: &Spec, absent: [Option<&'static str>; 4]) -> Vec<Limits> {
    let (need, s, r) = (needs(spec), &spec.sensor, ranges(spec));
    let m = number(s.amplitude_tolerance);
    let beta = format!(
        "sensor.phase_error_max_deg is {}",
        number(s.phase_error_max_deg)
    );
    let tolerance = format!("sensor.amplitude_tolerance is {m} and {beta}");
    let offset = format!("sensor.offset_max is {}, {tolerance}", number(s.offset_max));
    let bend = format!("sensor.bend_max is {}", number(s.bend_max));
    let rows = [
        (
            "gain_range_log2",
            "theta_1_deviation and theta_3_deviation reach",
            need.gain,
            0,
            &tolerance,
        ),
        (
            "offset_range_log2",
            "theta_2_deviation and theta_4_deviation reach",
            need.offset,
            1,
            &offset,
        ),
        (
            "cross_range_log2",
            "theta_5_deviation reaches",
            need.cross,
            4,
            &tolerance,
        ),
        (
            "bend_range_log2",
            "theta_6_deviation to theta_9_deviation reach",
            need.bend,
            5,
            &bend,
        ),
    ];
    rows.into_iter()
        .zip(absent)
        .map(|((key, node, need, of, when), absent)| Limits {
            key,
            value: r.deviation[of].into(),
            lowest: just(need).into(),
            highest: WIDEST,
            why: format!("{node} {need:.3} where {when}, and no parameter is beyond 16",).into(),
            absent,
        })
        .collect()
}
