//! What was found to repeat with the scale period, as the chip's table of harmonics has it.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nonius_diagnosis::{Cause, Chip, Diagnosis, Finding, OTHER_ORDER, VAGUE};
use nonius_model::design::ORDER_MAX;
use nonius_model::spec::Harmonic;
use nonius_quantity::ordinal;

use super::Outcome;

/// Phase by which a harmonic may miss that of a bend, radians.
const PHASE: f64 = 0.3;

/// A channel with less than this part of the other's amplitude does not say whether a harmonic is a bend.
const FAINT: f64 = 0.2;

/// Real and imaginary part of amplitude · exp(i phase), of the cosine and of the sine channel.
type Pair = [[f64; 2]; 2];

/// Amplitude and phase.
type Wave = (f64, f64);

/// Largest coefficient of T2 or T3 in either channel, as a fraction of the amplitude, where the finding is a bend. A
/// harmonic of order 2 or 3 is one where its phase is that of the channel's power: the chip mends both alike.
pub(super) fn bend(finding: &Finding, beta: f64) -> Option<f64> {
    let of = |name: &str| finding.parameter(name);
    if of(OTHER_ORDER).is_some() || finding.chip == Chip::CannotCorrect {
        return None;
    }
    let largest = |a: Option<f64>, b: Option<f64>| Some(a?.abs().max(b?.abs()));
    match finding.cause {
        // u² = (1 + T2)/2 and u³ = (3 u + T3)/4.
        Cause::EvenNonlinearity => Some(largest(of("k_cos"), of("k_sin"))? / 2.0),
        Cause::OddNonlinearity => Some(largest(of("k_cos"), of("k_sin"))? / 4.0),
        Cause::SpatialHarmonic => {
            let order = of("order")?;
            if order != 2.0 && order != 3.0 {
                return None;
            }
            let (cos, sin) = (of("amplitude_cos")?, of("amplitude_sin")?);
            let fits = |amplitude: f64, phase: f64, of_bend: f64| {
                let off = phase - of_bend;
                let off = off - PI * (off / PI).round();
                off.abs() < PHASE || amplitude < FAINT * cos.max(sin)
            };
            let bent = fits(cos, of("phase_cos")?, 0.0)
                && fits(sin, of("phase_sin")?, sine_phase(order, beta));
            bent.then_some(cos.max(sin))
        }
        _ => None,
    }
}

/// Whether a bend is one of third order.
pub(super) fn is_of_third_order(bend: &Finding) -> bool {
    bend.cause == Cause::OddNonlinearity || bend.parameter("order") == Some(3.0)
}

/// Phase of T2 and T3 of the sine channel: they are −cos 2 and −sin 3 of the angle less the phase error.
fn sine_phase(order: f64, beta: f64) -> f64 {
    let quarter = if order == 3.0 { FRAC_PI_2 } else { 0.0 };
    quarter - order * beta
}

/// What the finding adds to the channels, by order; nothing where it does not repeat with the scale period.
fn waves(finding: &Finding, beta: f64, whole_revolution: bool) -> Vec<(u32, Wave, Wave)> {
    let of = |name: &str| finding.parameter(name).unwrap_or(0.0);
    let order = of("order");
    match finding.cause {
        Cause::SpatialHarmonic => vec![(
            order as u32,
            (of("amplitude_cos"), of("phase_cos")),
            (of("amplitude_sin"), of("phase_sin")),
        )],
        // cos² = (1 + cos 2)/2, sin² = (1 − cos 2)/2.
        Cause::EvenNonlinearity => vec![(
            2,
            (of("k_cos") / 2.0, 0.0),
            (-of("k_sin") / 2.0, sine_phase(2.0, beta)),
        )],
        // cos³ = (3 cos + cos 3)/4, sin³ = (3 sin − sin 3)/4.
        Cause::OddNonlinearity => vec![(
            3,
            (of("k_cos") / 4.0, 0.0),
            (of("k_sin") / 4.0, sine_phase(3.0, beta)),
        )],
        // The angle is off by ε = amplitude · cos(order α + phase): −ε sin α and ε cos α.
        Cause::GraduationError if whole_revolution && order >= 3.0 => {
            let (half, phase) = (of("amplitude") / 2.0, of("phase"));
            [(1.0, FRAC_PI_2), (-1.0, -FRAC_PI_2)]
                .map(|(beside, turned)| {
                    let order = (order + beside) as u32;
                    (order, (half, phase + turned), (half, phase))
                })
                .into()
        }
        _ => vec![],
    }
}

