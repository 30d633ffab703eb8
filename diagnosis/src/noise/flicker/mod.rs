//! Noise with a 1/f spectrum, added to the channels.
//!
//! It is looked for in the radius alone: real motion never shows there. With the noise of the channels as one complex
//! number z, the radius has Re(z e^{−iα}), so twice the radial residual times e^{iα} is z + z* e^{2iα}: the spectrum of z,
//! and its image about twice the angle. The spectrum is compared with what white noise and 1/f make of that (Whittle's
//! likelihood). The name is given only where they hold nine tenths of what a spectrum of any shape explains: correlated
//! noise, drift and hum are not 1/f. Nor are offsets that jump between two levels, though their spectrum may be: there the
//! levels explain as much as such noise does, each by its likelihood in time.

mod held_out;
mod one_over_f;
pub(crate) mod records;
mod slow;
mod spectrum;

use crate::context::Context;
use crate::drifts::channels::Channels;
use crate::drifts::telegraph;
use crate::finding::{Cause, Chip, Finding, Gain, Parameter};
use crate::numerics::statistics::{by_chance, price};
use crate::select::score::SHOWN;
use crate::unnamed::unexplained::{Unnamed, What, like};

use self::spectrum::{Band, Line, bands, spectrum, without_hum};

/// Slowest part of the spectrum, cycles per recording: below, polynomials of time were taken off.
const SLOWEST: usize = 8;
/// Fewest lines of the spectrum that tell a shape.
const FEWEST: usize = 32;
/// Share of what any spectrum explains that 1/f has to hold.
const HOLDS: f64 = 0.9;
/// Log-likelihood that octaves of noise with the spectrum 1/f explain beyond it by chance.
const BY_CHANCE: f64 = 4.0;
/// From which gain of the spectrum in log-likelihood on the samples are asked.
const SUSPECT: f64 = 2.0;
/// Corner, cycles per recording, below which what is seen of 1/f is the course of one drift as well.
const A_COURSE: f64 = 8.0;
/// Shapes of noise that could have been claimed.
const TRIALS: f64 = 30.0;

/// Flicker noise that was found.
#[derive(Clone, Debug)]
pub(crate) struct Flicker {
    /// Amplitude density of a channel at 1 Hz, in amplitudes per √Hz, one-sided; its standard error.
    density: [f64; 2],
    /// Where it is as large as the white noise, hertz.
    pub(crate) corner: f64,
    pub(crate) gain: f64,
    /// Log-likelihood of lines of the spectrum that were not fitted.
    held_out: f64,
    /// Log-likelihood that it explains of what is seen sample by sample, its number paid for.
    paid: f64,
    log_p: f64,
    /// Slowest part of the spectrum that was looked at, cycles per recording.
    slowest: usize,
    /// Two levels explain it: whatever it is, it has no name.
    jumps: bool,
    /// It exceeds the white noise in so few cycles of the recording that a course of time has them too.
    slow: bool,
}

/// Lines that a band counts for at most where the shape is judged: so every octave weighs alike.
const ALIKE: f64 = 8.0;
/// Log-likelihood that any spectrum may explain beyond it there: an exponent a tenth off, over the octaves of a record.
const MISFIT: f64 = 15.0;

/// Log-likelihood of bands given their expectations: two channels in each line.
fn likelihood(bands: &[Band], expected: impl Fn(&Band) -> f64) -> f64 {
    bands
        .iter()
        .map(|b| {
            let s = expected(b);
            -2.0 * b.count * (s.ln() + b.power / s)
        })
        .sum()
}

/// The best white level beside flicker noise of a corner frequency, and its log-likelihood.
fn white_beside(bands: &[Band], corner: f64) -> (f64, f64) {
    // White noise and its image.
    let shape = |b: &Band| 2.0 + corner * b.flicker;
    let sum: f64 = bands.iter().map(|b| b.count * b.power / shape(b)).sum();
    let white = sum / bands.iter().map(|b| b.count).sum::<f64>();
    (white, likelihood(bands, |b| white * shape(b)))
}

