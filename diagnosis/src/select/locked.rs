//! Lines that stand where something else has its frequency: at one speed what goes with the angle, or with the place on the revolution, and
//! along a motion that comes again what goes with the motion.

use crate::causes;
use crate::causes::candidate::{Candidate, Domain};
use crate::context::Context;
use crate::finding::Cause;
use crate::numerics::lines::strongest;
use crate::select::score::Scored;

/// Highest order of the scale period at which a line may stand.
const TOP: i32 = causes::ORDERS as i32;
/// Orders beyond those that the catalogue has.
const BEYOND: std::ops::RangeInclusive<i32> = 8..=16;
/// Orders of the revolution, by themselves and beside those of the scale period.
const OF_REVOLUTION: i32 = 4;
/// Orders of a motion to and fro.
const OF_MOTION: u32 = 12;
/// Fewest scale periods, so that hardly a line stands at their orders by chance.
const PERIODS: f64 = 50.0;
/// Fewest times that a motion comes again.
const AGAIN: f64 = 2.0;
/// So many times as far as a line may be off its place the next one is, so that hardly a line stands there by chance.
const APART: f64 = 5.0;

/// Cycles per recording by which a line may be off a place where lines are seldom.
const NEAR: f64 = 0.7;
/// The same of places that are many: for a detection SNR of one, at least, and of each order of a motion more.
const KNOWN: f64 = 2.5;
const LEAST: f64 = 0.1;
const EACH: f64 = 0.02;

const WITH_ANGLE: &str =
    "at this constant speed an error that goes with the angle has that frequency, too";
const WITH_REVOLUTION: &str =
    "at this constant speed an error that goes with the revolution has that frequency, too";
const WITH_MOTION: &str = "what goes with this motion to and fro has that frequency, too: it is a multiple of the motion's";

/// Why a line says nothing by itself of what it is.
pub(super) fn why(context: &Context, own: &Scored) -> Option<&'static str> {
    let candidate = &own.candidate;
    if goes_with_angle(context, candidate) {
        return Some(WITH_ANGLE);
    }
    let near = (KNOWN / (2.0 * own.gain).sqrt()).clamp(LEAST, NEAR);
    let orders = BEYOND.map(|m| (0.0, f64::from(m)));
    if stands_at(context, candidate, near, orders) {
        return Some(WITH_ANGLE);
    }
    // Vibration is of the axis, and goes with its revolution and its motion.
    let hertz = candidate
        .inner()
        .filter(|_| candidate.domain == Domain::Line)?;
    let per = context.periods_per_revolution.map(f64::from);
    let turns = per.map_or(0.0, |per| context.periods_travelled() / per);
    if let Some(per) = per.filter(|per| *per > 1.0 && turns > APART * near) {
        let beside = (0..=2).flat_map(|order| (1..=OF_REVOLUTION).map(move |m| (order, m)));
        let places = beside.flat_map(|(order, m)| {
            let (order, apart) = (f64::from(order), f64::from(m) / per);
            [(0.0, order + apart), (0.0, (order - apart).abs())]
        });
        if stands_at(context, candidate, near, places) {
            return Some(WITH_REVOLUTION);
        }
    }
    comes_again(context)
        .is_some_and(|motion| {
            let duration = context.samples() as f64 / context.rate;
            (1..=OF_MOTION).map(f64::from).any(|order| {
                let near = near + EACH * order;
                let told = motion * duration > APART * near;
                told && (hertz - order * motion).abs() * duration < near
            })
        })
        .then_some(WITH_MOTION)
}

/// Frequency of a motion that goes to and fro as a sine does, Hz.
fn comes_again(context: &Context) -> Option<f64> {
    /// Share of the square of the speed.
    const MOST: f64 = 0.8;
    let n = context.speed.len();
    let every = (n / 4096).max(1);
    let means = context.speed.chunks_exact(every);
    let speed: Vec<f64> = means
        .map(|c| c.iter().sum::<f64>() / c.len() as f64)
        .collect();
    let (cycles, left) = strongest(&speed);
    let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
    let again =
        cycles * speed.len() as f64 > AGAIN && square(&left) < (1.0 - MOST) * square(&speed);
    again.then(|| cycles * context.rate / every as f64)
}

/// Whether, at a speed that hardly changes, a line stands where something that goes with the angle would: at half orders of
/// the scale period, or at whole ones beside a fourth or half of the sample rate, where a multiplexer puts them.
fn goes_with_angle(context: &Context, candidate: &Candidate) -> bool {
    let halves = (1..2 * TOP).step_by(2).map(|m| (0.0, 0.5 * f64::from(m)));
    let beside_rate = (-TOP..=TOP).flat_map(|m| [0.25, 0.5].map(|share| (share, f64::from(m))));
    stands_at(context, candidate, NEAR, halves.chain(beside_rate))
}

/// Whether a line stands, at a speed that hardly changes, at a whole order of the scale period.
pub(crate) fn is_at_an_order(context: &Context, candidate: &Candidate) -> bool {
    let orders = (1..=*BEYOND.end()).map(|m| (0.0, f64::from(m)));
    stands_at(context, candidate, LEAST, orders)
}

/// Whether, at a speed that hardly changes, a line with its harmonics stands where harmonics of the scale period do: together they look
/// like that, and each of them is told by itself.
pub(super) fn is_of_orders(context: &Context, candidate: &Candidate) -> bool {
    let orders = (1..=TOP).map(|m| (0.0, f64::from(m)));
    causes::has_harmonics(candidate) && stands_at(context, candidate, NEAR, orders)
}

/// Whether a line stands, at a speed that hardly changes, so near, in cycles per recording, to a share of the sample rate and an order of
/// the scale period from there.
fn stands_at(
    context: &Context,
    candidate: &Candidate,
    near: f64,
    mut places: impl Iterator<Item = (f64, f64)>,
) -> bool {
    // Vibration too: where it goes with the angle it may be an error of the sensor.
    let line = candidate.domain == Domain::Line || candidate.name == Cause::Vibration;
    let many = context.periods_travelled() > PERIODS;
    let told = line && many && !causes::speed_varies_much(context);
    let Some(hertz) = candidate.inner().filter(|_| told) else {
        return false;
    };
    let duration = context.samples() as f64 / context.rate;
    let turning = context.periods_travelled() / duration;
    places.any(|(share, order)| {
        (hertz - share * context.rate - order * turning).abs() * duration < near
    })
}
