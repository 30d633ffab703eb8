//! Structure and formats of a design.

use std::f64::consts::TAU;

use super::ranges::{multiplied_top, ranges};
use super::{Acquisition, DesignError, Followers, Loop, Words, harmonics, normalisation, skew};
use crate::format::{CONTAINER_INTEGER, Format, Quantiser, exp2};
use crate::kernel::skew::Order;
use crate::kernel::start::PERIODS as START_PERIODS;
use crate::kernel::{Formats, Method, Structure};
use crate::rom::{Column, Rom};
use crate::spec::{Calibration, CalibrationMethod, Coding, Spec};

pub(super) fn power_of(value: f64) -> i32 {
    value.log2().ceil() as i32
}

pub(super) fn level_bits(tracking: &Loop) -> u32 {
    (power_of(4.0 / tracking.omega).clamp(5, 12)) as u32
}

/// −2 log2 of the amplitude at the multipliers, to a whole number: to the nearest one; where the final form has four or five
/// parameters three tenths lower, the middle of what converges within five periods.
fn amplitude_shift(spec: &Spec) -> u32 {
    let octaves = -2.0 * normalisation(spec).0.log2();
    let lower = if spec.calibration.is_linear_final() {
        0.3
    } else {
        0.0
    };
    (octaves - lower).round() as u32
}

/// The loop's bandwidth over the slowest signal that the completion learns from.
const FASTER: f64 = 5.0;

/// Samples of a period of travel at a fifth of the loop's bandwidth: below that the loop follows what the completion
/// should see.
pub(super) fn travel_samples(spec: &Spec) -> u32 {
    (FASTER * spec.adc.sample_rate_hz / spec.tracking.bandwidth_hz) as u32
}

/// The bandwidth of the loop, Hz, below which they are more than a counter holds.
pub(super) fn slowest_completed_hz(spec: &Spec) -> f64 {
    FASTER * spec.adc.sample_rate_hz / f64::from(TRAVEL_SAMPLES_MAX)
}

/// Most of them: a counter and one more stay in the container, whose sign is not theirs.
pub(super) const TRAVEL_SAMPLES_MAX: u32 = (1 << (CONTAINER_INTEGER - 3)) - 1;

/// An accumulator with no more bits of fraction than these.
fn coarser(accumulator: Format, fraction: u32) -> Quantiser {
    let less = accumulator.fraction.saturating_sub(fraction);
    Quantiser::grid(Format::signed(
        accumulator.width - less,
        accumulator.fraction - less,
    ))
}

/// The most quiet periods of travel that are counted.
fn periods(c: &Calibration) -> u32 {
    if c.recalls() {
        c.gear_periods().max(c.returning_periods() + 1)
    } else {
        c.gear_periods()
    }
}

/// A counter from 0 to `last`.
fn counting_to(last: u32) -> Quantiser {
    Quantiser::wrapping(Format::unsigned((32 - last.leading_zeros()).max(1), 0))
}

/// Saturating, so wide or as `finest` fraction bits need, for values up to `largest` in magnitude.
pub(super) fn held(largest: f64, width: u32, finest: u32) -> Quantiser {
    let power = power_of(largest).max(1 - finest as i32);
    let fraction = (width as i32 - 1 - power).clamp(1 - power, finest as i32);
    Quantiser::saturating(Format::signed(bits(1 + power + fraction), bits(fraction)))
}

pub(super) fn bits(n: i32) -> u32 {
    u32::try_from(n).unwrap_or(0)
}

/// A quarter either way.
fn quarter(fraction: u32) -> Quantiser {
    Quantiser::saturating(Format::signed(fraction - 1, fraction))
}

/// Speeds up to here are corrected for the delay of the sine, turns per sample.
pub(super) fn speed_top(spec: &Spec) -> f64 {
    1.25 * spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz
}

/// Phases of that delay up to here, radians.
pub(super) fn skew_top(spec: &Spec) -> f64 {
    2.5 * skew::phase_max(spec)
}

