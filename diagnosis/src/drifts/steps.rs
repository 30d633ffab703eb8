//! Whether what changes with time does so in steps, as a gain that is switched or a contact that gives does, and not slowly,
//! as a drift: a polynomial of time follows a few steps nearly as well. Steps at the best places, found by dynamic
//! programming over stretches of the recording, stand against straight lines between evenly spaced knots; the numbers of
//! either are paid for (Bayesian information criterion). Whatever shape a slow change has, lines follow it with fewer
//! numbers than steps do.

use nalgebra::{DMatrix, DVector};

use crate::drifts::channels::{Channels, Row};
use crate::drifts::warming::{self, Warming};
use crate::numerics::pair::PairSums;
use crate::numerics::polygon::{CHANNELS, PIECES, Polygon};
use crate::numerics::polynomial;
use crate::numerics::solve::Normal;
use crate::numerics::statistics::price;
use crate::shapes::generic::hat;

/// Stretches of the recording between which a step may stand.
const STRETCHES: usize = 200;
/// Most steps.
const MOST: usize = 24;
/// Knots of the lines: as few as follow it are the best.
const KNOTS: [usize; 8] = [2, 3, 4, 6, 8, 12, 20, 40];
/// Degrees of curves that a slow change may follow.
const DEGREES: [usize; 3] = [2, 3, 6];

/// Log-likelihood by which lines have to explain more than steps do of what is strong: a slow change does by far.
const CLEARLY: f64 = 15.0;
/// From which log-likelihood of lines on it is strong: an SNR of 30.
const STRONG: f64 = 450.0;

/// What changes.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Change {
    Gains,
    /// Both gains alike.
    Radius,
    Offsets,
}

impl Change {
    /// Numbers of a step and of a knot.
    fn numbers(self) -> usize {
        match self {
            Self::Radius => 1,
            Self::Gains | Self::Offsets => CHANNELS,
        }
    }
}

/// What is seen of both channels, in units of the noise.
struct Changing<'a> {
    seen: Channels<'a>,
    /// Rms.
    noise: f64,
    change: Change,
}

/// Log-likelihood that steps explain of what is seen, with noise of that rms, where lines do not explain as much of whichever of
/// these changes.
pub(crate) fn instead(seen: Channels, noise: f64, changes: &[Change]) -> Option<f64> {
    let samples = seen.samples();
    let count = STRETCHES.min(samples / 8);
    if count < 2 || noise <= 0.0 {
        return None;
    }
    // Of a number.
    let price = price(samples as f64);
    let (mut lines, mut steps) = (f64::MIN, f64::MIN);
    for change in changes {
        let changing = Changing {
            seen,
            noise,
            change: *change,
        };
        let stretches: Vec<PairSums> = (0..count)
            .map(|i| changing.sums(i * samples / count..(i + 1) * samples / count))
            .collect();
        let of_lines = KNOTS.into_iter().map(|knots| changing.lines(knots, price));
        lines = of_lines.fold(lines, f64::max);
        let (gram, right) = changing.products(PIECES + 1);
        let bent = Polygon::new(&gram, &right).explained(price, change.numbers());
        lines = lines.max(bent);
        // What bends evenly needs fewer numbers than lines do.
        let curved = DEGREES
            .map(|degree| polynomial::explained(&gram, &right, degree, price, change.numbers()));
        lines = curved.into_iter().fold(lines, f64::max);
        let warmed = warming::best(&gram, &right).map(|w| w.paid(price, change.numbers()));
        lines = lines.max(warmed.unwrap_or(f64::MIN));
        let numbers = change.numbers() as f64;
        steps = steps.max(self::steps(
            &stretches,
            numbers * price + (count as f64).ln(),
        ));
    }
    let clearly = if lines > STRONG { CLEARLY } else { 0.0 };
    (lines < steps + clearly).then_some(steps)
}

