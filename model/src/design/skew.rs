//! Correction of channel skew: what may be asked, how far the series goes, and what it leaves.

use std::f64::consts::TAU;

use super::promised::{Promised, errors, promised};
use super::refuse::{between, number, refuse};
use super::{Budget, DesignError, Loop};
use crate::kernel::skew::{Order, correct};
use crate::kernel::{Coefficients, Constant, Structure};
use crate::spec::Spec;

/// Largest phase that the skew may make at the design's largest speed, radians. There the second order leaves an error of
/// the sine of some κ³/12, 1.5e-3, which is 2.4e-4 of a period at most: more than that is no correction. And the error before lock,
/// where nothing is corrected yet, stays at a third of the lock window.
pub const PHASE_MAX: f64 = 0.25;

/// The correction of channel skew in numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skew {
    /// How far the series goes: as far as what it leaves at the largest speed would be more than arithmetic may add.
    pub order: Order,
    /// The phase of the delay as asked for, radians per turn of speed and sample.
    pub delay: f64,
    /// The delay that the chip has, seconds.
    pub delay_quantised_s: f64,
    /// κ at the largest speed, radians.
    pub phase_max: f64,
    /// Largest error of the corrected sine at the largest speed, over what the design promises of phase and, where that is
    /// calibrated, amplitude; amplitudes.
    pub sine_error_max: f64,
    /// Angle error at the largest speed with the correction, at worst over the same, periods rms.
    pub residual_rms_periods: f64,
    /// And without it.
    pub uncorrected_rms_periods: f64,
}

/// The phase κ of the delay, radians per turn of speed and sample.
pub(super) fn delay(spec: &Spec) -> f64 {
    TAU * spec.correction.channel_skew_s * spec.adc.sample_rate_hz
}

/// κ at the largest speed, radians.
pub(super) fn phase_max(spec: &Spec) -> f64 {
    (delay(spec) * spec.sensor.speed_max_periods_per_s / spec.adc.sample_rate_hz).abs()
}

/// Refuses a delay that the chip cannot correct.
pub(super) fn check(spec: &Spec, tracking: &Loop) -> Result<(), DesignError> {
    if !spec.correction.has_skew() {
        return Ok(());
    }
    let delay = spec.correction.channel_skew_s;
    let field = "correction.channel_skew_s";
    let sample = 1.0 / spec.adc.sample_rate_hz;
    between(
        field,
        delay,
        -sample,
        sample,
        "more than a sample is a shift of the data: take the sine of another sample",
    )?;
    if phase_max(spec) > PHASE_MAX {
        let limit = PHASE_MAX / TAU / spec.sensor.speed_max_periods_per_s;
        return refuse(
            field,
            number(delay),
            format!("±{limit:.3e} at this largest speed"),
            format!(
                "at sensor.speed_max_periods_per_s the sine would run {:.2} rad ahead, and the series that turns it back \
                 holds to {PHASE_MAX} rad",
                phase_max(spec)
            ),
        );
    }
    if !steady(tracking, 1.5 * delay * spec.adc.sample_rate_hz) {
        return refuse(
            field,
            number(delay),
            "nearer to 0, or a narrower loop",
            "the correction follows the loop's own speed, and with a loop as wide as this one both would swing",
        );
    }
    Ok(())
}

/// Whether the loop settles where its phase error falls by `delay` (samples) times its increment: where the sine counts in
/// full. Jury's conditions for z (z − 1)(z − p) + (g (z − 1) + h)((1 + d) z − d).
fn steady(tracking: &Loop, delay: f64) -> bool {
    let (g, h, p) = (TAU * tracking.a, TAU * tracking.ab, tracking.pole);
    let square = g * (1.0 + delay) - 1.0 - p;
    let linear = p + (h - g) * (1.0 + delay) - g * delay;
    let constant = (g - h) * delay;
    let at_one = 1.0 + square + linear + constant;
    let at_minus_one = 1.0 - square + linear - constant;
    at_one > 0.0
        && at_minus_one > 0.0
        && constant.abs() < 1.0
        && (constant * constant - 1.0).abs() > (constant * square - linear).abs()
}

/// Angles at which what is left is looked at.
const ANGLES: u32 = 64;

/// Largest error of the sine and rms angle error (radians) at the largest speed, at worst: the kernel itself, unrounded.
/// `None` in place of an order: no correction.
fn left(
    order: Option<Order>,
    spec: &Spec,
    structure: &Structure,
    k: &Coefficients<f64>,
) -> (f64, f64) {
    let fastest = phase_max(spec);
    let either_way = promised(spec, structure, k).flat_map(|p| [(p, -fastest), (p, fastest)]);
    let each = either_way.map(|(Promised { tan, thetas }, skew)| {
        errors(ANGLES, |_, c, sin| {
            let late =
                (skew.cos() + tan * skew.sin()) * sin + (skew.sin() + tan * (1.0 - skew.cos())) * c;
            let s = order.map_or(late, |order| {
                correct((c, late), (order, skew), thetas, k, structure)
            });
            (c, s)
        })
    });
    each.fold((0.0, 0.0), |all, one| (all.0.max(one.0), all.1.max(one.1)))
}

/// Settles how far the series goes: the structure carries the second order where the first leaves more than arithmetic may
/// add.
pub(super) fn settle(
    spec: &Spec,
    budget: &Budget,
    structure: &mut Structure,
    constants: &Coefficients<Constant>,
) -> Option<Skew> {
    structure.skew?;
    let k = constants.real();
    let first = left(Some(Order::First), spec, structure, &k);
    let (order, found) = if first.1 / TAU > budget.allowed {
        let second = left(Some(Order::Second), spec, structure, &k);
        (Order::Second, second)
    } else {
        (Order::First, first)
    };
    structure.skew = Some(order);
    let without = left(None, spec, structure, &k);
    Some(Skew {
        order,
        delay: delay(spec),
        delay_quantised_s: constants.skew_delay.value() / TAU / spec.adc.sample_rate_hz,
        phase_max: phase_max(spec),
        sine_error_max: found.0,
        residual_rms_periods: found.1 / TAU,
        uncorrected_rms_periods: without.1 / TAU,
    })
}
