//! Lines at a fixed frequency: hum in the channels, ripple of the amplitude, vibration of the axis.

use std::f64::consts::TAU;
use std::rc::Rc;

use crate::block::Block;
use crate::cause::{Candidate, Domain, Estimate, Exact, Make, Reads, polar};
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::library::{Fill, Library, Place, Shape, Use};
use crate::lines::{flattened, pair_spectrum, peak, two_spectra};
use crate::model::Residual;

/// Lowest frequency of a line, in cycles per recording: below, it is drift.
const SLOWEST: f64 = 4.0;

/// So many times what is near it in the spectrum, a line stands out of noise of any colour.
const STANDS_OUT: f64 = 40.0;
/// Samples between two evaluations of a line's sine; between them it is rotated on.
const ROTATED: usize = 64;
/// Share of a sample by which the time base may be off to be regular.
const REGULAR: f64 = 1e-3;

/// cos and sin of a line.
pub(crate) fn wave(hertz: f64) -> Fill {
    Rc::new(move |block, out| {
        let n = block.len();
        let (cos, sin) = out.split_at_mut(n);
        let first = block.time[0];
        let step = (block.time[n - 1] - first) / (n - 1).max(1) as f64;
        let regular = |(k, t): (usize, &f64)| (t - first - k as f64 * step).abs() < REGULAR * step;
        if !block.time.iter().enumerate().all(regular) {
            for (k, t) in block.time.iter().enumerate() {
                (sin[k], cos[k]) = (TAU * hertz * t).sin_cos();
            }
            return;
        }
        let (sin_step, cos_step) = (TAU * hertz * step).sin_cos();
        for from in (0..n).step_by(ROTATED) {
            let (mut s, mut c) = (TAU * hertz * (first + from as f64 * step)).sin_cos();
            for k in from..(from + ROTATED).min(n) {
                (cos[k], sin[k]) = (c, s);
                (c, s) = (c * cos_step - s * sin_step, s * cos_step + c * sin_step);
            }
        }
    })
}

/// cos and sin of a line in one channel, then in the other.
fn in_channels(hertz: f64, library: &mut Library) -> Vec<Shape> {
    let fill = wave(hertz);
    let pairs = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let mut waves = vec![0.0; 2 * n];
        fill(block, &mut waves);
        let (c, s) = out.split_at_mut(4 * n);
        for i in 0..4 {
            let at = i * n..(i + 1) * n;
            let change = &waves[(i % 2) * n..][..n];
            block.channel(i / 2, change, &mut c[at.clone()], &mut s[at]);
        }
    };
    let place = library.add(4, Use::Pairs, Rc::new(pairs));
    (0..4).map(|i| place.both(i)).collect()
}

fn two(place: Place, shape: fn(&Place, usize) -> Shape) -> Vec<Shape> {
    (0..2).map(|i| shape(&place, i)).collect()
}

