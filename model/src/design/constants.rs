//! Constants of a design.

use std::f64::consts::{SQRT_2, TAU};

use super::formats::{travel_samples, unlocked_bits};
use super::ranges::ranges;
use super::{Acquisition, Followers, Loop, Words, normalisation, skew};
use crate::format::{Format, exp2};
use crate::kernel::start::PERIODS as START_PERIODS;
use crate::kernel::{Coefficients, Constant, Structure};
use crate::spec::{Calibration, Spec};

/// What noise, bends and skew add to the pair before they are corrected, amplitudes.
fn disturbances(spec: &Spec) -> f64 {
    let s = &spec.sensor;
    let bends = if spec.calibration.has_bend() {
        2.0 * s.bend_max
    } else {
        0.0
    };
    5.0 * s.noise_rms + bends + skew::phase_max(spec) / 2.0
}

/// Phase errors up to here are those of a loop in lock, radians. At top speed the loop follows nothing of an uncalibrated
/// pair's: gains turn it by sin 2α, offsets by a wave of the period, the phase by half of it and a wave of half the period.
/// Near its bandwidth it adds a fifth.
pub(super) fn lock_window(spec: &Spec) -> f64 {
    let s = &spec.sensor;
    let beta = s.phase_error_max_deg.to_radians();
    let turn = s.amplitude_tolerance + SQRT_2 * s.offset_max + 0.75 * beta + disturbances(spec);
    (1.2 * turn).clamp(0.35, 0.8)
}

/// Radial residuals up to here are those of a promised sensor, amplitudes.
fn lock_radius(spec: &Spec) -> f64 {
    let s = &spec.sensor;
    let beta = s.phase_error_max_deg.to_radians();
    let radius = 1.5 * s.offset_max + s.amplitude_tolerance + beta + disturbances(spec);
    (1.25 * radius).clamp(0.4, 0.9)
}

/// γ gear from which on bends by sums of squares are searched. What they leave in the radius while they rest (0.71 of the second order of
/// both channels, and all of the third) must not keep a gear from passing; where it could they are searched from the first one on.
fn bends_gear(spec: &Spec) -> u32 {
    let left = 1.71 * spec.sensor.bend_max + 6.0 * spec.sensor.noise_rms;
    if left < spec.calibration.restart_residual {
        spec.calibration.gears().min(Calibration::BENDS_GEAR)
    } else {
        0
    }
}

