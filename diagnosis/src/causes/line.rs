//! Lines at a fixed frequency: hum in the channels, ripple of the amplitude, vibration of the axis.

use std::f64::consts::TAU;
use std::rc::Rc;

use super::frequencies::{self, Line, Search};
use crate::causes::candidate::{Candidate, Domain, Estimate, Exact, Make, Reads, polar};
use crate::context::Context;
use crate::finding::{Cause, Chip, Parameter};
use crate::model::{Residual, Weighed};
use crate::numerics::lines::{spectrum, two_spectra};
use crate::shapes::block::Block;
use crate::shapes::library::{Fill, Library, Place, Shape, Use};

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

/// Shapes of a line in the channels: cos and sin in either.
const IN_CHANNELS: usize = 4;

/// cos and sin of a line in one channel, then in the other.
fn in_channels(hertz: f64, library: &mut Library) -> Vec<Shape> {
    let fill = wave(hertz);
    let pairs = move |block: &Block, out: &mut [f64]| {
        let n = block.len();
        let mut waves = vec![0.0; 2 * n];
        fill(block, &mut waves);
        let (c, s) = out.split_at_mut(IN_CHANNELS * n);
        for i in 0..IN_CHANNELS {
            let at = i * n..(i + 1) * n;
            let change = &waves[(i % 2) * n..][..n];
            block.channel(i / 2, change, &mut c[at.clone()], &mut s[at]);
        }
    };
    let place = library.add(IN_CHANNELS, Use::Pairs, Rc::new(pairs));
    (0..IN_CHANNELS).map(|i| place.both(i)).collect()
}

fn two(place: Place, shape: fn(&Place, usize) -> Shape) -> Vec<Shape> {
    (0..2).map(|i| shape(&place, i)).collect()
}

impl Search<'_> {
    /// A line of that name with its functions; its frequency is known to a small part of one cycle per recording.
    fn candidate(
        &self,
        name: Cause,
        domain: Domain,
        hertz: f64,
        make: Make,
        library: &mut Library,
    ) -> Candidate {
        Candidate {
            trials: self.trials(hertz),
            exact: Some(Exact {
                make: make.clone(),
                inner: vec![hertz],
                steps: vec![0.02 / self.duration()],
                follows: false,
            }),
            ..Candidate::new(name, domain, make(&[hertz], library))
        }
    }

    /// A line in the channels, and one with its harmonics.
    fn interference(&self, line: &Line, library: &mut Library) -> Vec<Candidate> {
        let f = line.f;
        let (hertz, duration) = (f * self.context.rate, self.duration());
        let reach = [1, 3].into_iter().filter(|m| *m == 1 || f * 3.0 <= 0.49);
        let one = |harmonics: usize, library: &mut Library| {
            let make: Make = Rc::new(move |inner, library| {
                (1..=harmonics)
                    .flat_map(|harmonic| in_channels(inner[0] * harmonic as f64, library))
                    .collect()
            });
            Candidate {
                by_radius: line.by_radius,
                parameters: in_either(duration),
                evidence: Rc::new(move |p| {
                    let with = if harmonics > 1 {
                        " and its harmonics are added to the channels, the fundamental with"
                    } else {
                        " is added to the channels, with"
                    };
                    format!(
                        "a line at {}{with} {} (cos) and {} (sin) of the amplitude",
                        p[0].brief(),
                        p[1].brief(),
                        p[3].brief()
                    )
                }),
                ..self.candidate(Cause::Interference, Domain::Line, hertz, make, library)
            }
        };
        reach.map(|harmonics| one(harmonics, library)).collect()
    }

    fn ripple(&self, f: f64, library: &mut Library) -> Candidate {
        let make: Make = Rc::new(|inner, library| {
            two(library.add(2, Use::Radial, wave(inner[0])), Place::radial)
        });
        let hertz = f * self.context.rate;
        Candidate {
            parameters: one_wave("depth", "1", self.duration()),
            evidence: Rc::new(|p| {
                format!(
                    "the amplitude of both channels is modulated by {} at {}",
                    p[1].brief(),
                    p[0].brief()
                )
            }),
            ..self.candidate(Cause::AmplitudeRipple, Domain::Line, hertz, make, library)
        }
    }

    fn vibration(&self, f: f64, library: &mut Library) -> Candidate {
        let make: Make = Rc::new(|inner, library| {
            two(
                library.add(2, Use::Motion, wave(inner[0])),
                Place::tangential,
            )
        });
        let hertz = f * self.context.rate;
        Candidate {
            motion: true,
            chip: Chip::NotASensorError,
            parameters: one_wave("amplitude", "rad", self.duration()),
            evidence: Rc::new(|p| {
                format!(
                    "the axis vibrates at {} with an amplitude of {} of electrical angle; the radius does not change",
                    p[0].brief(),
                    p[1].brief()
                )
            }),
            ..self.candidate(Cause::Vibration, Domain::Motion, hertz, make, library)
        }
    }
}

/// Whether it is a line with its harmonics.
pub(crate) fn has_harmonics(candidate: &Candidate) -> bool {
    candidate.name == Cause::Interference && candidate.shapes.len() > IN_CHANNELS
}

/// Whether a line has become as slow as a drift where its frequency was fitted.
pub(crate) fn crawls(context: &Context, candidate: &Candidate) -> bool {
    let lowest = frequencies::slowest(context) * context.rate;
    candidate.domain == Domain::Line && candidate.inner().is_some_and(|hertz| hertz < lowest)
}

pub(crate) fn candidates(
    context: &Context,
    residual: &Residual,
    coloured: bool,
    library: &mut Library,
) -> Vec<Candidate> {
    let search = Search { context, coloured };
    let mut list = vec![];
    for line in search.in_frame(&residual.radial, &residual.tangential) {
        list.extend(search.interference(&line, library));
    }
    let ([radial, fast], length) = two_spectra(&residual.radial, residual.fast());
    for f in search.lines(&radial, length) {
        list.push(search.ripple(f, library));
    }
    if let Some(f) = search.of_motion(&fast, length) {
        list.push(search.vibration(f, library));
    }
    list
}

/// Lines that stand out of noise as the likelihood weighs it.
pub(crate) fn weighed(
    context: &Context,
    weighed: &Weighed,
    coloured: bool,
    library: &mut Library,
) -> Vec<Candidate> {
    let search = Search { context, coloured };
    let [radial, tangential] = &weighed.matched;
    let mut list = vec![];
    for line in search.in_frame(radial, tangential) {
        list.extend(search.interference(&line, library));
    }
    let (power, length) = spectrum(&weighed.fast);
    if let Some(f) = search.of_motion(&power, length) {
        list.push(search.vibration(f, library));
    }
    list
}

/// Frequency, amplitudes and phases of a line in the channels and of its harmonics.
fn in_either(duration: f64) -> Reads {
    Rc::new(move |e| {
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
    })
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
