//! Frequencies that may be lines.

use super::mains;
use super::mirror::{self, unmirrored};
use crate::context::Context;
use crate::numerics::lines::{flattened, pair_spectrum, peak, refined, two_transforms};
use crate::unnamed::unseen::REPEATS;

/// Lowest frequency of a line, in cycles per recording: below, it is drift.
const SLOWEST: f64 = 4.0;

/// Highest order of the scale period of an error that is as large as a line.
const FINEST: f64 = 32.0;

/// Highest frequency of a line, in cycles per sample: at half the sample rate one of two phases is not seen.
const HIGHEST: f64 = 0.499;

/// So many times what is near it in the spectrum, a line stands out of noise of any colour.
const STANDS_OUT: f64 = 40.0;

/// A line that may be.
pub(super) struct Line {
    /// Its frequency in cycles per sample.
    pub(super) f: f64,
    /// Among how many it was chosen, but 1 for the highest of all: the radius alone judges that for the first time.
    pub(super) by_radius: f64,
}

/// Where lines are looked for.
pub(super) struct Search<'a> {
    pub(super) context: &'a Context,
    /// Lines have to stand out of what is near them.
    pub(super) coloured: bool,
}

/// Cycles per sample below which a line is drift.
pub(super) fn slowest(context: &Context) -> f64 {
    SLOWEST / context.samples() as f64
}

/// Cycles per sample below which no line is looked for: within a scale period that is not repeated, any error that goes with the angle
/// would be one.
pub(super) fn lowest(context: &Context) -> f64 {
    let periods = context.periods_travelled();
    let repeats = periods >= REPEATS;
    let within = if repeats { 0.0 } else { FINEST * periods };
    SLOWEST.max(within) / context.samples() as f64
}

impl Search<'_> {
    /// Frequency of the highest line of a spectrum, in cycles per sample.
    fn line(&self, power: &[f64], length: usize, lowest: f64) -> Option<f64> {
        if self.coloured {
            return self.narrow(power, length, lowest);
        }
        peak(power, length, lowest, HIGHEST)
    }

    /// Frequency of the highest line where the mains has one, in cycles per sample; flank and side lobes of another line are none.
    fn of_mains(&self, power: &[f64], length: usize) -> Option<f64> {
        if self.coloured {
            return None;
        }
        // A line is the highest within three cycles per recording.
        let reach = (3 * length).div_ceil(self.context.samples());
        let bins = length as f64 / self.context.rate;
        let first = (lowest(self.context) * length as f64).ceil() as usize;
        let last = (HIGHEST * length as f64) as usize;
        let inside = mains::places().flat_map(|[low, high]| {
            ((low * bins) as usize).max(first.max(1))..=((high * bins).ceil() as usize).min(last)
        });
        let stands_alone = |k: &usize| {
            let near = k.saturating_sub(reach)..=(k + reach).min(power.len() - 1);
            power[near].iter().all(|p| *p <= power[*k])
        };
        let best = inside
            .filter(stands_alone)
            .max_by(|a, b| power[*a].total_cmp(&power[*b]))?;
        Some(refined(power, best) / length as f64)
    }

    /// Frequencies of the highest line, and of the highest of the mains where that is another.
    pub(super) fn lines(&self, power: &[f64], length: usize) -> impl Iterator<Item = f64> + use<> {
        let highest = self.line(power, length, lowest(self.context));
        let known = |f: &f64| highest.is_some_and(|h| self.same(*f, h));
        let mains = self.of_mains(power, length).filter(|f| !known(f));
        highest.into_iter().chain(mains)
    }

    /// Whether two frequencies are one: they are nearer than a cycle per recording.
    fn same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() * self.context.samples() as f64 <= 1.0
    }

    /// Frequency of the line that stands highest above what is near it, where one stands out.
    fn narrow(&self, power: &[f64], length: usize, lowest: f64) -> Option<f64> {
        let level = flattened(power);
        let f = peak(&level, length, lowest, HIGHEST)?;
        let highest = level[(f * length as f64).round() as usize];
        (highest > STANDS_OUT).then_some(f)
    }

    /// Frequency of a line in the motion: an axis that shakes has broad peaks, too, which may be the higher ones. What the spline follows
    /// wholly leaves a spectrum that is almost nothing, in which anything stands out.
    pub(super) fn of_motion(&self, power: &[f64], length: usize) -> Option<f64> {
        let spline = self.context.spline.as_ref();
        let followed = spline.map_or(0.0, |spline| mirror::FOLLOWED / spline.spacing());
        let lowest = followed.max(lowest(self.context));
        let narrow = self.narrow(power, length, lowest);
        let seen = narrow.or_else(|| self.line(power, length, lowest))?;
        Some(unmirrored(self.context, seen))
    }

    /// Frequencies that may be lines in the frame of the channels, of what is along the radius and along the circle.
    pub(super) fn in_frame(&self, radial: &[f64], tangential: &[f64]) -> Vec<Line> {
        let [in_c, in_s] = self.context.in_frame(radial, tangential);
        let (power, length) = pair_spectrum(&in_c, &in_s);
        let mut list: Vec<Line> = vec![];
        let highest = self
            .line(&power, length, lowest(self.context))
            .map(|f| Line { f, by_radius: 1.0 });
        let mains = self.of_mains(&power, length);
        let radius = self.in_radius(radial);
        let few = mains.into_iter().chain(radius);
        let few = few.map(|f| Line {
            f,
            by_radius: self.trials(f * self.context.rate),
        });
        for line in highest.into_iter().chain(few) {
            if !list.iter().any(|known| self.same(line.f, known.f)) {
                list.push(line);
            }
        }
        list
    }

    /// The same of the radius alone, for an axis that stands near one angle for a part of the time: there a line along the circle
    /// goes with the motion, and the best amounts in both channels, of which one direction is seen more than the other, explain so
    /// much at each frequency. What is large over a range of frequencies is none.
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
    pub(super) fn duration(&self) -> f64 {
        self.context.samples() as f64 / self.context.rate
    }

    /// Frequencies among which one stood out.
    pub(super) fn trials(&self, hertz: f64) -> f64 {
        let all = self.context.samples() as f64;
        mains::trials(hertz, self.duration()).map_or(all, |few| few.min(all))
    }
}
