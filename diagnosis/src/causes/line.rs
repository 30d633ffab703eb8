//! Lines at a fixed frequency: hum in the channels, ripple of the amplitude, vibration of the axis.

use std::f64::consts::TAU;
use std::rc::Rc;

use super::mains;
use super::mirror::unmirrored;
use crate::block::Block;
use crate::cause::{Candidate, Domain, Estimate, Exact, Make, Reads, polar};
use crate::context::Context;
use crate::finding::{Chip, Parameter};
use crate::library::{Fill, Library, Place, Shape, Use};
use crate::lines::{flattened, pair_spectrum, peak, spectrum, two_spectra, two_transforms};
use crate::model::{Residual, Weighed};

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

/// A line that may be.
struct Line {
    /// Its frequency in cycles per sample.
    f: f64,
    /// Among how many it was chosen, but 1 for the highest of all: the radius alone judges that for the first time.
    by_radius: f64,
}

/// Where lines are looked for.
struct Search<'a> {
    context: &'a Context,
    /// Lines have to stand out of what is near them.
    coloured: bool,
}

impl Search<'_> {
    /// Frequency of the highest line of a spectrum, in cycles per sample.
    fn line(&self, power: &[f64], length: usize) -> Option<f64> {
        if self.coloured {
            return self.narrow(power, length);
        }
        peak(power, length, self.lowest(), 0.499)
    }

    /// Frequency of the highest line where the mains has one, in cycles per sample.
    fn of_mains(&self, power: &[f64], length: usize) -> Option<f64> {
        if self.coloured {
            return None;
        }
        let rate = self.context.rate;
        let places = mains::places().map(|[low, high]| [low / rate, high / rate]);
        let inside = places.filter(|[low, high]| *low > self.lowest() && *high < 0.499);
        let peaks = inside.filter_map(|[low, high]| peak(power, length, low, high));
        let at = |f: &f64| power[(f * length as f64).round() as usize];
        peaks.max_by(|a, b| at(a).total_cmp(&at(b)))
    }

    /// Frequencies of the highest line, and of the highest of the mains.
    fn lines(&self, power: &[f64], length: usize) -> impl Iterator<Item = f64> + use<> {
        let both = [self.line(power, length), self.of_mains(power, length)];
        both.into_iter().flatten()
    }

    /// Frequency of the line that stands highest above what is near it, where one stands out.
    fn narrow(&self, power: &[f64], length: usize) -> Option<f64> {
        let level = flattened(power);
        let f = peak(&level, length, self.lowest(), 0.499)?;
        let highest = level[(f * length as f64).round() as usize];
        (highest > STANDS_OUT).then_some(f)
    }

    /// Frequency of a line in the motion: an axis that shakes has broad peaks, too, which may be the higher ones.
    fn of_motion(&self, power: &[f64], length: usize) -> Option<f64> {
        let narrow = self.narrow(power, length);
        let seen = narrow.or_else(|| self.line(power, length))?;
        Some(unmirrored(self.context, seen))
    }

    /// Cycles per sample below which nothing is a line.
    fn lowest(&self) -> f64 {
        SLOWEST / self.context.samples() as f64
    }

    /// Frequencies that may be lines in the frame of the channels, of what is along the radius and along the circle.
    fn in_frame(&self, radial: &[f64], tangential: &[f64]) -> Vec<Line> {
        let frame = |k: usize| {
            let (r, t) = (radial[k], tangential[k]);
            let (c, s) = (self.context.cos[k], self.context.sin[k]);
            (r * c - t * s, r * s + t * c)
        };
        let (in_c, in_s): (Vec<f64>, Vec<f64>) = (0..radial.len()).map(frame).unzip();
        let (power, length) = pair_spectrum(&in_c, &in_s);
        let mut list: Vec<Line> = vec![];
        let highest = self
            .line(&power, length)
            .map(|f| Line { f, by_radius: 1.0 });
        let mains = self.of_mains(&power, length);
        let radius = self.in_radius(radial);
        let few = mains.into_iter().chain(radius);
        let few = few.map(|f| Line {
            f,
            by_radius: self.trials(f * self.context.rate),
        });
        for line in highest.into_iter().chain(few) {
            // Two that are nearer than a cycle per recording are one.
            let near = |known: &Line| (line.f - known.f).abs() * radial.len() as f64 <= 1.0;
            if !list.iter().any(near) {
                list.push(line);
            }
        }
        list
    }

    /// The same of the radius alone, for an axis that stands near one angle for a part of the time: there a line along the circle goes with the
    /// motion, and the best amounts in both channels, of which one direction is seen more than the other, explain so much at each
    /// frequency. What is large over a range of frequencies is none.
    fn in_radius(&self, radial: &[f64]) -> Vec<f64> {
        /// Of an axis that stands at one angle for a fifth of the time, so many times as much is seen in one direction as in the
        /// other.
        const STANDS: f64 = 1.5;
        /// Share of the samples that every direction is taken to be seen in besides, so that none has to be divided by zero.
        const LEAST: f64 = 0.01;
        let context = self.context;
        let sum = |a: &[f64], b: &[f64]| -> f64 {
            let pairs = a.iter().zip(b).zip(&context.weight);
            pairs.map(|((a, b), w)| a * b * w).sum()
        };
        let least = LEAST * context.samples() as f64;
        let cc = sum(&context.cos, &context.cos) + least;
        let ss = sum(&context.sin, &context.sin) + least;
        let cs = sum(&context.cos, &context.sin);
        let (mean, apart) = (0.5 * (cc + ss), (0.5 * (cc - ss)).hypot(cs));
        if mean + apart < STANDS * (mean - apart) {
            return vec![];
        }
        let of = |by: &[f64]| -> Vec<f64> { radial.iter().zip(by).map(|(r, b)| r * b).collect() };
        let (transforms, length) = two_transforms(&of(&context.cos), &of(&context.sin));
        let explained = transforms.iter().map(|[c, s]| {
            let across = 2.0 * cs * (c * s.conj()).re;
            (ss * c.norm_sqr() + cc * s.norm_sqr() - across) / (cc * ss - cs * cs)
        });
        let level = flattened(&explained.collect::<Vec<f64>>());
        self.lines(&level, length).collect()
    }

    /// Seconds.
    fn duration(&self) -> f64 {
        self.context.samples() as f64 / self.context.rate
    }

    /// Frequencies among which one stood out.
    fn trials(&self, hertz: f64) -> f64 {
        let all = self.context.samples() as f64;
        mains::trials(hertz, self.duration()).map_or(all, |few| few.min(all))
    }

    /// A line of that name with its functions; its frequency is known to a small part of one cycle per recording.
    fn candidate(
        &self,
        name: &'static str,
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
                ..self.candidate("interference", Domain::Line, hertz, make, library)
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
            ..self.candidate("amplitude_ripple", Domain::Line, hertz, make, library)
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
                    "the axis vibrates at {} with an amplitude of {} of electrical angle; the radius does not change, so the motion is real",
                    p[0].brief(),
                    p[1].brief()
                )
            }),
            ..self.candidate(super::VIBRATION, Domain::Motion, hertz, make, library)
        }
    }
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