/// log2 of the largest gathered gradient.
pub(super) fn gathered_power(spec: &Spec) -> i32 {
    if spec.calibration.starts() {
        // Sums of 64 residuals, each a quarter at most.
        4
    } else if spec.calibration.method == CalibrationMethod::Batch {
        7
    } else {
        1
    }
}

/// Parameters as they are multiplied.
pub(super) struct Multiplied {
    /// θ1, θ3, θ5.
    pub(super) theta: [Quantiser; 3],
    /// θ6 and θ7.
    pub(super) bend: Quantiser,
    /// 4 (θ8 ± θ9).
    pub(super) cubic: Quantiser,
}

/// Their points as far left as their ranges allow.
pub(super) fn multiplied(spec: &Spec, follow: &Followers) -> Multiplied {
    let word = |key: &str, width: u32| {
        let power = power_of(multiplied_top(key, spec));
        Quantiser::saturating(Format::signed(width, bits(width as i32 - 1 - power)))
    };
    let gain = word("gain_bits", follow.gain_bits);
    Multiplied {
        theta: [gain, gain, word("cross_bits", follow.cross_bits)],
        bend: word("bend_bits", follow.bend_bits),
        cubic: word("cubic_bits", follow.cubic_bits),
    }
}

pub(super) fn structure(
    spec: &Spec,
    acquisition: &Acquisition,
    (words, follow): (&Words, &Followers),
) -> Result<Structure, DesignError> {
    let f = words.signal_fraction;
    let width = f + 2;
    let signal = Quantiser::saturating(Format::signed(width, f));
    let r = ranges(spec);
    let power = normalisation(spec).1;
    let adc_bits = spec.adc.bits;
    let offset_binary = spec.adc.coding == Coding::OffsetBinary;
    let y = Format::signed(adc_bits, adc_bits - 1 - power.min(adc_bits - 1));
    let accumulator = |power: i32| {
        let facc = words.accumulator_fraction;
        Quantiser::saturating(Format::signed(bits(1 + power + facc as i32), facc))
    };
    let (fp, sp) = (words.phase_bits, words.sine_phase_bits);
    let step = accumulator(r.deviation.into_iter().max().unwrap_or(0));
    let fast = spec.sensor.speed_max_periods_per_s > 0.2 * spec.adc.sample_rate_hz;
    let multiplied = multiplied(spec, follow);
    let formats = Formats {
        adc: if offset_binary {
            Format::unsigned(adc_bits, adc_bits)
        } else {
            Format::signed(adc_bits, adc_bits)
        },
        y,
        signal,
        signal_rounded: signal.rounded_before(),
        residual: quarter(follow.residual_fraction),
        along: if spec.calibration.starts() {
            // The start weighs it by the sectors that a sample stands for.
            signal
        } else {
            // No more than a quarter of a pair, which is 2 at most: the same word, two bits finer. What is cut off moves parameters that
            // few places of the period do not tell.
            Quantiser::saturating(Format::signed(width, f + 2))
        },
        alpha: Quantiser::wrapping(Format::unsigned(fp, fp)),
        phase_difference: Quantiser::wrapping(Format::signed(fp, fp)),
        // A quarter of a turn each way, and twice that where the design comes near it.
        rate: Quantiser::saturating(Format::signed(if fast { fp } else { fp - 1 }, fp)),
        rate_high: {
            let high = follow.rate_high_bits;
            Quantiser::grid(Format::signed(high, if fast { high } else { high + 1 }))
        },
        harmonic: quarter(follow.harmonic_fraction),
        skew_rate: held(speed_top(spec), follow.skew_rate_bits, fp),
        skew: held(skew_top(spec), follow.skew_bits, f + 6),
        sine_phase: Quantiser::truncating(Format::unsigned(sp, sp)),
        sine_modulo: [1, 2, words.sine_rows_log2 + 2]
            .map(|bits| Quantiser::wrapping(Format::unsigned(sp - bits, sp))),
        count: Quantiser::wrapping(Format::signed(spec.chip.count_bits, spec.chip.count_bits)),
        count_of_four: Quantiser::wrapping(Format::signed(2, spec.chip.count_bits)),
        theta: multiplied.theta,
        theta_bend: multiplied.bend,
        theta_cubic: multiplied.cubic,
        deviation: r.deviation.map(accumulator),
        // Two bits finer than the pair that they correct.
        remembered: r
            .deviation
            .map(|power| coarser(accumulator(power).format, f + 2)),
        gain_watched: coarser(accumulator(r.deviation[0]).format, 11),
        alpha_gradient: {
            let g = follow.sensitivity_fraction;
            Quantiser::saturating(Format::signed(g + 2, g))
        },
        gathered: {
            let (g, power) = (follow.gathered_fraction, gathered_power(spec));
            Quantiser::saturating(Format::signed(bits(1 + power + g as i32), g))
        },
        start_periods: counting_to(START_PERIODS),
        travel_samples: counting_to(travel_samples(spec)),
        step,
        level: Quantiser::saturating(Format::unsigned(follow.lock_level_bits, 0)),
        // Two bits even where one would do.
        loop_gear: counting_to(acquisition.gears.max(3)),
        gamma_gear: counting_to(spec.calibration.gears()),
        gear_periods: counting_to(periods(&spec.calibration).saturating_sub(1)),
        held_periods: {
            let unknown = spec.calibration.hold_unknown_periods();
            let known = if spec.calibration.recalls() {
                spec.calibration.hold_periods()
            } else {
                unknown
            };
            // Five bits even where fewer would do.
            counting_to(known.max(unknown).max(Calibration::HELD) - 1)
        },
        unlocked_samples: {
            let w = unlocked_bits(follow.lock_level_bits);
            Quantiser::wrapping(Format::unsigned(w, w))
        },
        failed_periods: counting_to(Calibration::FAILED),
    };
    Ok(Structure {
        method: match spec.tracking.method {
            1 => Method::One,
            2 => Method::Two,
            _ => Method::Three,
        },
        filter_type: spec.tracking.filter_type,
        calibration: spec.calibration.clone(),
        skew: spec.correction.has_skew().then_some(Order::Second),
        harmonics: harmonics::structure(spec, words, follow)?,
        offset_binary,
        formats,
        sine: sine_table(words, follow)?,
        loop_gears: acquisition.gears,
        amplitude_shift: amplitude_shift(spec),
        sparse: spec.is_sparse(),
        sparse_bends: spec.has_sparse_bends(),
    })
}