/// Amplitudes of the finding with standard errors that are too large for a correction.
fn unsure(finding: &Finding) -> bool {
    let amplitudes = finding
        .parameters
        .iter()
        .filter(|p| p.unit != "1" && !p.name.starts_with("phase"));
    let (value, error) = amplitudes.fold((0.0f64, 0.0f64), |(value, error), p| {
        (value.hypot(p.value), error.hypot(p.std_error))
    });
    error.is_nan() || value.is_nan() || error > VAGUE * value
}

/// A table of harmonics.
pub(super) struct Harmonics {
    /// By order.
    pub(super) entries: Vec<Harmonic>,
    /// The findings that it corrects, by their place in the list.
    pub(super) findings: Vec<usize>,
    /// What is not in it because it is not measured well enough.
    pub(super) left_out: Vec<Outcome>,
}

/// The table for what was found and what no bend mends; `bends`: the design has parameters for those.
pub(super) fn table(found: &Diagnosis, bends: bool) -> Harmonics {
    let beta = found.context.ellipse.beta;
    let whole = found.context.periods_per_revolution == Some(1);
    let mut orders: BTreeMap<u32, Pair> = BTreeMap::new();
    let mut left_out = vec![];
    let mut findings = vec![];
    for (k, finding) in found.findings.iter().enumerate() {
        let waves = waves(finding, beta, whole);
        let mended = bends && bend(finding, beta).is_some();
        if waves.is_empty() || mended || finding.chip == Chip::CannotCorrect {
            continue;
        }
        // By the wrong one the angle would be twice as wrong.
        if let Some(other) = finding.parameter(OTHER_ORDER) {
            let why = format!(
                "the {} is not in the table of harmonics: it may be the {} harmonic as well, which errs the other way",
                finding.plain_name(),
                ordinal(other as usize)
            );
            left_out.push(Outcome::said(why, vec![k]));
            continue;
        }
        if unsure(finding) {
            let why = format!(
                "the {} is not in the table of harmonics: its standard error is more than a third of it",
                finding.plain_name()
            );
            left_out.push(Outcome::impossible(why, vec![k]));
            continue;
        }
        findings.push(k);
        for (order, cos, sin) in waves {
            if !(2..=ORDER_MAX).contains(&order) {
                continue;
            }
            let sum = orders.entry(order).or_default();
            for (sum, (amplitude, phase)) in sum.iter_mut().zip([cos, sin]) {
                sum[0] += amplitude * phase.cos();
                sum[1] += amplitude * phase.sin();
            }
        }
    }
    let list = orders.into_iter().map(|(order, pair)| {
        let [(amplitude_cos, phase_cos), (amplitude_sin, phase_sin)] =
            pair.map(|[re, im]| (short(re.hypot(im), 1e-6), short(im.atan2(re) % TAU, 1e-4)));
        Harmonic {
            order,
            amplitude_cos,
            phase_cos,
            amplitude_sin,
            phase_sin,
        }
    });
    Harmonics {
        entries: list.collect(),
        findings,
        left_out,
    }
}

/// Rounded to a multiple of `step`, as short as it can be written.
fn short(value: f64, step: f64) -> f64 {
    let per_one = (1.0 / step).round();
    (value * per_one).round() / per_one + 0.0
}
