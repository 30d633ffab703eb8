//! Where the angle error comes from, and what may come from arithmetic.

use std::f64::consts::TAU;

use super::lengths::{Followers, Lengths, Words};
use super::refuse::between;
use super::{DesignError, Loop, harmonics, normalisation};
use crate::format::exp2;
use crate::spec::Spec;

/// One source of error and what it adds to the angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// What it is.
    pub source: &'static str,
    /// Rms angle error in periods.
    pub rms_periods: f64,
}

/// Where the angle error comes from, at slow speed after calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// Quantisation by the ADC, periods rms.
    pub adc: f64,
    /// Noise of the sensor through the loop, periods rms.
    pub noise: f64,
    /// Noise of sensor and ADC that the calibration at its last γ lets into the parameters, periods rms.
    pub calibration: f64,
    /// What the design promises of the sensor and does not calibrate, at its worst, periods rms.
    pub uncorrected: f64,
    /// What arithmetic may add, periods rms.
    pub allowed: f64,
    /// What it adds, by source.
    pub terms: Vec<Term>,
}

impl Budget {
    /// What arithmetic adds altogether, periods rms.
    #[must_use]
    pub fn arithmetic(&self) -> f64 {
        self.terms
            .iter()
            .map(|t| t.rms_periods.powi(2))
            .sum::<f64>()
            .sqrt()
    }

    /// The whole error, periods rms.
    #[must_use]
    pub fn total(&self) -> f64 {
        let parts = [
            self.adc,
            self.noise,
            self.calibration,
            self.uncorrected,
            self.arithmetic(),
        ];
        parts.map(|part| part * part).iter().sum::<f64>().sqrt()
    }
}

/// A gradient search of step μ settles with a variance of μ/2 of what disturbs its error, here the radial residual. Step
/// times mean square of ∂α/∂θ, over all parameters, in units of γ, by [`Equaliser`](crate::kernel::step::Equaliser): in the final form
/// offsets 1 · 1/2, gains 2 · 1/8, phase 16 · 3/8 before γ has settled, then 4 · 3/8; with bends the phase 4 · 3/8, even bends 1 · 1/4, the
/// cubic one 1 · 1/2. Where half of each gain's gradient is taken from the other's, their difference is worth half as much again. The other searches
/// move gains and phase less: half or a quarter of that phase is more than they need.
fn calibration(spec: &Spec, adc_radians: f64) -> f64 {
    let c = &spec.calibration;
    let four = 2.0 * 0.5 + 2.0 * 2.0 / 8.0;
    let bends = 2.0 * 0.25 + 0.5;
    let steps = match c.parameters {
        0 => 0.0,
        4 if c.is_linear_final() => four + 2.0 / 8.0,
        4 => four,
        5 if c.phase_settles() => four + 4.0 * 3.0 / 8.0,
        5 if c.is_linear_final() => four + 16.0 * 3.0 / 8.0,
        5 => four + 8.0 * 3.0 / 8.0,
        8 => four + bends,
        _ => four + bends + 4.0 * 3.0 / 8.0,
    };
    let disturbs = spec.sensor.noise_rms.powi(2) + adc_radians.powi(2);
    let gamma = exp2(-i64::from(c.gamma_last()));
    (gamma * steps / 2.0 * disturbs).sqrt() / TAU
}

/// Errors of offset o, gain 1 ± m and phase β move the angle by o sin(α + …), m sin 2α and (β/2) cos 2α, beside a
/// constant.
fn uncorrected(spec: &Spec) -> f64 {
    let s = &spec.sensor;
    let (offset, gain) = if spec.calibration.is_on() {
        (0.0, 0.0)
    } else {
        (s.offset_max, s.amplitude_tolerance / 2f64.sqrt())
    };
    let phase = if spec.calibration.has_phase() {
        0.0
    } else {
        s.phase_error_max_deg.to_radians() / 8f64.sqrt()
    };
    (offset * offset + gain * gain + phase * phase).sqrt() / TAU
}

/// Rms of a value rounded to this many fraction bits.
pub(super) fn rounding(fraction: u32) -> f64 {
    exp2(-i64::from(fraction)) / 12f64.sqrt()
}

