//! Samples that are missing without a gap in time: the angle jumps by what it moves in whole samples.

use nonius_calibration::Ellipse;
use nonius_recording::Recording;

use crate::checks::delays::{Delay, Delays, delays};
use crate::checks::sides::{AROUND, beside, column, is_about, powers};
use crate::checks::{Checked, NINTH, magnitudes, ninth};
use crate::context::{against, unwrapped};
use crate::numerics::continuous::continuous;
use crate::numerics::correlate::sums;
use crate::numerics::solve::{dot, weights_of};

/// Samples on either side of a jump that are compared, and the order of the curve through them; on slow axes more of them
/// show it, and on axes that shake a curve that bends more, or fewer of them. Longer ones are those of [`delays`].
const SIDES: [(usize, i32); 6] = [(4, 3), (8, 3), (8, 5), (24, 3), (64, 5), (200, 5)];
/// So many times the ninth decile of what the curve leaves is a jump: eight standard deviations.
const FAR: f64 = 4.9;
/// Most samples lost at one place that are believed without a clock.
const MOST: f64 = 32.0;
/// Standard deviations by which the sensor has to be seen to jump with its reference.
const TOGETHER: f64 = 3.0;
/// Standard deviations by which fewer samples may show another jump than more of them do.
const ALIKE: f64 = 3.5;
/// Standard deviations from which on all noise together shows a delay.
const SURE: f64 = 6.5;
/// Standard deviation of a number of samples below which it is a number: by one look, and by all noise together.
const ERROR: f64 = 0.15;
const ERROR_IN_NOISE: f64 = 0.2;

/// How many samples are missing, if that is a whole number.
fn whole_number(samples: f64, sigma: f64, known: f64) -> Option<usize> {
    let lost = samples > 0.5 && samples < MOST && sigma < known;
    (lost && is_about(samples, samples.round(), sigma)).then(|| samples.round() as usize)
}

/// A place where an angle jumps: before which sample, how far, and how large the noise is there.
struct Jump {
    before: usize,
    size: f64,
    sigma: f64,
}

/// One of the samples on either side of a place.
fn single(side: usize, one: usize) -> Vec<f64> {
    (0..2 * side).map(|i| f64::from(i == one)).collect()
}

/// What a step between two samples in the middle adds to a curve of that order through `side` samples on either side: the
/// weights of the samples that give its size, free of that curve.
fn step_weights(side: usize, order: i32) -> Vec<f64> {
    let curve = powers(2 * side, order);
    let step = column(2 * side, |x| 0.5 * x.signum());
    weights_of(&step, &curve)
}

/// What a curve does not follow either and what looks like a step in it: corners of a drive, where the speed, the acceleration or
/// its change is another at once, and a sample beside the place that is off by itself, for it is wild or stands, a repeat of the one before, in
/// the place of another: its neighbours go on as before.
struct Alike(Vec<Vec<f64>>);

impl Alike {
    /// What they add to a curve of that order through `side` samples on either side: of unit square, free of that curve.
    fn new(side: usize, order: i32) -> Self {
        /// Steps of a sixteenth of a side by which they may stand beside the middle.
        const BESIDE: i32 = 4;
        let curve = powers(2 * side, order);
        let corner = |(degree, place): (i32, i32)| -> Vec<f64> {
            let from = f64::from(place) / 16.0;
            column(2 * side, |x| (x - from).max(0.0).powi(degree))
        };
        let places = -BESIDE..=BESIDE;
        let corners = places.flat_map(|place| (1..=3).map(move |degree| (degree, place)));
        let wild = [side - 1, side].map(|one| single(side, one));
        let unit = |alike: Vec<f64>| -> Vec<f64> {
            let free = crate::numerics::solve::without(&alike, &curve);
            let size = free.iter().map(|v| v * v).sum::<f64>().sqrt();
            free.iter().map(|v| v / size).collect()
        };
        Self(corners.map(corner).chain(wild).map(unit).collect())
    }

    /// Square of the angle near a place that the best of them explains.
    fn explained(&self, near: &[f64]) -> f64 {
        let squares = self.0.iter().map(|alike| dot(near, alike).powi(2));
        squares.fold(0.0, f64::max)
    }

    /// Whether one of them explains as much of the angle near a jump as the jump does, whose size the weights give.
    fn explain(&self, near: &[f64], weights: &[f64]) -> bool {
        let most = dot(near, weights).powi(2) / dot(weights, weights);
        self.explained(near) > most
    }
}

/// The sides that so many samples are enough for.
fn sides(samples: usize) -> impl Iterator<Item = (usize, i32)> {
    SIDES
        .into_iter()
        .take_while(move |(side, _)| samples >= 32 * side)
}

