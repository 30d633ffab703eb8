//! Lines at a fixed frequency: hum in the channels, ripple of the amplitude, vibration of the axis.

use crate::cause::{Candidate, Domain, channel, polar};
use crate::column::Shape;
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::lines::{pair_spectrum, peak, spectrum, wave};
use crate::model::Residual;

/// Lowest frequency of a line, in cycles per recording: below, it is drift.
const SLOWEST: f64 = 4.0;

pub(crate) fn candidates(context: &Context, residual: &Residual) -> Vec<Candidate> {
    let n = context.samples();
    let trials = n as f64;
    let low = SLOWEST / n as f64;
    let mut list = vec![];
    // In the frame of the channels.
    let frame = |k: usize| {
        let (r, t) = (residual.radial[k], residual.tangential[k]);
        let (c, s) = (context.cos[k], context.sin[k]);
        (r * c - t * s, r * s + t * c)
    };
    let (in_c, in_s): (Vec<f64>, Vec<f64>) = (0..n).map(frame).unzip();
    let (power, length) = pair_spectrum(&in_c, &in_s);
    if let Some(f) = peak(&power, length, low, 0.499) {
        for harmonics in [1, 3] {
            let hertz = f * context.rate;
            if harmonics > 1 && f * 3.0 > 0.49 {
                continue;
            }
            let mut shapes = vec![];
            for harmonic in 1..=harmonics {
                for which in [0, 1] {
                    for w in wave(&context.time, hertz * f64::from(harmonic)) {
                        shapes.push(channel(context, which, w));
                    }
                }
            }
            list.push(Candidate {
                name: "interference",
                domain: Domain::Line,
                trials,
                shapes,
                motion: false,
                refine: None,
                positive: false,
                chip: Chip::CannotCorrect,
                parameters: Box::new(move |e| {
                    let (a_c, d_c, p_c, e_c) = polar(&e.x[..2], &e.error[..2]);
                    let (a_s, d_s, p_s, e_s) = polar(&e.x[2..4], &e.error[2..4]);
                    let strongest = a_c.hypot(a_s) / d_c.hypot(d_s).max(f64::MIN_POSITIVE);
                    vec![
                        frequency(hertz, strongest, n, f),
                        Parameter::measured("amplitude_cos", a_c, d_c, "amplitude"),
                        Parameter::measured("phase_cos", p_c, e_c, "rad"),
                        Parameter::measured("amplitude_sin", a_s, d_s, "amplitude"),
                        Parameter::measured("phase_sin", p_s, e_s, "rad"),
                    ]
                }),
                evidence: Box::new(move |p| {
                    let with = if harmonics > 1 { " and its harmonics" } else { "" };
                    format!("a line at {:.3} Hz{with} is added to the channels, {:.3} % (cos) and {:.3} % (sin) of the amplitude", p[0].value, p[1].value * 100.0, p[3].value * 100.0)
                }),
            });
        }
    }
    let (power, length) = spectrum(&residual.radial);
    if let Some(f) = peak(&power, length, low, 0.499) {
        let hertz = f * context.rate;
        let shapes =
            wave(&context.time, hertz).map(|w| Shape::radial(&w, &context.cos, &context.sin));
        list.push(Candidate {
            name: "amplitude_ripple",
            domain: Domain::Line,
            trials,
            shapes: shapes.into(),
            motion: false,
            refine: None,
            positive: false,
            chip: Chip::CannotCorrect,
            parameters: Box::new(move |e| {
                let (a, d, p, ep) = polar(e.x, e.error);
                vec![
                    frequency(hertz, a / d, n, f),
                    Parameter::measured("depth", a, d, "1"),
                    Parameter::measured("phase", p, ep, "rad"),
                ]
            }),
            evidence: Box::new(|p| {
                format!(
                    "the amplitude of both channels is modulated by {:.3} % at {:.3} Hz",
                    p[1].value * 100.0,
                    p[0].value
                )
            }),
        });
    }
    let (power, length) = spectrum(&residual.motion);
    if let Some(f) = peak(&power, length, low, 0.499) {
        let hertz = f * context.rate;
        let shapes =
            wave(&context.time, hertz).map(|w| Shape::tangential(&w, &context.cos, &context.sin));
        list.push(Candidate {
            name: "vibration",
            domain: Domain::Motion,
            trials,
            shapes: shapes.into(),
            motion: true,
            refine: None,
            positive: false,
            chip: Chip::NotASensorError,
            parameters: Box::new(move |e| {
                let (a, d, p, ep) = polar(e.x, e.error);
                vec![
                    frequency(hertz, a / d, n, f),
                    Parameter::measured("amplitude", a, d, "rad"),
                    Parameter::measured("phase", p, ep, "rad"),
                ]
            }),
            evidence: Box::new(|p| format!("the axis really vibrates: {:.3e} rad of a scale period at {:.3} Hz, without any change of the radius", p[1].value, p[0].value)),
        });
    }
    list
}

/// A frequency with its Cramér–Rao error for a line of that signal-to-noise ratio.
fn frequency(hertz: f64, snr: f64, samples: usize, cycles_per_sample: f64) -> Parameter {
    let duration = samples as f64 * cycles_per_sample / hertz;
    let error = 6f64.sqrt() / (std::f64::consts::PI * snr.max(1.0) * duration) / 2f64.sqrt();
    Parameter::measured("frequency_hz", hertz, error, "Hz")
}