/// Rms of what dies below half the last of so many fraction bits: a value anywhere in that dead band.
pub(super) fn dead_band(fraction: u32) -> f64 {
    exp2(-i64::from(fraction) - 1) / 3f64.sqrt()
}

fn terms(all: &Lengths, spec: &Spec, tracking: &Loop) -> Vec<Term> {
    let Lengths { words, followers } = all;
    let f = words.signal_fraction;
    // Smallest change of the rate is half its last bit: errors below that die in the integrator.
    let rate = dead_band(words.phase_bits) / tracking.ab;
    let segment = TAU * exp2(-i64::from(words.sine_rows_log2) - 3);
    // The sine is rounded once more, and the gain that takes the second order off.
    let skew = rounding(f) * (0.5f64 + 0.125).sqrt();
    let mut list = vec![
        ("corrected signals", rounding(f)),
        ("sine table rounding", rounding(f)),
        (
            "sine table interpolation",
            segment * segment / 4.0 / 12f64.sqrt(),
        ),
        ("phase in the sine", TAU * rounding(words.sine_phase_bits)),
        ("phase error", rounding(f)),
        ("phase and its increments", rate),
        ("parameter accumulators", accumulator(words, spec)),
    ];
    if spec.correction.has_skew() {
        list.push(("channel skew", skew));
    }
    list.extend(harmonics::terms(words, followers, spec));
    let of = |key: &&str| followers.term(key, words, spec, tracking);
    list.extend(Followers::KEYS.iter().filter_map(of));
    list.into_iter()
        .map(|(source, radians)| Term {
            source,
            rms_periods: radians / TAU,
        })
        .collect()
}

/// Updates below half the last bit are lost: a dead band of the gradient.
fn accumulator(words: &Words, spec: &Spec) -> f64 {
    if !spec.calibration.is_on() {
        return 0.0;
    }
    exp2(spec.calibration.gamma_last().into()) * dead_band(words.accumulator_fraction)
}

/// Largest error that may be asked for, periods rms.
pub(super) const RMS_MOST: f64 = 0.1;
/// Smallest part of it that arithmetic may have.
pub(super) const SHARE_LEAST: f64 = 1e-3;

/// Refuses an accuracy that ADC and noise leave no room for, in periods rms.
pub(super) fn reachable(spec: &Spec, tracking: &Loop) -> Result<(), DesignError> {
    let (adc, noise) = given(spec, tracking);
    let (rms, share) = (spec.accuracy.rms_periods, spec.accuracy.arithmetic_share);
    let floor = adc.hypot(noise);
    let made = format!(
        "the ADC alone makes {adc:.3e} and the sensor's noise through this loop {noise:.3e} periods rms"
    );
    // What is left of it for arithmetic.
    let most = (1.0 - (floor / rms).powi(2)).max(0.0).sqrt();
    if share <= most {
        return Ok(());
    }
    if rms > floor && most >= SHARE_LEAST {
        return between(
            "accuracy.arithmetic_share",
            share,
            SHARE_LEAST,
            most,
            &format!("{made}: arithmetic has what they leave of accuracy.rms_periods"),
        );
    }
    // A share that is too large for that is refused next.
    let share = share.min(0.5);
    between(
        "accuracy.rms_periods",
        rms,
        floor / (1.0 - share * share).sqrt(),
        RMS_MOST,
        &format!("{made}; more ADC bits, a larger amplitude or a narrower loop would help"),
    )
}

/// Where the angle error of a chip with these words comes from.
pub(super) fn of(all: &Lengths, spec: &Spec, tracking: &Loop) -> Budget {
    let (adc, noise) = given(spec, tracking);
    Budget {
        adc,
        noise,
        calibration: calibration(spec, adc * TAU),
        uncorrected: uncorrected(spec),
        allowed: spec.accuracy.rms_periods * spec.accuracy.arithmetic_share,
        terms: terms(all, spec, tracking),
    }
}

/// What the ADC and the sensor's noise through the loop make of the angle, periods rms.
fn given(spec: &Spec, tracking: &Loop) -> (f64, f64) {
    let (amplitude, power) = normalisation(spec);
    let adc = rounding(spec.adc.bits - 1 - power) / amplitude / TAU;
    let noise = spec.sensor.noise_rms / TAU * tracking.noise_gain.sqrt();
    (adc, noise)
}