/// Log-likelihood of a level of its own in each octave, less what so many free levels explain of noise.
fn octaves(bands: &[Band]) -> f64 {
    let parts = bands.chunk_by(|a, b| a.octave == b.octave);
    let one = |part: &[Band]| {
        let count: f64 = part.iter().map(|b| b.count).sum();
        let level = part.iter().map(|b| b.count * b.power).sum::<f64>() / count;
        likelihood(part, |_| level) - 0.5
    };
    parts.map(one).sum::<f64>() + 0.5
}

/// The best corner frequency and its log-likelihood.
fn corner(lines: &[Line], bands: &[Band]) -> (f64, f64) {
    // From far below the first line to far above the last, then closer.
    let (low, high) = (lines[0].0 * 1e-2, lines[lines.len() - 1].0 * 1e2);
    let mut best = (low, f64::MIN);
    let mut reach = (high / low).ln();
    let mut centre = (low * high).sqrt();
    for _ in 0..6 {
        for i in -20..=20 {
            let corner = centre * (reach / 2.0 * f64::from(i) / 20.0).exp();
            let value = white_beside(bands, corner).1;
            if value > best.1 {
                best = (corner, value);
            }
        }
        centre = best.0;
        reach /= 6.0;
    }
    best
}

/// The spectrum of what names leave of the radius in bands, without what is slower and without hum: for plots.
pub(crate) fn gathered(context: &Context, radial: &[f64]) -> Vec<Band> {
    let mut lines = spectrum(context, &slow::without(context, radial), SLOWEST);
    without_hum(&mut lines);
    bands(&lines)
}

/// The spectrum of a radial residual from so many cycles per recording on, without hum; none of too short a record.
fn told(context: &Context, radial: &[f64], slowest: usize) -> Option<Vec<Line>> {
    /// Fewest samples that have one.
    const SAMPLES: usize = 64;
    if radial.len() < SAMPLES {
        return None;
    }
    let mut lines = spectrum(context, radial, slowest);
    if lines.len() < FEWEST {
        return None;
    }
    without_hum(&mut lines);
    Some(lines)
}

/// Log-likelihood of a radial residual as white noise and flicker noise, but for a constant; none of too short a record.
pub(crate) fn likelihood_of(context: &Context, radial: &[f64]) -> Option<f64> {
    let lines = told(context, radial, SLOWEST)?;
    let corner = corner(&lines, &bands(&lines)).0;
    let power: f64 = radial.iter().map(|r| r * r).sum();
    let white = -0.5 * radial.len() as f64 * power.max(f64::MIN_POSITIVE).ln();
    let seen = Channels::in_radius(context, radial);
    Some(white + one_over_f::gain(seen, corner).all)
}

/// Whether two levels explain nearly as much of what is seen as flicker noise does sample by sample, its number paid for, or more:
/// of noise that is 1/f they explain half, and of levels that are not quite two, as stray light makes, more than such noise or as
/// much.
fn jumps(seen: Channels, paid: f64) -> bool {
    const NEARLY: f64 = 0.75;
    let two = telegraph::gain(seen);
    two.is_some_and(|two| two > NEARLY * paid)
}

/// Flicker noise in what everything else leaves of the radius.
pub(crate) fn find(context: &Context, radial: &[f64]) -> Option<Flicker> {
    find_from(Channels::in_radius(context, radial), SLOWEST)
}

/// The same in what names leave, that is, with what is slower.
pub(crate) fn find_beside(context: &Context, radial: &[f64]) -> Option<Flicker> {
    find(context, &slow::without(context, radial))
}

/// Flicker noise where it explains clearly more than a slow change or steps do, whose log-likelihood, their numbers paid for,
/// is given: of weak noise hardly more than its slowest parts are seen.
pub(crate) fn instead(seen: Channels, change: f64) -> Option<Flicker> {
    const CLEARLY: f64 = 1.1;
    let found = find_from(seen, 1).filter(|f| !f.jumps)?;
    (found.paid > CLEARLY * change).then_some(found)
}

