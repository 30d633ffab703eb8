//! Noise whose size depends on something: on the signal, on the speed.
//!
//! What the model leaves is whitened; then the squares of its residuals, and their product, tell how the covariance depends
//! on angle, speed and time (Gaussian likelihood). A name is given where one shape holds what knots over all three explain,
//! and where what is called random is no line.

pub(crate) mod flicker;
pub(crate) mod louder;
mod variance;
mod wandering;

use crate::context::Context;
use crate::finding::{Cause, Chip, Finding, Gain, Parameter};
use crate::model::whiten::Whitener;
use crate::model::{ROUNDING, Residual, System};
use crate::noise::variance::{ENOUGH, Fitted, Pairs, Products, Shapes};
use crate::numerics::statistics::{at_most_of_noise, by_chance};
use crate::select::score::SHOWN;
use crate::shapes::generic::{HOLDS, hat};
use crate::unnamed::unexplained::{Unnamed, What, explains_only, like};

/// Shapes of noise that could have been claimed.
const TRIALS: f64 = 30.0;
/// Knots in time and over the speeds.
const KNOTS: [usize; 2] = [8, 6];
/// Orders of the period that noise may depend on.
const ORDERS: [f64; 3] = [1.0, 2.0, 4.0];
/// Standard errors by which an amount that a part of the samples gives is below nothing for sure.
const SURELY: f64 = 3.0;
/// Standard errors below which an amount is shown by nothing.
const FAINT: f64 = 2.0;
/// Noise of either residual, and unequal and common noise of the channels.
const BASE: usize = 4;

/// A kind of noise.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Amplitude,
    Jitter,
}

impl Kind {
    fn other(self) -> Self {
        match self {
            Self::Amplitude => Self::Jitter,
            Self::Jitter => Self::Amplitude,
        }
    }
}

/// What noise depends on, sample by sample.
struct Dependence<'a> {
    context: &'a Context,
}

impl Dependence<'_> {
    /// The covariance that more noise of the cosine makes, and less of the sine; and that noise in common makes: where the
    /// channels are not at right angles, the correction of the sine brings that of the cosine along.
    fn channels(&self, k: usize) -> [Products; 2] {
        let (c, s) = (self.context.cos[k], self.context.sin[k]);
        let (unequal, common) = (c * c - s * s, 2.0 * c * s);
        [
            Products([unequal, -unequal, -common]),
            Products([common, -common, unequal]),
        ]
    }

    /// The covariance that a kind of noise makes, before it is whitened.
    fn kind(&self, kind: Kind, k: usize) -> Products {
        match kind {
            Kind::Amplitude => {
                let (c, s) = (self.context.cos[k], self.context.sin[k]);
                let (cc, ss) = (c * c, s * s);
                Products([cc * cc + ss * ss, 2.0 * cc * ss, c * s * (ss - cc)])
            }
            Kind::Jitter => {
                let speed = self.context.speed[k] / self.context.top_speed();
                Products([0.0, speed * speed, 0.0])
            }
        }
    }

    /// What so much of a kind of noise does to a pair, rms in amplitudes.
    fn rms(&self, kind: Kind, amount: f64) -> f64 {
        let weight = &self.context.weight;
        let power = |k: usize| {
            let [radial, tangential, _] = self.kind(kind, k).0;
            weight[k] * (radial + tangential)
        };
        let sum: f64 = (0..weight.len()).map(power).sum();
        let total: f64 = weight.iter().sum();
        (amount * sum / total).sqrt()
    }

    /// Knots in time and over the speeds, of either residual's variance; then waves of the angle, of what they have in
    /// common, too.
    fn anything(&self, k: usize, out: &mut [Products]) {
        out.fill(Products::default());
        let context = self.context;
        let when = k as f64 / context.samples() as f64;
        let fast = context.speed[k].abs() / context.top_speed();
        let (knots, waves) = out.split_at_mut(2 * (KNOTS[0] + KNOTS[1]));
        for (row, own) in knots.chunks_mut(KNOTS[0] + KNOTS[1]).enumerate() {
            let (in_time, over_speeds) = own.split_at_mut(KNOTS[0]);
            for (i, o) in in_time.iter_mut().enumerate() {
                o.0[row] = hat(KNOTS[0], i, when);
            }
            for (i, o) in over_speeds.iter_mut().enumerate() {
                o.0[row] = hat(KNOTS[1], i, fast);
            }
        }
        for (waves, order) in waves.chunks_mut(2 * 3).zip(ORDERS) {
            let (sin, cos) = (order * context.alpha[k]).sin_cos();
            for (product, pair) in waves.chunks_mut(2).enumerate() {
                pair[0].0[product] = cos;
                pair[1].0[product] = sin;
            }
        }
    }
}

/// Numbers of [`Dependence::anything`].
const ANYTHING: usize = 2 * (KNOTS[0] + KNOTS[1]) + 3 * 2 * ORDERS.len();

