//! How close the knots of the motion's spline stand: as close as the likelihood asks for, and then a little closer.
//!
//! An axis that shakes adds noise of some colour to the motion of its drive. The shapes of causes are made where the axis
//! really is, so the angle is followed through all of that; but what is taken off as motion, and with it whatever looks
//! like it, ends where the spectrum falls no more.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::motion::spline::Spline;
use crate::numerics::ends::span;
use crate::numerics::lines::{median, spectrum, strongest, window};

/// Finest knot spacing, in samples.
const FINEST: f64 = 6.0;
/// Knots stand at least so much closer than the likelihood asks for: what the motion leaves behind must be far below the
/// noise, not just not worth another knot.
const CLOSER: f64 = 2.0;
/// Records longer than this are judged by stretches.
const WHOLE: usize = 32_768;
/// So many of them, spread over the record.
const STRETCHES: usize = 4;
/// So many halvings in a row that are worse end the search.
const PATIENCE: usize = 3;
/// Above so many times what the spectrum has just above it, something of the drive is left.
const STEEP: f64 = 1.5;
/// The same of one line: of noise alone hardly one of a thousand is so high.
const HIGH: f64 = 16.0;
/// So many times the noise, as it stands at the highest frequencies, is an axis that shakes.
const SHAKES: f64 = 2.0;
/// Radians rms that a spline may leave: of more, the second order is no motion.
const SMALL: f64 = 0.02;
/// So many times farther apart than where the angle is followed, knots are worth to be.
const FARTHER: f64 = 1.5;

/// Scale periods of travel from which on what repeats with the period can be told from motion.
const REPEATS: f64 = 4.0;
/// And periods from one end of its way to the other: within one, the angle itself is a function of its place in the period.
const APART: f64 = 2.0;

/// Knot spacings, in samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Spacing {
    /// Of the spline that the angle is followed by.
    pub(crate) followed: f64,
    /// Of the spline that is taken off as motion: no cause can be told from it.
    pub(crate) motion: f64,
}

/// Whether what repeats with the period is told from motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Told {
    /// A reference shows the motion, however little the scale moves.
    ByReference,
    /// It is where the scale moves over some periods.
    WhereItTravels,
    /// It is motion itself.
    Not,
}

/// The knot spacing whose spline explains an angle (radians) best for its number of coefficients, with what repeats with
/// the period taken off first, and the strongest line in time and in the revolution: real vibration and cogging are no
/// reason for more knots. And the spacing where the spectrum of what is left falls no more.
pub(crate) fn spacing(
    angle: &[f64],
    weight: &[f64],
    periods_per_revolution: Option<u32>,
    told: Told,
) -> Spacing {
    let n = angle.len();
    let trembles = span(angle.iter().copied()) < APART * TAU;
    let told = match told {
        Told::ByReference => true,
        Told::WhereItTravels => travelled(angle) >= REPEATS && !trembles,
        Told::Not => false,
    };
    let stretches: Vec<Stretch> = stretches(n)
        .into_iter()
        .map(|range| {
            Stretch::new(
                &angle[range.clone()],
                &weight[range],
                periods_per_revolution,
                told,
            )
        })
        .collect();
    let counting: f64 = stretches.iter().map(|s| s.weight.iter().sum::<f64>()).sum();
    let longest = stretches.iter().map(|s| s.angle.len()).max().unwrap_or(1);
    let mut spacing = (longest as f64 / 2.0).max(FINEST);
    // Its score, and the mean square that its spline leaves.
    let score = |spacing: f64| {
        let (mut power, mut count) = (0.0, 0.0);
        for stretch in &stretches {
            let spline = Spline::new(stretch.angle.len(), spacing, stretch.weight);
            power += stretch.left(&spline);
            count += spline.count() as f64;
        }
        let square = power / counting;
        let score = counting * square.max(1e-300).ln() + count * counting.ln();
        (score, square)
    };
    let (mut best, mut left) = ((f64::MAX, spacing), f64::MAX);
    let mut worse = 0;
    // Of what trembles about one place coarse splines explain nothing.
    while spacing >= FINEST && (worse <= PATIENCE || trembles && left > SMALL * SMALL) {
        let (now, square) = score(spacing);
        worse += 1;
        if now < best.0 {
            (best, left) = ((now, spacing), square);
            worse = 0;
        }
        spacing /= 2.0;
    }
    let coarse = best.1;
    for share in [1.0 / 2f64.sqrt(), 2f64.sqrt()] {
        let spacing = (coarse * share).max(FINEST);
        let (now, _) = score(spacing);
        if now < best.0 {
            best = (now, spacing);
        }
    }
    let apart = |spacing: f64| (spacing / closer(n as f64, spacing)).max(FINEST);
    let followed = apart(best.1);
    let level = levels_off(&stretches, best.1).map_or(0.0, apart);
    let level = order_alone(&stretches, followed).unwrap_or(level);
    Spacing {
        followed,
        motion: if level > FARTHER * followed {
            level
        } else {
            followed
        },
    }
}