/// How what is seen warms up, if it does.
pub(crate) fn warming(seen: Channels, noise: f64, change: Change) -> Option<Warming> {
    let changing = Changing {
        seen,
        noise,
        change,
    };
    if seen.samples() < 2 || noise <= 0.0 {
        return None;
    }
    let (gram, right) = changing.products(PIECES + 1);
    warming::best(&gram, &right)
}

impl Changing<'_> {
    /// What amounts of one make of what a sample shows, and that.
    fn rows(&self, k: usize) -> impl Iterator<Item = [f64; 3]> {
        let context = self.seen.context;
        let (cos, sin) = (context.cos[k], context.sin[k]);
        let amounts = move |Row { of: [c, s], left }: Row| {
            let [c, s] = match self.change {
                Change::Gains => [c * cos, s * sin],
                Change::Radius => [c * cos + s * sin, 0.0],
                Change::Offsets => [c, s],
            };
            [c, s, left / self.noise].map(|v| v * context.weight[k])
        };
        self.seen.rows(k).map(amounts)
    }

    fn sums(&self, of: std::ops::Range<usize>) -> PairSums {
        let mut sums = PairSums::default();
        for k in of {
            for [c, s, r] in self.rows(k) {
                sums.add(c, s, r, 1.0);
            }
        }
        sums
    }

    /// Sums of products of the values at so many knots, between which lines run.
    fn products(&self, knots: usize) -> (DMatrix<f64>, DVector<f64>) {
        let m = CHANNELS * knots;
        let (mut gram, mut right) = (DMatrix::zeros(m, m), DVector::zeros(m));
        let last = (self.seen.samples() - 1) as f64;
        for k in 0..self.seen.samples() {
            let when = k as f64 / last;
            let first = ((when * (knots - 1) as f64) as usize).min(knots - 2);
            // Two knots are near, each with both channels.
            let near = [first, first + 1].map(|i| hat(knots, i, when));
            for [c, s, r] in self.rows(k) {
                let all = [near[0] * c, near[0] * s, near[1] * c, near[1] * s];
                for (i, a) in all.iter().enumerate() {
                    right[CHANNELS * first + i] += a * r;
                    for (j, b) in all.iter().enumerate() {
                        gram[(CHANNELS * first + i, CHANNELS * first + j)] += a * b;
                    }
                }
            }
        }
        (gram, right)
    }

    /// Log-likelihood that lines between so many knots explain, each number beyond the first of a channel at its price.
    fn lines(&self, knots: usize, price: f64) -> f64 {
        let (gram, right) = self.products(knots);
        // Knots while the scale stands still have no numbers.
        let lines = Normal::new(gram, right, 0.0).solve();
        lines.gain() - price * (lines.rank as f64 - self.change.numbers() as f64)
    }
}

/// Log-likelihood that steps between stretches explain, each at its price; nothing where more of them would explain more
/// still: a stair that follows a curve has no end.
fn steps(stretches: &[PairSums], price: f64) -> f64 {
    let count = stretches.len();
    let mut total = PairSums::default();
    let mut up_to = vec![total];
    for sums in stretches {
        total += *sums;
        up_to.push(total);
    }
    // Gain in log-likelihood of the best amounts.
    let within = |from: usize, to: usize| 0.5 * (up_to[to] - up_to[from]).explained();
    let one: Vec<Vec<f64>> = (0..count)
        .map(|from| (from + 1..=count).map(|to| within(from, to)).collect())
        .collect();
    // The most that so many steps explain up to the end of each stretch.
    let mut best: Vec<f64> = one[0].clone();
    let (mut most, mut enough) = (best[count - 1], 0);
    for steps in 1..=MOST.min(count - 1) {
        best = (0..count)
            .map(|end| {
                let with = (0..end).map(|before| best[before] + one[before + 1][end - before - 1]);
                with.fold(best[end], f64::max)
            })
            .collect();
        let gain = best[count - 1] - price * steps as f64;
        if gain > most {
            (most, enough) = (gain, steps);
        }
    }
    if enough < MOST { most } else { f64::MIN }
}