/// Flicker noise in a spectrum from so many cycles per recording on.
fn find_from(seen: Channels, slowest: usize) -> Option<Flicker> {
    let (context, radial) = (seen.context, seen.radial);
    let n = radial.len();
    let lines = told(context, radial, slowest)?;
    let bands = bands(&lines);
    let white = white_beside(&bands, 0.0).1;
    let best = corner(&lines, &bands);
    let in_spectrum = best.1 - white;
    if in_spectrum < SUSPECT {
        return None;
    }
    // A spectrum holds half of what the samples tell. Where those tell less, and another spectrum explains more, it is another.
    let in_time = one_over_f::gain(seen, best.0);
    let holds = in_spectrum >= HOLDS * (octaves(&bands) - white);
    if in_time.all < 0.5 * in_spectrum && !holds {
        return None;
    }
    let gain = in_spectrum.max(in_time.seen);
    let log_p = by_chance(gain, 1.0, 1, TRIALS);
    if log_p > SHOWN.ln() {
        return None;
    }
    let mut alike = bands.clone();
    alike.iter_mut().for_each(|b| b.count = b.count.min(ALIKE));
    let flat = white_beside(&alike, 0.0).1;
    let (own, any) = (corner(&lines, &alike).1 - flat, octaves(&alike) - flat);
    if any - own > ((1.0 - HOLDS) * any).max(BY_CHANCE) || any - own > MISFIT {
        return None;
    }
    let paid = in_time.all - price(n as f64);
    // From the curvature in the logarithm of the corner.
    let step: f64 = 0.05;
    let at = |by: f64| white_beside(&bands, best.0 * by.exp()).1;
    let curvature = (2.0 * best.1 - at(step) - at(-step)) / (step * step);
    let (level, _) = white_beside(&bands, best.0);
    // The level is that of both channels over two sides of the spectrum: as much as that of one channel over one side.
    let density = (level * best.0 / context.rate).sqrt();
    Some(Flicker {
        density: [density, 0.5 * density / curvature.max(1e-12).sqrt()],
        corner: best.0,
        gain,
        held_out: held_out::gain(&lines),
        log_p,
        paid,
        slowest,
        jumps: jumps(seen, paid - in_time.steady),
        slow: best.0 * (n as f64 / context.rate) < A_COURSE,
    })
}

impl Flicker {
    /// The same noise in what is left when more is known.
    pub(crate) fn again(&self, left: Channels) -> Option<Self> {
        if self.is_instead_of_a_change() {
            find_from(left, self.slowest)
        } else {
            find_beside(left.context, left.radial)
        }
    }

    /// It was weighed against a slow change, and found to explain more.
    pub(crate) fn is_instead_of_a_change(&self) -> bool {
        self.slowest < SLOWEST
    }

    /// Whether something unknown explains so much more that this may be a part of it.
    pub(crate) fn is_part_of(&self, unknown: f64) -> bool {
        const MUCH: f64 = 5.0;
        unknown > MUCH * self.gain
    }

    /// The finding, whose gain in the residual is for the caller to say; or what it is where it has no name.
    pub(crate) fn finding(&self) -> Result<Finding, Unnamed> {
        let corner = self.corner;
        let corner_error = 2.0 * corner * self.density[1] / self.density[0];
        let corner = Parameter::measured("corner_hz", corner, corner_error, "Hz");
        if self.jumps {
            return Err(Unnamed {
                log_p: self.log_p,
                gain: self.gain,
                what: What::Said(format!(
                    "the noise of the channels rises towards low frequencies, from {} down; {}",
                    corner.brief(),
                    like(
                        Cause::FlickerNoise,
                        "offsets that jump between two levels explain nearly as much"
                    )
                )),
            });
        }
        let [density, error] = self.density;
        let evidence = format!(
            "the noise of the channels rises as 1/f towards low frequencies and exceeds the white noise below {}",
            corner.brief()
        );
        Ok(Finding {
            cause: Cause::FlickerNoise,
            confounded_with: self
                .slow
                .then_some(Cause::OffsetDrift)
                .into_iter()
                .collect(),
            p_value: self.log_p.exp(),
            parameters: vec![
                Parameter::measured("density_at_1_hz", density, error, "amplitude/sqrt(Hz)"),
                corner,
            ],
            gain: Gain {
                held_out_log_likelihood_gain: Some(self.held_out),
                ..Gain::of(self.gain)
            },
            evidence,
            chip: Chip::CannotCorrect,
            design: vec![],
            weight: self.gain,
            effect: None,
            place: None,
        })
    }
}