/// The widest spacing, wider than `finest`, above which the spectrum of what the spline leaves falls no more.
fn levels_off(stretches: &[Stretch], finest: f64) -> Option<f64> {
    /// Most knots' spacings in a stretch; with fewer nothing is known of the spectrum.
    const FEWEST: f64 = 12.0;
    let longest = stretches.iter().map(|s| s.angle.len()).max()?;
    let mut spacing = longest as f64 / FEWEST;
    while spacing > finest {
        if stretches.iter().all(|s| s.is_level(spacing)) {
            return Some(spacing);
        }
        spacing /= 2f64.sqrt();
    }
    None
}

/// The widest spacing, of those wider than `finest`, whose spline leaves nothing but noise beside one order of the revolution:
/// closer knots would follow that, and hide it.
fn order_alone(stretches: &[Stretch], finest: f64) -> Option<f64> {
    /// So many spacings in an octave.
    const STEPS: i32 = 4;
    /// Octaves.
    const FARTHEST: i32 = 5;
    /// Log-likelihood from which on an order is one.
    const WORTH: f64 = 30.0;
    /// Standard deviations of what closer knots explain of noise.
    const BY_CHANCE: f64 = 2.0;
    let counting: f64 = stretches.iter().map(|s| s.weight.iter().sum::<f64>()).sum();
    if stretches.iter().any(|s| s.revolution.is_none()) {
        return None;
    }
    // What knots leave with the order and without, and how many they are.
    let look = |spacing: f64| {
        let [mut with, mut without, mut count] = [0.0; 3];
        for stretch in stretches {
            let spline = Spline::new(stretch.angle.len(), spacing, stretch.weight);
            let square = |v: &[f64]| v.iter().map(|r| r * r).sum::<f64>();
            let left = stretch.without_cycles(&spline);
            with += square(&strongest(&left).1);
            without += square(&stretch.without_lines(&left, &spline));
            count += spline.count() as f64;
        }
        (with, without, count)
    };
    let likelihood = |more: f64, less: f64| 0.5 * counting * (more / less.max(1e-300)).ln();
    let (_, closest, most) = look(finest);
    let mut found = None;
    for step in 1..=STEPS * FARTHEST {
        let spacing = finest * 2f64.powf(f64::from(step) / f64::from(STEPS));
        let (with, without, count) = look(spacing);
        let fewer = 0.5 * (most - count);
        let beyond = likelihood(without, closest) - fewer;
        // Wider ones leave more of the drive.
        if beyond > BY_CHANCE * fewer.sqrt() {
            break;
        }
        if likelihood(with, without) > WORTH {
            found = Some(spacing);
        }
    }
    found
}

/// How much closer than the likelihood asks for. There, what the spline leaves of the motion raises the log-likelihood by
/// about n ln n/(8 h) for a spacing of h samples; it falls with the eighth power of the spacing, and has to be below one.
fn closer(n: f64, spacing: f64) -> f64 {
    const MARGIN: f64 = 1.25;
    (MARGIN * (n * n.ln() / 8.0 / spacing).powf(0.125)).max(CLOSER)
}

/// Scale periods of an angle's way there and back, but for what moves it by less than an eighth of one.
fn travelled(angle: &[f64]) -> f64 {
    let mut mark = angle.first().copied().unwrap_or_default();
    let mut way = 0.0;
    for a in angle {
        let step = (a - mark).abs();
        if step > TAU / 8.0 {
            (way, mark) = (way + step, *a);
        }
    }
    way / TAU
}

fn stretches(n: usize) -> Vec<Range<usize>> {
    if n <= WHOLE {
        return std::iter::once(0..n).collect();
    }
    let length = WHOLE / STRETCHES;
    let gap = (n - length) / (STRETCHES - 1);
    (0..STRETCHES).map(|i| i * gap..i * gap + length).collect()
}

