//! What a recording cannot show whatever is in it, and the experiment that would.

use std::f64::consts::TAU;

use nonius_quantity::digits;
use nonius_recording::AdcSource;

use crate::causes::revolution::{revolving, turns};
use crate::causes::{direction, high_pass, speed, time};
use crate::context::{Context, FEWEST};
use crate::diagnose::Diagnosis;
use crate::finding::Cause;

/// Parts of the scale period in which samples are looked for, and how many of them have to be seen.
const PARTS: usize = 36;
const ALL_BUT_A_FEW: usize = 32;
/// Fewest scale periods, and fewest revolutions, that repeat themselves.
pub(crate) const REPEATS: f64 = 1.9;

/// A sentence for each group of causes that this recording cannot show: what lets a cause enter is asked of its own file.
#[must_use]
pub fn unseen(found: &Diagnosis) -> Vec<String> {
    let context = &found.context;
    let mut list: Vec<String> = vec![];
    let mut tell = |sentence: &str| list.push(sentence.into());
    if context.is_too_short() {
        let samples = context.samples();
        tell(&format!(
            "of {samples} samples, fewer than {FEWEST}, no cause is named but what codes and times themselves show; record more"
        ));
    }
    let travelled = context.periods_travelled();
    let seen = parts_seen(context);
    if seen < ALL_BUT_A_FEW {
        let share = digits(seen as f64 / PARTS as f64, 2) * 100.0;
        tell(&format!(
            "only {share:.0} % of the scale period was seen: offset, gain, phase and harmonics cannot be told apart; move over several periods"
        ));
    } else if travelled < REPEATS {
        tell(
            "within less than two scale periods, what repeats with the period and what changes with time are the same; move over several periods",
        );
    }
    if travelled > 0.0 && travelled < REPEATS {
        tell(
            "lines of fewer cycles than 32 for each scale period are not looked for within less than two; move over more of them",
        );
    }
    if !time::can_be_shown(context) {
        tell(
            "offset_drift, gain_drift and ac_coupling are not looked for within so few scale periods; move over more than six",
        );
    } else if !high_pass::can_be_shown(context) {
        tell("ac_coupling is not looked for within so few scale periods; move over more than six");
    }
    if !speed::varies(context) {
        tell(
            "at this constant speed, channel_skew, bandwidth_mismatch, common_bandwidth and delayed_crosstalk look like phase and gain errors, harmonics like lines, and amplitude_noise and clock_jitter like white noise; record several speeds",
        );
        if context.against_reference.is_some() {
            tell(
                "at this constant speed, a latency looks like the angle between the sensor and its reference; record several speeds",
            );
        }
    } else if !speed::both_can_be_shown(context) {
        tell(
            "at a speed that changes so little, common_bandwidth and delayed_crosstalk look like what a latency leaves; record several speeds",
        );
    }
    let turned = found.findings.iter().any(|f| f.cause == Cause::Hysteresis);
    if !turned && !direction::can_be_shown(context) {
        tell("in one direction, hysteresis looks like an offset; reverse");
    }
    if context.against_reference.is_none() {
        tell(
            "without a reference, latency and graduation_error look like motion; record a better instrument beside it",
        );
    }
    match &context.phi {
        None => tell(
            "without periods_per_revolution, runout, contamination and cogging are not looked for; give it if the axis turns",
        ),
        Some(_) if revolving(context).is_none() => tell(
            "within less than a revolution, runout, contamination and cogging are not looked for; turn further",
        ),
        Some(phi) if turns(phi) < REPEATS => tell(
            "within less than two revolutions, what repeats with the revolution and what changes with time are the same; turn further",
        ),
        Some(_) => {}
    }
    match context.adc.cos.source {
        AdcSource::Described => {}
        AdcSource::Estimated => tell(
            "without adc_bits and full_scale, a coarse step or a stuck last bit is taken for the ADC's own code; describe the ADC",
        ),
        AdcSource::Assumed => tell(
            "the values show no codes: stuck_bit and coarse_quantisation are not looked for; record the codes of the ADC",
        ),
    }
    list
}

/// Parts of the scale period in which there are samples.
fn parts_seen(context: &Context) -> usize {
    let mut seen = [false; PARTS];
    for angle in &context.alpha {
        let place = (angle / TAU).rem_euclid(1.0) * PARTS as f64;
        seen[(place as usize).min(PARTS - 1)] = true;
    }
    seen.iter().filter(|s| **s).count()
}
