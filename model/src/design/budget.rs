//! Word lengths by analysis: the shortest words whose errors together keep to the budget.

use std::f64::consts::TAU;

use super::followers::Followers;
use super::limits::BUDGET;
use super::refuse::{between, number, refuse};
use super::{DesignError, Loop, harmonics, normalisation, word};
use crate::format::exp2;
use crate::spec::{Overrides, Spec};

/// The word lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Words {
    /// Fraction bits of the signals.
    pub signal_fraction: u32,
    /// Bits of the phase and its increments.
    pub phase_bits: u32,
    /// Bits of the phase in the sine.
    pub sine_phase_bits: u32,
    /// log2 of the rows of the quarter-wave table.
    pub sine_rows_log2: u32,
    /// log2 of the rows of the table of harmonics, where there is one.
    pub harmonic_rows_log2: u32,
    /// Fraction bits of the parameter accumulators.
    pub accumulator_fraction: u32,
}

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
/// times mean square of ∂α/∂θ, over all parameters, in units of γ: offsets 1 · 1/2, gains 2 · 1/8, phase 8 · 3/8, and 16 · 3/8
/// in the final form before γ has settled; with bends the phase 4 · 3/8, even bends 1 · 1/4, the cubic one 1 · 1/2. Where
/// half of each gain's gradient is taken from the other's, their difference is worth half as much again.
fn calibration(spec: &Spec, adc_radians: f64) -> f64 {
    let c = &spec.calibration;
    let four = 2.0 * 0.5 + 2.0 * 2.0 / 8.0;
    let bends = 2.0 * 0.25 + 0.5;
    let steps = match c.parameters {
        0 => 0.0,
        4 if c.is_linear_final() => four + 2.0 / 8.0,
        4 => four,
        5 if c.is_linear_final() && !c.settles() => four + 16.0 * 3.0 / 8.0,
        5 => four + 8.0 * 3.0 / 8.0,
        8 => four + bends,
        _ => four + bends + 4.0 * 3.0 / 8.0,
    };
    let disturbs = spec.sensor.noise_rms.powi(2) + adc_radians.powi(2);
    let gamma = exp2(-i64::from(c.gamma_last));
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

fn terms(words: &Words, follow: &Followers, spec: &Spec, tracking: &Loop) -> Vec<Term> {
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
    list.extend(harmonics::terms(words, follow, spec));
    let of = |key: &&str| follow.term(key, words, spec, tracking);
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
    exp2(spec.calibration.gamma_last.into()) * dead_band(words.accumulator_fraction)
}

/// Largest error that may be asked for, periods rms.
pub(super) const RMS_MOST: f64 = 0.1;
/// Smallest part of it that arithmetic may have.
pub(super) const SHARE_LEAST: f64 = 1e-3;

/// Refuses an accuracy that ADC and noise leave no room for, in periods rms.
fn reachable(spec: &Spec, adc: f64, noise: f64) -> Result<(), DesignError> {
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

/// What is said in five digits is accepted.
const ROUNDED: f64 = 1.0001;

/// Where a word of the user's misses the budget, the others add no more than this.
const MUCH_AS_GOOD: f64 = 1.05;

/// Chooses the shortest words, one after the other, that keep the sum of all errors within what is allowed: first those of
/// the budget with followers as long as they can make worth it, then the followers.
pub(super) fn choose(
    spec: &Spec,
    tracking: &Loop,
) -> Result<(Words, Followers, Budget), DesignError> {
    word::plausible(spec)?;
    let (amplitude, power) = normalisation(spec);
    let adc = rounding(spec.adc.bits - 1 - power) / amplitude / TAU;
    let noise = spec.sensor.noise_rms / TAU * tracking.noise_gain.sqrt();
    let allowed = spec.accuracy.rms_periods * spec.accuracy.arithmetic_share;
    reachable(spec, adc, noise)?;
    let budget = |words: &Words, followers: &Followers| Budget {
        adc,
        noise,
        calibration: calibration(spec, adc * TAU),
        uncorrected: uncorrected(spec),
        allowed,
        terms: terms(words, followers, spec, tracking),
    };
    let followers = |words: &Words| Followers::generous(words, spec, tracking);
    let arithmetic = |words: &Words| budget(words, &followers(words)).arithmetic();
    let o = &spec.formats;
    let generous = |f: u32| Words {
        signal_fraction: f,
        phase_bits: o.phase_bits.unwrap_or(44),
        sine_phase_bits: o.sine_phase_bits.unwrap_or((f + 8).min(30)),
        sine_rows_log2: o.sine_rows_log2.unwrap_or(13),
        harmonic_rows_log2: o.harmonic_rows_log2.unwrap_or(harmonics::ROWS_LOG2_MAX),
        accumulator_fraction: o.accumulator_fraction.unwrap_or(44),
    };
    // What is missed with the longest words is missed because of a word that the user chose: then the others are as
    // long as adds little to that.
    let enough = if *o == Overrides::default() {
        allowed
    } else {
        let longest = generous(o.signal_fraction.unwrap_or(SIGNAL_FRACTION_MAX));
        allowed.max(MUCH_AS_GOOD * arithmetic(&longest))
    };
    // The first word is settled with the longest others: where even that is not enough, it is the accuracy that nothing meets.
    let too_fine = |longest: &Budget| {
        let most = longest.terms.iter();
        let most = most.max_by(|a, b| a.rms_periods.total_cmp(&b.rms_periods));
        refuse(
            "accuracy.rms_periods",
            number(spec.accuracy.rms_periods),
            format!(
                "at least {}",
                number(longest.arithmetic() / spec.accuracy.arithmetic_share * ROUNDED)
            ),
            format!(
                "accuracy.arithmetic_share leaves {allowed:.3e} periods rms of it to the arithmetic, which adds {:.3e} with the \
                 longest words that a chip may have; most of it: {}",
                longest.arithmetic(),
                most.map_or("", |term| term.source),
            ),
        )
    };
    let pick = |key: &str, before: &Words, set: &dyn Fn(u32) -> Words| {
        let (low, high) = limits(key, before);
        match o.given(key).map(|n| u32::try_from(n).unwrap_or(u32::MAX)) {
            Some(n) if (low..=high).contains(&n) => Ok(set(n)),
            Some(n) => refuse(
                format!("formats.{key}"),
                n,
                format!("{low} … {high}, with the others as they are"),
                BUDGET,
            ),
            None => (low..=high)
                .map(set)
                .find(|w| arithmetic(w) <= enough)
                .map_or_else(|| too_fine(&budget(&set(high), &followers(&set(high)))), Ok),
        }
    };
    let w = pick("signal_fraction", &generous(8), &generous)?;
    let w = pick("sine_rows_log2", &w, &|n| Words {
        sine_rows_log2: n,
        ..w
    })?;
    let w = pick("harmonic_rows_log2", &w, &|n| Words {
        harmonic_rows_log2: n,
        ..w
    })?;
    let w = pick("sine_phase_bits", &w, &|n| Words {
        sine_phase_bits: n,
        ..w
    })?;
    let w = pick("phase_bits", &w, &|n| Words { phase_bits: n, ..w })?;
    let words = pick("accumulator_fraction", &w, &|n| Words {
        accumulator_fraction: n,
        ..w
    })?;
    let followers = followers(&words).shortened(&words, spec, |shorter| {
        budget(&words, shorter).arithmetic() <= enough
    });
    Ok((words, followers, budget(&words, &followers)))
}

/// Most fraction bits of a signal.
const SIGNAL_FRACTION_MAX: u32 = 24;

/// What a word of the budget may be, with those that are settled before it as they are.
pub(super) fn limits(key: &str, w: &Words) -> (u32, u32) {
    match key {
        "signal_fraction" => (8, SIGNAL_FRACTION_MAX),
        "sine_rows_log2" => (4, 13),
        "harmonic_rows_log2" => (4, harmonics::ROWS_LOG2_MAX),
        "sine_phase_bits" => ((w.sine_rows_log2 + 3).max(w.harmonic_rows_log2 + 1), 30),
        "phase_bits" => (w.sine_phase_bits.max(w.signal_fraction + 3), 44),
        _ => (w.signal_fraction, 44),
    }
}