/// A part of the record, and what repeats with the period in it.
struct Stretch<'a> {
    angle: &'a [f64],
    weight: &'a [f64],
    /// cos and sin of orders 1 to 4.
    cyclic: Vec<Vec<f64>>,
    /// Periods per revolution, and the angle of the revolution.
    revolution: Option<(u32, Vec<f64>)>,
}

impl<'a> Stretch<'a> {
    fn new(angle: &'a [f64], weight: &'a [f64], per: Option<u32>, told: bool) -> Self {
        let wave = |order: u32, f: fn(f64) -> f64| -> Vec<f64> {
            angle.iter().map(|a| f(f64::from(order) * a)).collect()
        };
        Self {
            angle,
            weight,
            cyclic: (1..=if told { 4 } else { 0 })
                .flat_map(|order| [wave(order, f64::cos), wave(order, f64::sin)])
                .collect(),
            revolution: per.map(|n| (n, angle.iter().map(|a| a / f64::from(n)).collect())),
        }
    }

    /// Whether the spectrum of what a spline with such knots leaves falls no more above them, but stands above the noise.
    /// What is left of a drive stands about half their frequency and at it, with images about its multiples, which knots
    /// half as far apart leave nothing of.
    fn is_level(&self, spacing: f64) -> bool {
        let band = |low: f64, high: f64, power: &[f64], length: usize| {
            let index = |f: f64| ((f / spacing * length as f64) as usize).min(power.len() - 1);
            power[index(low)..index(high)].to_vec()
        };
        let (power, length, rms) = self.spectrum(spacing);
        let (below, above) = (
            band(0.25, 0.75, &power, length),
            band(0.75, 3.0, &power, length),
        );
        if below.is_empty() || above.is_empty() || rms > SMALL {
            return false;
        }
        let level = median(&above);
        let noise = median(&power[length / 4..]);
        let mean = below.iter().sum::<f64>() / below.len() as f64;
        let highest = band(0.0, 1.25, &power, length);
        let highest = highest.iter().copied().fold(0.0, f64::max);
        if mean > STEEP * level || highest > HIGH * level || level < SHAKES * noise {
            return false;
        }
        let (closer, length, _) = self.spectrum(spacing / 2.0);
        let same = |power: &[f64]| median(&band(1.5, 3.0, power, length));
        same(&power) < STEEP * same(&closer)
    }

    /// Power spectrum of what a spline with such knots leaves, without what repeats with the period or cogs; its length, and
    /// the rms of what is left.
    fn spectrum(&self, spacing: f64) -> (Vec<f64>, usize, f64) {
        let spline = Spline::new(self.angle.len(), spacing, self.weight);
        let mut left = self.without_order(self.without_cycles(&spline), &spline);
        let n = left.len();
        let rms = (left.iter().map(|l| l * l).sum::<f64>() / n as f64).sqrt();
        for (k, value) in left.iter_mut().enumerate() {
            *value *= window(k, n);
        }
        let (power, length) = spectrum(&left);
        (power, length, rms)
    }

    /// Square of what a spline leaves of the angle.
    fn left(&self, spline: &Spline) -> f64 {
        self.residual(spline).iter().map(|r| r * r).sum()
    }

    /// What a spline leaves of the angle.
    fn residual(&self, spline: &Spline) -> Vec<f64> {
        self.without_lines(&self.without_cycles(spline), spline)
    }

    /// What a spline leaves of the angle, without what repeats with the period.
    fn without_cycles(&self, spline: &Spline) -> Vec<f64> {
        let mut columns = vec![self.angle];
        columns.extend(self.cyclic.iter().map(Vec::as_slice));
        let mut residuals = spline.residuals(&columns, self.weight);
        let shapes = residuals.split_off(1);
        crate::numerics::solve::without(&residuals[0], &shapes)
    }

    /// Without the strongest line, and the strongest order of the revolution.
    fn without_lines(&self, values: &[f64], spline: &Spline) -> Vec<f64> {
        self.without_order(strongest(values).1, spline)
    }

    /// Without the strongest order of the revolution.
    fn without_order(&self, left: Vec<f64>, spline: &Spline) -> Vec<f64> {
        let Some((per, phi)) = &self.revolution else {
            return left;
        };
        let Some(order) = crate::causes::strongest_order(*per, phi, &left) else {
            return left;
        };
        let waves = crate::causes::order_waves(order, phi);
        let columns: Vec<&[f64]> = waves.iter().map(Vec::as_slice).collect();
        crate::numerics::solve::without(&left, &spline.residuals(&columns, self.weight))
    }
}