/// Kinds of noise in a residual, and what depends on something and is none of them; `stepped`: the reference moves in steps that show.
/// Where the codes err by `coded`, in amplitudes rms, that goes with angle and speed as well: only what is larger is told.
pub(crate) fn findings(
    system: &System,
    residual: &Residual,
    (stepped, coded): (bool, f64),
) -> (Vec<Finding>, Vec<Unnamed>) {
    let context = system.context;
    let whiteners = &system.samples.whiteners;
    let left = [&residual.radial, &residual.tangential];
    let white: Vec<Vec<f64>> = left
        .iter()
        .zip(whiteners)
        .map(|(values, whitener)| whitener.unpredictable(values))
        .collect();
    let total: f64 = context.weight.iter().sum();
    let power: Vec<f64> = white
        .iter()
        .map(|w| w.iter().map(|w| w * w).sum::<f64>() / total.max(1.0))
        .collect();
    // Of a reference that the angle follows exactly nothing is left, and of calculated numbers their rounding.
    let nothing = |(p, w): (&f64, &Whitener)| p.sqrt() * w.sigma < ROUNDING;
    if power.iter().zip(whiteners).any(nothing) {
        return (vec![], vec![]);
    }
    let rms: Vec<f64> = power.iter().map(|p| p.sqrt()).collect();
    // What white noise of unit variance in the channels would be of the mean products.
    let unit = [(0, 0), (1, 1), (0, 1)]
        .map(|(row, other)| whiteners[row].of_white(&whiteners[other]) / (rms[row] * rms[other]));
    let in_rms = |row: usize| -> Vec<f64> { white[row].iter().map(|w| w / rms[row]).collect() };
    let pairs = Pairs {
        rows: [in_rms(0), in_rms(1)],
        weight: &context.weight,
        every: 1,
    };
    let seen = Seen {
        depends: Dependence { context },
        pairs,
        unit,
        tangential: &white[1],
        coded,
    };
    // Along the circle the rounding of a reference that moves in steps is louder wherever the axis is slow.
    let kinds = [Kind::Amplitude, Kind::Jitter];
    let kinds = kinds
        .into_iter()
        .filter(|kind| !(stepped && *kind == Kind::Jitter));
    let (mut list, mut unnamed) = (vec![], vec![]);
    for judged in kinds.filter_map(|kind| seen.judge(kind)) {
        match judged {
            Ok(finding) => list.push(finding),
            Err(one) => unnamed.push(one),
        }
    }
    (list, unnamed)
}

/// What is left, as noise is looked for in it.
struct Seen<'a> {
    depends: Dependence<'a>,
    pairs: Pairs<'a>,
    /// Mean products of white noise of unit variance in the channels.
    unit: [f64; 3],
    /// What is left along the circle, whitened, in amplitudes.
    tangential: &'a [f64],
    /// Error of the codes, in amplitudes rms.
    coded: f64,
}

