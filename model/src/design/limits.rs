//! What each word length may be, and why.

use std::borrow::Cow;

use super::formats::{gathered_power, held, power_of, skew_top, speed_top};
use super::lengths::Lengths;
use super::ranges::{just, multiplied_top, needs, ranges};
use super::refuse::number;
use super::{Followers, Words, harmonics};
use crate::spec::Spec;

/// A word length and its ends.
pub(super) struct Limits {
    pub(super) key: &'static str,
    pub(super) value: i64,
    pub(super) lowest: i64,
    pub(super) highest: i64,
    /// Why these are its ends.
    pub(super) why: Cow<'static, str>,
    /// Why this chip has no such word.
    pub(super) absent: Option<&'static str>,
}

/// Of every word, each with the others as they are; ranges first, which the others hold.
pub(super) fn all(lengths: &Lengths, spec: &Spec) -> Vec<Limits> {
    let mut list = of_ranges(spec);
    list.extend(of_lengths(lengths, spec));
    list
}

/// Of every word but the ranges, those of the budget first.
pub(super) fn of_lengths(lengths: &Lengths, spec: &Spec) -> Vec<Limits> {
    let mut list = of_budget(&lengths.words, spec);
    list.extend(of_followers(&lengths.followers, &lengths.words, spec));
    list
}

/// Most fraction bits of a gathered gradient.
fn gathered_most(spec: &Spec) -> u32 {
    44 - gathered_power(spec).unsigned_abs()
}

/// Why a chip has no word of this key, where it has none.
pub(super) fn absent(key: &str, spec: &Spec) -> Option<&'static str> {
    let c = &spec.calibration;
    let (missing, why) = match key {
        key if key.starts_with("harmonic_") => (
            spec.correction.harmonics.is_empty(),
            "there are no correction.harmonics",
        ),
        "accumulator_fraction" | "residual_fraction" | "gain_range_log2" | "offset_range_log2" => {
            (!c.is_on(), "calibration.parameters is 0")
        }
        "cross_bits" | "cross_range_log2" => {
            (!c.has_phase(), "θ5 needs 5 or 9 calibration.parameters")
        }
        "bend_bits" | "cubic_bits" | "bend_range_log2" => {
            (!c.has_bend(), "bends need 8 or 9 calibration.parameters")
        }
        "rate_high_bits" => (
            spec.tracking.filter_type == 2,
            "a loop of type 2 multiplies no rate",
        ),
        "sensitivity_fraction" => (
            c.completed().is_none() && !c.is_exact(),
            "sensitivities are of calibration.method = \"exact\" and of calibration.completion",
        ),
        "gathered_fraction" => (
            !c.gathers(),
            "gradients are gathered by the sum of squares, the batch and the start by least squares",
        ),
        "skew_rate_bits" | "skew_bits" => (
            !spec.correction.has_skew(),
            "correction.channel_skew_s is 0",
        ),
        _ => (false, ""),
    };
    missing.then_some(why)
}

/// The words of the budget, each with those before it as they are.
fn of_budget(words: &Words, spec: &Spec) -> Vec<Limits> {
    let keys = Words::KEYS.iter();
    keys.map(|key| {
        let (lowest, highest, why) = ends(key, words);
        Limits {
            key,
            value: words.word(key).unwrap_or(0).into(),
            lowest: lowest.into(),
            highest: highest.into(),
            why: why.into(),
            absent: absent(key, spec),
        }
    })
    .collect()
}

/// Most fraction bits of a signal.
const SIGNAL_FRACTION_MAX: u32 = 24;

/// What a word of the budget may be, with those before it as they are, and why.
fn ends(key: &str, w: &Words) -> (u32, u32, &'static str) {
    let (rows, harmonic_rows, f) = (w.sine_rows_log2, w.harmonic_rows_log2, w.signal_fraction);
    match key {
        "signal_fraction" => (8, SIGNAL_FRACTION_MAX, SIGNAL),
        "sine_rows_log2" => (4, 13, ROWS),
        "harmonic_rows_log2" => (4, harmonics::ROWS_LOG2_MAX, ROWS),
        "sine_phase_bits" => ((rows + 3).max(harmonic_rows + 1), 30, SINE_PHASE),
        "phase_bits" => (w.sine_phase_bits.max(f + 3), 44, PHASE),
        _ => (f, 44, ACCUMULATOR),
    }
}

const SIGNAL: &str = "with fewer there is no angle left, and of more the products fit no container";
const ROWS: &str = "with fewer the segments are no straight lines, and more make no angle finer";
const SINE_PHASE: &str =
    "they number the rows of the tables, with a bit between these, and more make no angle finer";
