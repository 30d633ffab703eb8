//! Where an error without a name shows most: at which order of the scale period, speed, time or order of the revolution, and
//! whether along the radius or along the circle. It describes what is left; only whether the steps of a reference may have made it is
//! decided by it.

use std::f64::consts::TAU;

use nonius_fourier::Complex;
use nonius_quantity::{Unit, before_after, digits, periods_per_second, times};

use crate::causes::candidate::Domain;
use crate::causes::revolution;
use crate::context::Context;
use crate::numerics::repeated::repeated;

/// Waves of the angle that an error may have in a bin of time or speed: the mean, and two orders.
const WAVES: usize = 5;
/// Fewest scale periods in a bin by which those are told apart.
const PERIODS: f64 = 1.0;
/// Bins of time and of speed.
const BINS: usize = 24;
/// Highest order of the scale period, in the channels: the basis that finds such errors ends below it, at one more than
/// [`crate::causes::ORDERS`], and what it finds may be a part of one beyond.
const TOP: usize = 15;
/// Share of all that is most of it.
const MOST: f64 = 0.75;
/// Share of the recording below which a time is told.
const SHORT: f64 = 0.7;

/// How large an error is where that can be told, rms in amplitudes over both rows as residuals are, and where it is.
pub(crate) struct Place {
    pub(crate) rms: Option<f64>,
    /// Share of its power along the circle.
    pub(crate) along: Option<f64>,
    /// Each part with a comma before it; empty where nothing stands out.
    pub(crate) text: String,
}

/// What is left of a recording: a number per sample, along the radius and along the circle.
pub(crate) struct Left<'a> {
    pub(crate) context: &'a Context,
    pub(crate) radial: &'a [f64],
    pub(crate) tangential: &'a [f64],
}

/// Power of what repeats: along the radius, and along the circle.
type Power = [f64; 2];

