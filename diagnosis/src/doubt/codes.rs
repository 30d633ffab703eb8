//! Errors that the codes themselves make, and what is found beside them. A bit that is stuck, steps that are coarse, and an ADC
//! whose noise is smaller than its code all err by the signal: at an even speed that is a comb of lines, at any other it is a
//! pattern of the period. What is smaller than that error says nothing about the sensor.

use std::f64::consts::{PI, TAU};

use nonius_quantity::{Quantity, Unit};
use nonius_recording::AdcSource;

use crate::causes::candidate::Domain;
use crate::causes::speed_varies;
use crate::context::Context;
use crate::doubt::{SLOW_DOMAINS, gain_of};
use crate::finding::{Cause, Finding};
use crate::model::System;
use crate::select::selection::Selection;

/// A code's error changes so often within a period that hardly any of it is of a low order: of steps of an amplitude's share
/// q, so many times √q of it (a sine's turning points alone stay within one step for long).
const OF_LOW_ORDER: f64 = 2.0;
/// Static errors beside the errors of the codes, each smaller than those: more of them are their doing.
const MANY: usize = 2;
/// Lines of the spectrum by which a line may be off an order of the signals.
const NEAR: f64 = 2.0;
/// Share of the noise from which on what the codes do to it is seen in it.
const IN_NOISE: f64 = 0.3;

/// Rms error of the codes, in amplitudes.
#[derive(Clone, Copy, Default)]
struct Error {
    /// All of it.
    whole: f64,
    /// What of it is of a low order, and what stands at one frequency where the speed varies.
    low: f64,
    /// Codes between two jumps of it, in amplitudes.
    step: f64,
}

impl Error {
    fn new(step: f64, rms: f64) -> Self {
        let low = (OF_LOW_ORDER * step.sqrt()).min(1.0);
        Self {
            whole: step * rms,
            low: step * rms * low,
            step,
        }
    }

    fn or(self, other: Self) -> Self {
        if other.whole > self.whole {
            other
        } else {
            self
        }
    }
}

/// Of even steps without noise: a bit that is lost half of the time makes one of half a step.
fn even() -> f64 {
    12f64.sqrt().recip()
}

/// What of the steps' error noise leaves: the mean of a code is a straight line once noise carries samples over its edges.
fn quiet(step: f64, noise: f64) -> Error {
    let own = (noise * noise - step * step / 12.0).max(0.0);
    Error::new(step, even() * (-2.0 * PI * PI * own / (step * step)).exp())
}

/// The largest of the errors that the checks found.
fn known(system: &System, digital: &[Finding]) -> Error {
    let context = system.context;
    let lsb = context.adc.cos.lsb.max(context.adc.sin.lsb) / context.ellipse.amplitude();
    let error = |f: &Finding| {
        Some(match f.cause {
            Cause::StuckBit => Error::new(lsb * 2f64.powf(f.parameter("bit")?), 0.5),
            Cause::CoarseQuantisation => Error::new(lsb * f.parameter("step_lsb")?, even()),
            // So many of the codes of a channel, which are two amplitudes, are off by one.
            Cause::AdcNonlinearity => {
                let share = f.parameter("missing_codes")? * lsb / 2.0;
                Error::new(lsb, share.min(1.0).sqrt())
            }
            _ => return None,
        })
    };
    let all = digital.iter().filter_map(error);
    all.fold(Error::default(), Error::or)
}

/// Whether a frequency is an order of the signals, of those that steps of a share of the amplitude make, beyond half the sample
/// rate, too. Where the speed varies, none is.
fn is_an_order(context: &Context, hertz: f64, step: f64) -> bool {
    let n = context.samples() as f64;
    let (Some(first), Some(last)) = (context.alpha.first(), context.alpha.last()) else {
        return false;
    };
    if speed_varies(context) {
        return false;
    }
    let own = (last - first).abs() / TAU / (n - 1.0) * context.rate;
    let width = NEAR * context.rate / n;
    // A sine passes so many edges per period at its steepest.
    let most = (TAU / step.max(1e-4)).min(n) as u32;
    (1..=most).any(|order| {
        let at = f64::from(order) * own;
        let off = (at - context.rate * (at / context.rate).round()).abs();
        (off - hertz).abs() < width
    })
}