impl Seen<'_> {
    /// A kind of noise by its name, or noise that depends on something as it does and is not of that kind.
    fn judge(&self, kind: Kind) -> Option<Result<Finding, Unnamed>> {
        let (depends, pairs, unit) = (&self.depends, &self.pairs, &self.unit);
        // In units in which the shape of the kind has a mean near one in the row that shows it.
        let scale = unit[usize::from(kind == Kind::Jitter)];
        let whitened = |of: Products| Products([0, 1, 2].map(|i| of.0[i] * unit[i] / scale));
        let both = |k: usize, out: &mut [Products]| {
            out[0] = Products([1.0, 0.0, 0.0]);
            out[1] = Products([0.0, 1.0, 0.0]);
            out[2..BASE].copy_from_slice(&depends.channels(k).map(whitened));
            out[BASE] = whitened(depends.kind(kind.other(), k));
            if let Some(own) = out.get_mut(BASE + 1) {
                *own = whitened(depends.kind(kind, k));
            }
        };
        let plain = [1.0, 1.0, 0.0, 0.0, 0.0];
        let (with, error) = pairs.rough_fit([&plain[..], &[0.0]].concat(), &both);
        // Less noise than none is of no kind.
        let unsure = if pairs.is_rough() { SURELY } else { 0.0 };
        if with[BASE + 1] <= -unsure * error[BASE + 1] {
            return None;
        }
        let mut own = pairs.clone();
        own.cut(&with, &both);
        let with = own.fit(with, &both);
        let variance = with.covariance[(BASE + 1, BASE + 1)];
        if with.x[BASE + 1] <= FAINT * variance.max(0.0).sqrt() {
            return None;
        }
        let without = own.fit(plain.to_vec(), &both);
        // At constant speed the noise of a clock is white noise of the angle, and of the two one number is seen.
        if with.rank <= without.rank {
            return None;
        }
        let gain = with.likelihood - without.likelihood;
        let log_p = |gain: f64| by_chance(gain, 1.0, 1, TRIALS);
        // What independent pairs do not show, others show less.
        if log_p(gain) > SHOWN.ln() {
            return None;
        }
        let inflation = own.inflation(&with, &both);
        let gain = gain / inflation;
        let log_p = log_p(gain);
        if log_p > SHOWN.ln() {
            return None;
        }
        let held_out = own.held_out(&with.x, &both) / inflation;
        // What data that was not fitted speaks against has no name.
        if held_out <= 0.0 {
            return None;
        }
        if kind == Kind::Jitter && !wandering::is_at_random(depends.context, &own.rows[1]) {
            return wandering::in_a_line(depends.context, self.tangential, gain).map(|how| {
                let what = What::Said(wandering::sentence(&how));
                Err(Unnamed { log_p, gain, what })
            });
        }
        let amount = with.x[BASE + 1] / scale;
        if depends.rms(kind, amount) < self.coded {
            return None;
        }
        if let Some(why) = self.refusal(own, kind, &with, [gain, inflation], &both) {
            let what = What::Said(why);
            return (self.coded == 0.0).then_some(Err(Unnamed { log_p, gain, what }));
        }
        let error = (variance * inflation).sqrt() / scale;
        let top = depends.context.top_speed();
        Some(Ok(finding(
            kind,
            [amount, error],
            top,
            [gain, held_out],
            log_p,
        )))
    }

    /// Why noise that depends on something is not of a kind, which explains `gain` where products that go together make
    /// everything look so many times as sure as it is.
    fn refusal(
        &self,
        mut pairs: Pairs,
        kind: Kind,
        with: &Fitted,
        [gain, inflation]: [f64; 2],
        shapes: &Shapes,
    ) -> Option<String> {
        let n = self.tangential.len();
        let name = match kind {
            Kind::Amplitude => Cause::AmplitudeNoise,
            Kind::Jitter => Cause::ClockJitter,
        };
        pairs.every = n.div_ceil(ENOUGH);
        let named = with.x.len();
        let anything = |k: usize, out: &mut [Products]| {
            shapes(k, &mut out[..named]);
            self.depends.anything(k, &mut out[named..]);
        };
        let known = pairs.fit(with.x.clone(), shapes);
        let any = pairs.fit([&with.x[..], &[0.0; ANYTHING]].concat(), &anything);
        // What as many free numbers explain of noise that is of the kind does not count against it.
        let chance = at_most_of_noise(any.rank.saturating_sub(known.rank));
        let beyond = (any.likelihood - known.likelihood - chance).max(0.0) * pairs.every as f64;
        let share = gain / (gain + beyond / inflation);
        if share < HOLDS {
            return Some(format!(
                "the noise level varies with angle, speed or time, at a detection SNR of {:.0}; {}",
                (2.0 * (gain + beyond / inflation)).sqrt(),
                like(name, &explains_only(share))
            ));
        }
        if kind == Kind::Jitter {
            let how = wandering::how(self.depends.context, self.tangential, gain);
            return how.map(|how| wandering::sentence(&how));
        }
        None
    }
}

/// Whether noise of a kind explains so much more than what looks like no cause that it is the reason for that: noise that
/// grows with the speed makes shapes of the speed explain more of it than they do by chance.
pub(crate) fn is_the_reason(noisy: &[Finding], left: &[Unnamed]) -> bool {
    const FAR_LOUDER: f64 = 20.0;
    let most = left.iter().map(|u| u.gain).fold(0.0, f64::max);
    noisy.iter().any(|f| f.weight > FAR_LOUDER * most)
}

/// `gain` and `held_out`: log-likelihood of all data, and of data that was not fitted.
fn finding(
    kind: Kind,
    [amount, error]: [f64; 2],
    top: f64,
    [gain, held_out]: [f64; 2],
    log_p: f64,
) -> Finding {
    let (value, error) = (amount.sqrt(), error / (2.0 * amount.sqrt()));
    let (cause, parameter) = match kind {
        Kind::Jitter => (
            Cause::ClockJitter,
            Parameter::measured("rms_s", value / top, error / top, "s"),
        ),
        Kind::Amplitude => (
            Cause::AmplitudeNoise,
            Parameter::measured("rms", value, error, "1"),
        ),
    };
    let size = parameter.brief();
    let evidence = match kind {
        Kind::Jitter => format!(
            "the noise of the angle grows with speed, as from a sampling clock with a jitter of {size} rms"
        ),
        Kind::Amplitude => {
            format!("the noise of each channel is proportional to its signal: {size} of it, rms")
        }
    };
    Finding {
        cause,
        confounded_with: vec![],
        p_value: log_p.exp(),
        parameters: vec![parameter],
        gain: Gain {
            held_out_log_likelihood_gain: Some(held_out),
            ..Gain::of(gain)
        },
        evidence,
        chip: Chip::CannotCorrect,
        design: vec![],
        weight: gain,
        effect: None,
        place: None,
    }
}