impl Left<'_> {
    /// Whether most of an error of this domain is along the circle.
    pub(crate) fn is_along(&self, domain: Domain) -> bool {
        self.place(domain).along.is_some_and(|share| share > MOST)
    }

    /// An error of this domain.
    pub(crate) fn place(&self, domain: Domain) -> Place {
        match domain {
            Domain::Time => self.in_time(),
            Domain::Speed => self.over_speeds(),
            Domain::Angle => self.order(&self.context.alpha, TOP, true),
            Domain::Revolution => {
                let phi = self.context.phi.as_deref().unwrap_or_default();
                self.order(phi, revolution::ORDERS, false)
            }
            Domain::Code | Domain::Line | Domain::Motion => Place::nowhere(),
        }
    }

    /// The strongest order of an angle, in what the channels show or along the radius and the circle.
    fn order(&self, angle: &[f64], top: usize, in_channels: bool) -> Place {
        let places = (8 * top).next_power_of_two();
        let mut sums = vec![Complex::new(0.0, 0.0); places];
        let mut counts = vec![0.0; places];
        let mut noise = 0.0;
        for (k, angle) in angle.iter().enumerate() {
            let weight = self.context.weight[k];
            let place = (angle / TAU).rem_euclid(1.0) * places as f64;
            let place = (place as usize).min(places - 1);
            let turn = if in_channels {
                Complex::new(self.context.cos[k], self.context.sin[k])
            } else {
                Complex::new(1.0, 0.0)
            };
            let value = weight * turn * Complex::new(self.radial[k], self.tangential[k]);
            sums[place] += value;
            counts[place] += weight;
            noise += value.norm_sqr();
        }
        let total = counts.iter().sum::<f64>().max(1.0);
        for (sum, count) in sums.iter_mut().zip(&counts) {
            *sum /= f64::max(*count, 1.0);
        }
        nonius_fourier::forward(&mut sums);
        let power = |k: usize| sums[k].norm_sqr() + sums[places - k].norm_sqr();
        // The first order of the channels is that of the five parameters.
        let first = if in_channels { 2 } else { 1 };
        let all: f64 = (first..=top).map(power).sum();
        let chance = 2.0 * (top + 1 - first) as f64 * noise / (total * total);
        let square = all / (places * places) as f64 - chance;
        let strongest = (first..=top).max_by(|a, b| power(*a).total_cmp(&power(*b)));
        let text = match strongest {
            Some(order) if in_channels => format!(", mostly at order {order}"),
            Some(order) => format!(", mostly {} per revolution", times(order)),
            None => String::new(),
        };
        let weight = &self.context.weight;
        let share = counts.iter().filter(|n| **n > 0.0).count() as f64 / total;
        // What noise alone makes of means, taken off.
        let rows = [self.radial, self.tangential].map(|values| {
            let noise = values.iter().zip(weight).map(|(v, w)| w * v * v);
            (repeated(angle, values, weight, places) - share * noise.sum::<f64>()).max(0.0)
        });
        Place {
            rms: (square > 0.0).then(|| (square / 2.0).sqrt()),
            along: Some(rows[1] / (rows[0] + rows[1]).max(f64::MIN_POSITIVE)),
            text,
        }
    }

    /// Power in each bin, that of noise taken off, over the number of all samples.
    fn bins(&self, bin: impl Fn(usize) -> usize) -> Vec<Power> {
        let told = self.context.periods_travelled() >= PERIODS * BINS as f64;
        let waves = if told { WAVES } else { 1 };
        let mut sums = vec![[[0.0; WAVES]; 2]; BINS];
        let mut counts = vec![0.0; BINS];
        let mut noise = [0.0; 2];
        let context = self.context;
        for k in (0..context.samples()).filter(|k| context.weight[*k] > 0.0) {
            let (c, s) = (context.cos[k], context.sin[k]);
            let shapes = [1.0, c, s, c * c - s * s, 2.0 * c * s];
            let at = bin(k).min(BINS - 1);
            counts[at] += 1.0;
            for (row, value) in [self.radial[k], self.tangential[k]].into_iter().enumerate() {
                noise[row] += value * value;
                let pairs = sums[at][row].iter_mut().zip(shapes);
                pairs.for_each(|(sum, wave)| *sum += wave * value);
            }
        }
        let total = counts.iter().sum::<f64>().max(1.0);
        let power = |(sums, count): (&[[f64; WAVES]; 2], &f64)| {
            [0, 1].map(|row| {
                // A wave has half of the power that a mean has.
                let square = |i: usize| sums[row][i].powi(2) * if i == 0 { 1.0 } else { 2.0 };
                let power = (0..waves).map(square).sum::<f64>() / f64::max(*count, 1.0);
                let chance = waves as f64 * noise[row] / total;
                (power - chance).max(0.0) / total
            })
        };
        sums.iter().zip(&counts).map(power).collect()
    }

    /// The shortest time that holds most of it.
    fn in_time(&self) -> Place {
        let n = self.context.samples();
        let power = self.bins(|k| k * BINS / n.max(1));
        let all = sum(&power);
        let spans = (0..BINS).flat_map(|from| (from + 1..=BINS).map(move |to| (from, to)));
        let enough = spans.filter(|(from, to)| sum(&power[*from..*to]) >= MOST * all);
        let (from, to) = enough
            .min_by_key(|(from, to)| to - from)
            .unwrap_or((0, BINS));
        let text = if (to - from) as f64 > SHORT * BINS as f64 {
            " over the whole recording".into()
        } else {
            let seconds = |bin: usize| bin as f64 / BINS as f64 * n as f64 / self.context.rate;
            let (start, end) = before_after(seconds(from), seconds(to), Unit::Small("s"));
            format!(", mostly between {start} and {end}")
        };
        Place::of(&power, text)
    }

    /// The half of the speeds that holds most of it.
    fn over_speeds(&self) -> Place {
        let (speed, top) = (&self.context.speed, self.context.top_speed());
        let power = self.bins(|k| (speed[k].abs() / top * BINS as f64) as usize);
        let (all, fast) = (sum(&power), sum(&power[BINS / 2..]));
        let half = periods_per_second(digits(top / TAU / 2.0, 2));
        let text = if fast > MOST * all {
            format!(", mostly above {half}")
        } else if fast < (1.0 - MOST) * all {
            format!(", mostly below {half}")
        } else {
            String::new()
        };
        Place::of(&power, text)
    }
}

fn sum(power: &[Power]) -> f64 {
    power.iter().flatten().sum()
}

impl Place {
    fn nowhere() -> Self {
        Self {
            rms: None,
            along: None,
            text: String::new(),
        }
    }

    /// With which of the two rows holds it; nothing where there is nothing.
    fn of(power: &[Power], text: String) -> Self {
        let all = sum(power);
        if all == 0.0 {
            return Self::nowhere();
        }
        let share = power.iter().map(|p| p[0]).sum::<f64>() / all;
        let along = if share > MOST {
            "in the radius"
        } else if share < 1.0 - MOST {
            "in the angle"
        } else {
            "in radius and angle"
        };
        Self {
            rms: Some((all / 2.0).sqrt()),
            along: Some(1.0 - share),
            text: format!("{text}, {along}"),
        }
    }
}