/// A quarter wave, each segment expanded about its centre; the value is lowered by half the error at the ends. It
/// carries the half bit that rounds the interpolated result.
fn sine_table(words: &Words, follow: &Followers) -> Result<Rom, DesignError> {
    let (rows, f) = (words.sine_rows_log2, words.signal_fraction);
    let segment = exp2(-i64::from(rows) - 2);
    let lower = 1.0 - (TAU * segment / 2.0).powi(2) / 4.0;
    let centre = |i: usize| TAU * segment * (i as f64 + 0.5);
    let values = (0..1usize << rows)
        .map(|i| centre(i).sin() * lower)
        .collect();
    let slopes = (0..1usize << rows).map(|i| TAU * centre(i).cos()).collect();
    let (value_fraction, slope_fraction) = (follow.sine_value_fraction, follow.sine_slope_fraction);
    let unfit = |row: usize| DesignError::Field {
        field: "formats.sine_rows_log2".into(),
        value: rows.to_string(),
        limit: "13".into(),
        reason: format!("row {row} of the sine table does not fit its word"),
    };
    Ok(Rom {
        name: "sine_table",
        address_bits: rows,
        index_fraction: rows + 2,
        columns: vec![
            Column::new(
                "value",
                Format::unsigned(value_fraction + 1, value_fraction),
                values,
                exp2(-i64::from(f) - 1),
            )
            .map_err(unfit)?,
            Column::new(
                "slope",
                Format::unsigned(slope_fraction + 3, slope_fraction),
                slopes,
                0.0,
            )
            .map_err(unfit)?,
        ],
    })
}

/// 256 times the full lock level: a signal that can be locked to is by then, many times over, and one that is stuck for less costs nothing.
pub(super) fn unlocked_bits(lock_level_bits: u32) -> u32 {
    lock_level_bits + 8
}