pub(crate) fn candidates(
    context: &Context,
    residual: &Residual,
    coloured: bool,
    library: &mut Library,
) -> Vec<Candidate> {
    let n = context.samples();
    let trials = n as f64;
    let low = SLOWEST / n as f64;
    let mut list = vec![];
    let line = |power: Vec<f64>, length: usize| {
        if coloured {
            let level = flattened(&power);
            let f = peak(&level, length, low, 0.499)?;
            let highest = level[(f * length as f64).round() as usize];
            return (highest > STANDS_OUT).then_some(f);
        }
        peak(&power, length, low, 0.499)
    };
    // A line's frequency is known to a small part of one cycle per recording.
    let duration = n as f64 / context.rate;
    let exact = |hertz: f64, make: Make| {
        Some(Exact {
            make,
            inner: vec![hertz],
            steps: vec![0.02 / duration],
            follows: false,
        })
    };
    // In the frame of the channels.
    let frame = |k: usize| {
        let (r, t) = (residual.radial[k], residual.tangential[k]);
        let (c, s) = (context.cos[k], context.sin[k]);
        (r * c - t * s, r * s + t * c)
    };
    let (in_c, in_s): (Vec<f64>, Vec<f64>) = (0..n).map(frame).unzip();
    let (power, length) = pair_spectrum(&in_c, &in_s);
    if let Some(f) = line(power, length) {
        let hertz = f * context.rate;
        let mut all = vec![];
        for harmonics in [1, 3] {
            if harmonics > 1 && f * 3.0 > 0.49 {
                continue;
            }
            for harmonic in all.len() / 4 + 1..=harmonics {
                all.extend(in_channels(hertz * harmonic as f64, library));
            }
            let make: Make = Rc::new(move |inner, library| {
                (1..=harmonics)
                    .flat_map(|harmonic| in_channels(inner[0] * harmonic as f64, library))
                    .collect()
            });
            list.push(Candidate {
                trials,
                exact: exact(hertz, make),
                parameters: Rc::new(move |e| {
                    let (a_c, d_c, ..) = polar(&e.x[..2], &e.error[..2]);
                    let (a_s, d_s, ..) = polar(&e.x[2..4], &e.error[2..4]);
                    let strongest = a_c.hypot(a_s) / d_c.hypot(d_s).max(f64::MIN_POSITIVE);
                    let mut all = vec![frequency(e, strongest, duration)];
                    let pairs = e.x.chunks(2).zip(e.error.chunks(2)).enumerate();
                    for (i, (x, error)) in pairs {
                        let (a, d, p, ep) = polar(x, error);
                        let channel = ["cos", "sin"][i % 2];
                        let harmonic = match i / 2 {
                            0 => String::new(),
                            more => format!("_{}", more + 1),
                        };
                        let name = |what: &str| format!("{what}_{channel}{harmonic}");
                        all.push(Parameter::measured(&name("amplitude"), a, d, "amplitude"));
                        all.push(Parameter::measured(&name("phase"), p, ep, "rad"));
                    }
                    all
                }),
                evidence: Rc::new(move |p| {
                    let with = if harmonics > 1 { " and its harmonics" } else { "" };
                    format!("a line at {:.3} Hz{with} is added to the channels, {:.3} % (cos) and {:.3} % (sin) of the amplitude", p[0].value, p[1].value * 100.0, p[3].value * 100.0)
                }),
                ..Candidate::new("interference", Domain::Line, all.clone())
            });
        }
    }
    let ([radial, fast], length) = two_spectra(&residual.radial, residual.fast());
    if let Some(f) = line(radial, length) {
        let hertz = f * context.rate;
        let make: Make = Rc::new(|inner, library| {
            two(library.add(2, Use::Radial, wave(inner[0])), Place::radial)
        });
        let shapes = make(&[hertz], library);
        list.push(Candidate {
            trials,
            exact: exact(hertz, make),
            parameters: one_wave("depth", "1", duration),
            evidence: Rc::new(|p| {
                format!(
                    "the amplitude of both channels is modulated by {:.3} % at {:.3} Hz",
                    p[1].value * 100.0,
                    p[0].value
                )
            }),
            ..Candidate::new("amplitude_ripple", Domain::Line, shapes)
        });
    }
    if let Some(f) = line(fast, length) {
        let hertz = f * context.rate;
        let make: Make = Rc::new(|inner, library| {
            two(
                library.add(2, Use::Motion, wave(inner[0])),
                Place::tangential,
            )
        });
        let shapes = make(&[hertz], library);
        list.push(Candidate {
            trials,
            motion: true,
            exact: exact(hertz, make),
            chip: Chip::NotASensorError,
            parameters: one_wave("amplitude", "rad", duration),
            evidence: Rc::new(|p| format!("the axis really vibrates: {:.3e} rad of a scale period at {:.3} Hz, without any change of the radius", p[1].value, p[0].value)),
            ..Candidate::new("vibration", Domain::Motion, shapes)
        });
    }
    list
}

/// Frequency, amplitude and phase of a line without harmonics.
fn one_wave(amplitude: &'static str, unit: &'static str, duration: f64) -> Reads {
    Rc::new(move |e| {
        let (a, d, p, ep) = polar(e.x, e.error);
        vec![
            frequency(e, a / d, duration),
            Parameter::measured(amplitude, a, d, unit),
            Parameter::measured("phase", p, ep, "rad"),
        ]
    })
}

/// A frequency: its error is that of the fit, or the Cramér–Rao bound for a line of that signal-to-noise ratio.
fn frequency(e: &Estimate, snr: f64, duration: f64) -> Parameter {
    let bound = 6f64.sqrt() / (std::f64::consts::PI * snr.max(1.0) * duration) / 2f64.sqrt();
    let error = e.inner_error.map_or(bound, |error| error[0]);
    Parameter::measured("frequency_hz", e.inner[0], error, "Hz")
}