pub(super) fn constants(
    spec: &Spec,
    tracking: &Loop,
    acquisition: &Acquisition,
    (words, follow): (&Words, &Followers),
    structure: &Structure,
) -> Coefficients<Constant> {
    let (f, width) = (words.signal_fraction, follow.coefficient_bits);
    let whole = |n: i64| Constant::rounded(n as f64, 0);
    let p = words.sine_phase_bits;
    let half_bit = exp2(-i64::from(p) - 1);
    let half_segment = exp2(-i64::from(words.sine_rows_log2) - 3);
    let corrected = |value: f64, less: f64, fraction: u32| Constant {
        ideal: value,
        ..Constant::rounded(value - less, fraction)
    };
    let nominal = Constant::rounded(
        ranges(spec).nominal,
        structure.formats.theta[0].format.fraction,
    );
    let unlocked = unlocked_bits(follow.lock_level_bits);
    let full = (1i64 << follow.lock_level_bits) - 1;
    Coefficients {
        adc_middle: Constant::rounded(0.5, 1),
        loop_a: Constant::normalised(tracking.a, width, 40),
        loop_ab: Constant::normalised(tracking.ab, width, 40),
        loop_a_radians: Constant::normalised(tracking.a * TAU, width, 40),
        loop_ab_radians: Constant::normalised(tracking.ab * TAU, width, 40),
        loop_leak: Constant::normalised(1.0 - tracking.pole, width, 40),
        theta_1_nominal: nominal,
        theta_3_nominal: nominal,
        skew_delay: Constant::normalised(skew::delay(spec), width, 40),
        nominal_amplitude: Constant::normalised(normalisation(spec).0, width, 40),
        turns_per_radian: Constant::normalised(1.0 / TAU, width, 40),
        quarter_turn: corrected(0.25, 2.0 * half_bit, p),
        half_bit: Constant {
            ideal: 0.0,
            ..Constant::rounded(half_bit, p + 1)
        },
        half_segment: Constant::rounded(half_segment, words.sine_rows_log2 + 3),
        half_harmonic_segment: Constant::rounded(
            exp2(-i64::from(words.harmonic_rows_log2) - 1),
            words.harmonic_rows_log2 + 1,
        ),
        // Limits of few bits make short comparators.
        lock_error: Constant::rounded(lock_window(spec), 4),
        lock_residual: Constant::rounded(lock_radius(spec), 4),
        lock_radius: Constant::rounded(1.0 - lock_radius(spec), 4),
        lock_opposite: Constant::rounded(2.0 - lock_radius(spec), 4),
        weak_signal: Constant::rounded(0.25, 2),
        restart_residual: Constant::rounded(spec.calibration.restart_residual, f.min(8)),
        hold_residual: Constant::rounded(spec.hold_residual(), f.min(8)),
        // A power of two makes a short comparator.
        steady_gain: Constant::rounded(exp2(spec.steady_gain().log2().ceil() as i64), f.min(10)),
        gain_near_bound: near_bound(structure.formats.deviation[0].format),
        bend_near_bound: near_bound(structure.formats.deviation[7].format),
        // At exactly eight they learn: between seven and eight. Few bits make a short comparator.
        bend_rate: Constant::rounded(Calibration::BEND_RATE, 7),
        sparse_rate: Constant::rounded(Calibration::SPARSE_RATE, 5),
        sparse_bends_rate: Constant::rounded(Calibration::SPARSE_BENDS_RATE, 7),
        direction_rate: Constant::rounded(exp2(-i64::from(f)), words.phase_bits),
        lock_down: whole(-8),
        lock_full: whole(full),
        lock_restart: whole(full / 2),
        loop_gear_last: whole(acquisition.gears.into()),
        small_error: Constant::rounded(spec.small_error(), f.min(8)),
        far_error: Constant::rounded(spec.far_error(), f.min(8)),
        travel_samples_last: whole(travel_samples(spec).into()),
        gamma_gear_bends: whole(bends_gear(spec).into()),
        gamma_gear_settled: whole(spec.calibration.settled_gears().into()),
        gamma_gear_last: whole(structure.calibration.gears().into()),
        gear_periods_last: whole(i64::from(spec.calibration.gear_periods()) - 1),
        held_periods_last: whole(i64::from(spec.calibration.hold_unknown_periods()) - 1),
        unlocked_sample: Constant::rounded(exp2(-i64::from(unlocked)), unlocked),
        unlocked_samples_last: Constant::rounded(1.0 - exp2(-i64::from(unlocked)), unlocked),
        failed_periods_last: whole(Calibration::FAILED.into()),
        returning_periods: whole(spec.calibration.returning_periods().into()),
        hold_periods_last: whole(i64::from(spec.calibration.hold_periods()) - 1),
        start_periods_last: whole(START_PERIODS.into()),
        start_period: Constant::rounded(62.0 / 64.0, 6),
        unit_radius: corrected(1.0, exp2(-i64::from(f) - 1), f + 1),
        zero: whole(0),
        one: whole(1),
        half: Constant::rounded(0.5, 1),
        quarter: Constant::rounded(0.25, 2),
    }
}

/// Fifteen sixteenths of what a parameter may be away from its nominal value.
fn near_bound(deviation: Format) -> Constant {
    let power = i64::from(deviation.width) - 1 - i64::from(deviation.fraction);
    Constant::rounded(15.0 / 16.0 * exp2(power), (4 - power).max(0) as u32)
}