/// Whether the axis stands so long that the error of one code after the other goes on for many samples: then it is slow.
fn rests(context: &Context, step: f64) -> bool {
    /// Samples on one code.
    const MANY: f64 = 20.0;
    /// Share of the recording.
    const SHARE: f64 = 0.05;
    let stands = |speed: &&f64| speed.abs() / context.rate * MANY < step;
    let standing = context.speed.iter().filter(stands).count();
    standing as f64 > SHARE * context.samples() as f64
}

/// What a cause explains; motion is not seen in the radius, which is all that is sure where the axis vibrates.
fn gain(system: &System, found: &Selection, i: usize) -> f64 {
    let own = &found.accepted[i];
    if own.candidate.domain != Domain::Motion {
        return gain_of(system, found, &[i]);
    }
    let mut others = found.fit.shapes.clone();
    others.drain(own.range());
    found.fit.solution.gain() - system.fit(others).solution.gain()
}

/// Takes names back that are smaller than the error of the codes and may be its doing, and what has no name likewise: that error
/// is in the data as it is. A sentence that says so, where anything was.
pub(crate) fn beside(
    system: &System,
    found: &mut Selection,
    digital: &[Finding],
) -> Option<String> {
    let context = system.context;
    let known = known(system, digital);
    let quiet = quiet(context.code(), system.noise());
    // Values that show no steps are none.
    let stepped = context.adc.cos.source != AdcSource::Assumed;
    let error = if stepped && quiet.whole > IN_NOISE * system.noise() {
        quiet.or(known)
    } else {
        known
    };
    if error.whole == 0.0 {
        return None;
    }
    let slow = if rests(context, error.step) {
        error.whole
    } else {
        error.low
    };
    let all = 0..found.accepted.len();
    let sizes: Vec<f64> = all.map(|i| system.size(gain(system, found, i))).collect();
    let repeats = |i: usize| found.accepted[i].candidate.domain.home() == Domain::Angle;
    // Many at once are the pattern that lost codes make. A quiet ADC loses none, and a sensor may have many harmonics.
    let small = (0..sizes.len()).filter(|i| repeats(*i) && sizes[*i] < known.whole);
    let many = small.count() > MANY;
    let limit = |i: usize| {
        let candidate = &found.accepted[i].candidate;
        let ordered = match candidate.domain {
            Domain::Line | Domain::Motion => candidate
                .inner()
                .is_some_and(|hertz| is_an_order(context, hertz, error.step)),
            _ => false,
        };
        // The last step before the turning point stands out as a flat top does.
        let flat = candidate.name == Cause::Saturation;
        if ordered || flat {
            error.whole
        } else if SLOW_DOMAINS.contains(&candidate.domain) || candidate.domain == Domain::Line {
            slow
        } else if many && repeats(i) {
            known.whole.max(error.low)
        } else {
            error.low
        }
    };
    let taken: Vec<usize> = (0..sizes.len()).filter(|i| sizes[*i] < limit(*i)).collect();
    for i in &taken {
        found.accepted[*i].doubted = true;
    }
    let before = found.unnamed.len() + found.left.len();
    found.unnamed.retain(|u| system.size(u.gain) > error.whole);
    found.left.retain(|u| system.size(u.gain) > error.whole);
    if error.whole > IN_NOISE * system.noise() {
        (found.coded, found.coded_slowly) = (error.whole, slow);
    }
    let dropped = before - found.unnamed.len() - found.left.len();
    (dropped + taken.len() > 0).then(|| {
        let rms = Quantity::rounded(error.whole, 2, Unit::Percent).brief();
        format!("the codes err by {rms} of the amplitude rms, and what is smaller than that and may be their doing has no name")
    })
}