/// The angle of a recording that draws an ellipse, continuous, radians.
pub(crate) fn angle(recording: &Recording, ellipse: &Ellipse, weight: &[f64]) -> Vec<f64> {
    let pairs = recording.cos.iter().zip(&recording.sin);
    let angle = pairs.map(|(c, s)| {
        let (c, s) = ellipse.corrected(*c, *s);
        s.atan2(c)
    });
    continuous(angle.collect(), weight)
}

/// An angle, looked at with curves through so many samples on either side.
struct Look<'a> {
    angle: &'a [f64],
    side: usize,
    /// Of the samples about a place: see [`step_weights`].
    weights: Vec<f64>,
    /// How far it jumps before each sample, by those curves.
    sizes: Vec<f64>,
}

impl<'a> Look<'a> {
    fn new(angle: &'a [f64], side: usize, order: i32) -> Self {
        let weights = step_weights(side, order);
        let mut sizes = vec![0.0; side];
        sizes.extend(sums(angle, &weights));
        sizes.resize(angle.len(), 0.0);
        Self {
            angle,
            side,
            sizes,
            weights,
        }
    }

    /// The samples that show a jump.
    fn near(&self, jump: &Jump) -> &'a [f64] {
        &self.angle[jump.before - self.side..jump.before + self.side]
    }

    /// Ninth decile of the sizes on either side of a place.
    fn noise(&self, k: usize, typical: f64) -> f64 {
        let near = beside(k, self.side, self.sizes.len());
        let ninths = near.map(|range| ninth(&magnitudes(&self.sizes[range])));
        ninths.into_iter().fold(typical, f64::max)
    }

    /// Standard deviation of the sizes there.
    fn sigma(&self, k: usize) -> f64 {
        self.noise(k, 0.0) / NINTH
    }

    /// Where it jumps farther than noise does.
    fn far(&self) -> Vec<Jump> {
        let (n, side) = (self.sizes.len(), self.side);
        let plain = magnitudes(&self.sizes);
        let typical = ninth(&plain);
        let mut far = vec![];
        for k in side..=n - side {
            if plain[k] < FAR * typical {
                continue;
            }
            let noise = self.noise(k, typical);
            let near = &plain[k - side / 2..(k + side / 2 + 1).min(n)];
            let highest = near.iter().all(|p| *p <= plain[k]);
            if plain[k] > FAR * noise && highest {
                far.push(Jump {
                    before: k,
                    size: self.sizes[k],
                    sigma: noise / NINTH,
                });
            }
        }
        far
    }

    /// Whether a jump that more samples show is as large here, beside the noise: what ripples, as an axis that cogs faster and
    /// faster, is a jump for one length of curves only.
    fn shows(&self, jump: &Jump) -> bool {
        let sigma = self.sigma(jump.before).hypot(jump.sigma);
        (self.sizes[jump.before] - jump.size).abs() < ALIKE * sigma
    }

    /// How many samples are missing where it jumps, if that is a whole number.
    fn missing(&self, jump: &Jump) -> Option<usize> {
        let (k, side) = (jump.before, self.side);
        let way = self.angle[k + side - 1] - self.angle[k - side];
        let moves = (way - jump.size) / (2 * side - 1) as f64;
        let samples = jump.size / moves;
        whole_number(samples, jump.sigma / moves.abs(), ERROR)
    }
}

/// Places where the angle jumps by what it moves in whole samples: before which sample, how many are missing. What only a
/// reference shows counts where the sensor jumps with it.
pub(crate) fn jumps(recording: &Recording, checked: &Checked) -> Vec<(usize, usize)> {
    let Some(angle) = checked.angle(recording) else {
        return vec![];
    };
    let reference = recording.reference_rad.clone().map(unwrapped);
    let apart = reference.as_ref().map(|r| against(&angle, r));
    let mut found: Vec<(usize, usize)> = vec![];
    // Looks with shorter curves, at the sensor and at its reference.
    let mut shorter: [Vec<Look>; 2] = [vec![], vec![]];
    for (side, order) in sides(angle.len()) {
        let alike = Alike::new(side, order);
        let other = |look: &Look, j: &Jump| alike.explain(look.near(j), &look.weights);
        let look = Look::new(&angle, side, order);
        let far = look.far().into_iter();
        let far = far.filter(|j| !other(&look, j) && !goes_on(reference.as_deref(), j));
        found.extend(whole(&look, &shorter[0], far.collect(), checked, &found));
        if let Some((reference, apart)) = reference.as_ref().zip(apart.as_ref()) {
            let exact = Look::new(reference, side, order);
            let far = exact.far().into_iter();
            let far = far.filter(|j| together(apart, j) && !other(&exact, j));
            found.extend(whole(&exact, &shorter[1], far.collect(), checked, &found));
            shorter[1].push(exact);
        }
        shorter[0].push(look);
    }
    for look in delays(&angle) {
        found.extend(through_noise(&look, &shorter[0], checked, &found));
    }
    found.sort_unstable();
    found
}