const PHASE: &str = "the phase is as fine as what the sine reads of it and as the signals that move it, and more fit no container";
const ACCUMULATOR: &str =
    "a parameter is as fine as the signal that it corrects, and more fit no container";
const TABLE: &str =
    "a table's values hold half the last bit of what is read; below eight more bits nothing counts";
const SLOPES: &str =
    "a slope has a bit behind its point, and below a signal's last bit eight count for nothing";
const READ: &str = "a harmonic is a quarter of the amplitude at most, and is taken off a signal";
const FACTOR: &str = "the largest of these parameters needs a bit behind its point, and eight bits more than a signal's count \
                      for nothing";
const COEFFICIENT: &str =
    "with fewer the loop is another one, and eight bits more than a signal's count for nothing";
const UPPER: &str = "the rate has so many bits, of which the lower part keeps some";
const RESIDUAL: &str = "a quarter of the radius at most moves the parameters, as fine as a signal";
const CONTAINER: &str = "fewer lose what is summed up; more do not fit";
const DELAY: &str = "fewer are no number, and more are finer than what they are made of";
const LEVEL: &str = "lock takes as many samples as the loop takes to settle: 32 to 4096";

/// The words that follow from those of the budget.
fn of_followers(words_that_follow: &Followers, words: &Words, spec: &Spec) -> Vec<Limits> {
    let w = words_that_follow;
    let (f, p, h) = (words.signal_fraction, words.phase_bits, w.harmonic_fraction);
    let least = |largest: f64| u32::try_from(power_of(largest) + 2).unwrap_or(0).max(6);
    let factor = |key| {
        let largest = multiplied_top(key, spec);
        (least(largest), f + 8)
    };
    // As wide as its finest bit allows.
    let most = |largest: f64, finest: u32| held(largest, 64, finest).format.width;
    let values = (h.saturating_add(1), h.saturating_add(8));
    let gathered = (8, gathered_most(spec));
    // Where even the finest is shorter, that.
    let delayed = |most: u32| (most.min(4), most);
    let skew_rate = delayed(most(speed_top(spec), p));
    let skew = delayed(most(skew_top(spec), f + 6));
    let rows = [
        (
            "sine_value_fraction",
            w.sine_value_fraction,
            (f + 1, f + 8),
            TABLE,
        ),
        (
            "sine_slope_fraction",
            w.sine_slope_fraction,
            (1, f + 8),
            SLOPES,
        ),
        ("harmonic_fraction", h, (4, f + 2), READ),
        (
            "harmonic_value_fraction",
            w.harmonic_value_fraction,
            values,
            TABLE,
        ),
        (
            "harmonic_slope_fraction",
            w.harmonic_slope_fraction,
            (1, f + 8),
            SLOPES,
        ),
        ("gain_bits", w.gain_bits, factor("gain_bits"), FACTOR),
        ("cross_bits", w.cross_bits, factor("cross_bits"), FACTOR),
        ("bend_bits", w.bend_bits, factor("bend_bits"), FACTOR),
        ("cubic_bits", w.cubic_bits, factor("cubic_bits"), FACTOR),
        (
            "coefficient_bits",
            w.coefficient_bits,
            (8, f + 8),
            COEFFICIENT,
        ),
        (
            "rate_high_bits",
            w.rate_high_bits,
            (4, p.saturating_sub(2)),
            UPPER,
        ),
        ("residual_fraction", w.residual_fraction, (4, f), RESIDUAL),
        (
            "sensitivity_fraction",
            w.sensitivity_fraction,
            (8, 44),
            CONTAINER,
        ),
        (
            "gathered_fraction",
            w.gathered_fraction,
            gathered,
            CONTAINER,
        ),
        ("skew_rate_bits", w.skew_rate_bits, skew_rate, DELAY),
        ("skew_bits", w.skew_bits, skew, DELAY),
        ("lock_level_bits", w.lock_level_bits, (5, 12), LEVEL),
    ];
    rows.into_iter()
        .map(|(key, value, (lowest, highest), why)| Limits {
            key,
            value: value.into(),
            lowest: lowest.into(),
            highest: highest.max(lowest).into(),
            why: why.into(),
            absent: absent(key, spec),
        })
        .collect()
}

/// log2 of the largest range of a parameter.
const WIDEST_RANGE: i64 = 4;

/// Ranges of the parameters: each holds what the promised sensors need at their worst.
fn of_ranges(spec: &Spec) -> Vec<Limits> {
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
        .map(|(key, node, need, of, when)| Limits {
            key,
            value: r.deviation[of].into(),
            lowest: just(need).into(),
            highest: WIDEST_RANGE,
            why: format!("{node} {need:.3} where {when}, and no parameter is beyond 16",).into(),
            absent: absent(key, spec),
        })
        .collect()
}