/// Places that all noise together shows, and shorter curves too.
fn through_noise(
    look: &Delays,
    shorter: &[Look],
    checked: &Checked,
    found: &[(usize, usize)],
) -> Vec<(usize, usize)> {
    let shown = |delay: &Delay| {
        let jump = Jump {
            before: delay.before,
            size: delay.samples * delay.speed,
            sigma: delay.sigma * delay.speed.abs(),
        };
        shorter.iter().all(|look| look.shows(&jump))
    };
    let put_in = |delay: &Delay| {
        let known = delay.sigma < ERROR_IN_NOISE && is_about(delay.samples, -1.0, delay.sigma);
        known && delay.samples.round() == -1.0 && shown(delay)
    };
    let far = look.far(SURE).into_iter().filter(|delay| !put_in(delay));
    let seen = far.map(|delay| {
        let missing = whole_number(delay.samples, delay.sigma, ERROR_IN_NOISE);
        (delay.before, missing.filter(|_| shown(&delay)))
    });
    believed(seen, look.side(), checked, found)
}

/// Whether a reference shows that the axis goes on as before where the sensor jumps: what lies beside such a place is a glitch.
fn goes_on(reference: Option<&[f64]>, sensor: &Jump) -> bool {
    let Some(reference) = reference else {
        return false;
    };
    let looks = sides(reference.len()).filter_map(|side| at(reference, sensor.before, side));
    let surest = looks.min_by(|a, b| a.1.total_cmp(&b.1));
    surest.is_some_and(|(size, sigma)| {
        size + TOGETHER * sigma.hypot(sensor.sigma) < sensor.size.abs()
    })
}

/// How far values jump before a sample, by curves through so many on either side, and the standard deviation of that.
fn at(values: &[f64], k: usize, (side, order): (usize, i32)) -> Option<(f64, f64)> {
    if !(side..=values.len().saturating_sub(side)).contains(&k) {
        return None;
    }
    let reach = (AROUND + 1) * side;
    let near = k.saturating_sub(reach)..(k + reach).min(values.len());
    let look = Look::new(&values[near.clone()], side, order);
    let here = k - near.start;
    Some((look.sizes[here].abs(), look.sigma(here)))
}

/// Whether the sensor jumps with its reference: what is between them does not jump, and would if the reference alone did.
fn together(apart: &[f64], reference: &Jump) -> bool {
    /// What is between them has no motion that long curves would have to follow.
    const STILL: [(usize, i32); 2] = [(600, 3), (2000, 3)];
    /// So many times the samples on a side tell how large the noise is.
    const ENOUGH: usize = 6;
    let k = reference.before;
    let still = STILL
        .into_iter()
        .filter(|(side, _)| apart.len() >= ENOUGH * side);
    let looks = sides(apart.len()).chain(still);
    let looks = looks.filter_map(|side| at(apart, k, side));
    let surest = looks.min_by(|a, b| a.1.total_cmp(&b.1));
    surest.is_some_and(|(size, sigma)| size + TOGETHER * sigma < reference.size.abs())
}

/// Those of the jumps that are of whole samples, and that shorter curves show.
fn whole(
    look: &Look,
    shorter: &[Look],
    far: Vec<Jump>,
    checked: &Checked,
    found: &[(usize, usize)],
) -> Vec<(usize, usize)> {
    let seen = far.into_iter().map(|jump| {
        let missing = look.missing(&jump);
        let shown = missing.filter(|_| shorter.iter().all(|look| look.shows(&jump)));
        (jump.before, shown)
    });
    believed(seen, look.side, checked, found)
}

/// Places, and how many samples are missing there if that is a whole number, where no sample nearby is bad and none was found before;
/// none where the angle jumps by anything, for a whole number is chance there.
fn believed(
    seen: impl Iterator<Item = (usize, Option<usize>)>,
    side: usize,
    checked: &Checked,
    found: &[(usize, usize)],
) -> Vec<(usize, usize)> {
    let mut list = vec![];
    let mut others = 0;
    for (k, missing) in seen {
        let known = |j: usize| k.abs_diff(j) <= side;
        let bad = (k - 2..k + 2).any(|j| checked.weight[j] == 0.0);
        let bad = bad || checked.extra.iter().any(|j| known(*j));
        if bad || found.iter().any(|f| known(f.0)) {
            continue;
        }
        match missing {
            Some(samples) => list.push((k, samples)),
            None => others += 1,
        }
    }
    if list.len() > 4 * others {
        list
    } else {
        vec![]
    }
}
