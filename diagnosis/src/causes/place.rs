//! What is looked for where the revolution shows it: contamination at one place, cogging of one order.

use std::f64::consts::TAU;
use std::rc::Rc;

use nonius_fourier::Complex;
use nonius_quantity::times;

use super::mirror::unmirrored_order;
use super::revolution::{REVOLVING, harmonic, revolving, turns};
use crate::causes::candidate::{Candidate, Domain, Exact, Make, Sign, each};
use crate::context::Context;
use crate::finding::{Cause, Chip, Parameter};
use crate::model::{Residual, Weighed};
use crate::numerics::lines::{cos_and_sin, median};
use crate::numerics::solve::{Normal, without};
use crate::shapes::block::Block;
use crate::shapes::library::{Fill, Library, Shape, Use};

const PLACES: usize = 72;
/// Times that a place has to be passed on average for a dip to come every time.
const AGAIN: f64 = 1.5;
/// Widths of a dip that are tried, radians.
const WIDTHS: [f64; 5] = [0.02, 0.04, 0.08, 0.16, 0.3];

pub(crate) fn candidates(
    context: &Context,
    residual: &Residual,
    library: &mut Library,
) -> Vec<Candidate> {
    let Some(phi) = revolving(context) else {
        return vec![];
    };
    // What comes once is no dip at one place of the revolution every time.
    let way: f64 = phi.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let mut list = if way / TAU > AGAIN * turns(phi).min(1.0) {
        contamination(phi, residual, library)
    } else {
        vec![]
    };
    let fast = residual.fast();
    let per = context.periods_per_revolution.unwrap_or(1);
    let seen = strongest_order(per, phi, fast);
    let order = seen.map(|seen| unmirrored_order(context, (per, phi), fast, seen));
    list.extend(order.map(|order| cogging(per, order, library)));
    list
}

/// Cogging that stands out of noise as the likelihood weighs it: one filter of the noise keeps its size right, the other
/// its phase.
pub(crate) fn weighed(
    context: &Context,
    weighed: &Weighed,
    library: &mut Library,
) -> Vec<Candidate> {
    let Some(phi) = revolving(context) else {
        return vec![];
    };
    let both = [&weighed.fast, &weighed.matched[1]];
    let per = context.periods_per_revolution.unwrap_or(1);
    let orders = both.map(|values| strongest_order(per, phi, values));
    let found = orders.into_iter().flatten();
    found.map(|order| cogging(per, order, library)).collect()
}

/// Highest order of the revolution that is looked at.
fn top_order(per: u32) -> usize {
    /// Orders of the scale period, and of the revolution where there are few of those; and never more than so many. Cogging may have
    /// a second harmonic, which is above what a spline follows where it is itself hardly so.
    const OF_PERIOD: usize = 16;
    const LEAST: usize = 128;
    const MOST: usize = 8192;
    (OF_PERIOD * per as usize).clamp(LEAST, MOST)
}

/// Power of values in each order of the revolution from 0 on: the values are gathered in places so narrow that the highest
/// order loses no more than a hundredth there.
fn orders(phi: &[f64], values: &[f64], top: usize) -> Vec<f64> {
    /// Places in a turn of the highest order.
    const PLACES: usize = 16;
    let length = (PLACES * top).next_power_of_two();
    let mut places = vec![Complex::new(0.0, 0.0); length];
    for (phi, value) in phi.iter().zip(values) {
        let place = (phi / TAU).rem_euclid(1.0) * length as f64;
        places[place as usize % length].re += value;
    }
    nonius_fourier::forward(&mut places);
    places[..=top].iter().map(|z| z.norm_sqr()).collect()
}

/// The order of the revolution that is strongest, multiples of the scale period left out: they could be the sensor's.
pub(crate) fn strongest_order(per: u32, phi: &[f64], values: &[f64]) -> Option<usize> {
    let power = orders(phi, values, top_order(per));
    (1..power.len())
        .filter(|order| order % per as usize != 0)
        .max_by(|a, b| power[*a].total_cmp(&power[*b]))
}

/// cos and sin of an order of the revolution.
pub(crate) fn order_waves(order: usize, phi: &[f64]) -> [Vec<f64>; 2] {
    cos_and_sin(phi, order as f64)
}

/// The order of the revolution that is strongest, how far it stands above what is usual near it, and the values without it.
pub(crate) fn highest_order(
    per: u32,
    phi: &[f64],
    values: &[f64],
) -> Option<(usize, f64, Vec<f64>)> {
    /// Orders up to so many times its own are near, and up to so many.
    const NEAR: usize = 4;
    const LEAST: usize = 32;
    if turns(phi) < REVOLVING {
        return None;
    }
    let order = strongest_order(per, phi, values)?;
    let power = orders(phi, values, (NEAR * order).max(LEAST));
    let usual = median(&power[1..]).max(f64::MIN_POSITIVE);
    let left = without(values, &order_waves(order, phi));
    Some((order, power[order] / usual, left))
}

/// Values without the order of the revolution that is strongest in them, judged by a part of a long recording. A prediction
/// from the past would take it for the colour of the noise, and swallow it.
pub(crate) fn without_cogging(context: &Context, mut values: Vec<f64>) -> Vec<f64> {
    /// Samples that are enough.
    const ENOUGH: usize = 20_000;
    /// Samples that are left together.
    const TOGETHER: usize = 1000;
    let Some(phi) = revolving(context) else {
        return values;
    };
    let every = (values.len() / ENOUGH).max(1);
    let part = |list: &[f64]| -> Vec<f64> {
        let blocks = list.chunks(TOGETHER).step_by(every);
        blocks.flatten().copied().collect()
    };
    let (some, at) = (part(&values), part(phi));
    let per = context.periods_per_revolution.unwrap_or(1);
    let Some(order) = strongest_order(per, &at, &some) else {
        return values;
    };
    let x = Normal::of_columns(&some, &order_waves(order, &at))
        .solve()
        .x;
    for (value, p) in values.iter_mut().zip(phi) {
        let (sin, cos) = (order as f64 * p).sin_cos();
        *value -= x[0] * cos + x[1] * sin;
    }
    values
}

/// Real motion of an order, of all that are looked at with so many periods per revolution.
fn cogging(per: u32, order: usize, library: &mut Library) -> Candidate {
    of_order(order, (per, top_order(per) as f64), library)
}

/// Real motion at orders of the scale period: an error of the sensor there shows in the radius as much as along the circle, but for
/// two harmonics that make up for each other.
pub(super) fn cogging_with_the_period(context: &Context, library: &mut Library) -> Vec<Candidate> {
    /// Orders of the scale period.
    const ORDERS: usize = 8;
    let turning = revolving(context).is_some();
    let per = context
        .periods_per_revolution
        .filter(|per| turning && *per > 1);
    let Some(per) = per else { return vec![] };
    (1..=ORDERS)
        .map(|order| of_order(order * per as usize, (per, ORDERS as f64), library))
        .collect()
}

/// cos and sin of an order of the revolution with so many periods; one of the scale period is the angle's, some times over.
fn wave_of_order(order: usize, per: usize) -> Fill {
    Rc::new(move |block, out| {
        let n = block.len();
        if !order.is_multiple_of(per) {
            for (k, phi) in block.phi.unwrap_or_default().iter().enumerate() {
                (out[n + k], out[k]) = (order as f64 * phi).sin_cos();
            }
            return;
        }
        let top = order / per;
        let mut all = vec![0.0; (2 * top + 1) * n];
        block.waves(top, None, &mut all);
        out.copy_from_slice(&all[(2 * top - 1) * n..]);
    })
}

/// Cogging of an order of the revolution with so many periods, of so many that are looked at.
fn of_order(order: usize, (per, trials): (u32, f64), library: &mut Library) -> Candidate {
    let make: Make = Rc::new(move |_, library| {
        let place = library.add(2, Use::Motion, wave_of_order(order, per as usize));
        [0, 1].map(|i| place.tangential(i)).into()
    });
    let of_revolution = Some(order);
    let order = order as u32;
    let shapes = make(&[], library);
    Candidate {
        trials,
        of_revolution,
        motion: true,
        exact: Some(Exact {
            make,
            inner: vec![],
            steps: vec![],
            follows: false,
        }),
        chip: Chip::NotASensorError,
        parameters: harmonic(order, "amplitude", "rad"),
        evidence: Rc::new(move |p| {
            format!(
                "the axis moves unevenly {} per revolution, with an amplitude of {} of electrical angle; the radius does not change",
                times(order as usize),
                p[1].brief()
            )
        }),
        ..Candidate::new(Cause::Cogging, Domain::Motion, shapes)
    }
}

/// A dip of a centre and a width, in radians of the revolution.
fn dip(inner: &[f64], library: &mut Library) -> Vec<Shape> {
    let (centre, width) = (inner[0], inner[1].max(1e-3));
    let place = library.add(
        1,
        Use::Radial,
        Rc::new(move |block: &Block, out: &mut [f64]| {
            for (o, p) in out.iter_mut().zip(block.phi.unwrap_or_default()) {
                let mut off = p - centre;
                // A division is slow, and seldom needed.
                if off.abs() > TAU / 2.0 {
                    off = (off + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0;
                }
                let x = 0.5 * (off / width).powi(2);
                *o = if x < 40.0 { -(-x).exp() } else { 0.0 };
            }
        }),
    );
    vec![place.radial(0)]
}

/// A dip of the amplitude at one place, every revolution.
fn contamination(phi: &[f64], residual: &Residual, library: &mut Library) -> Vec<Candidate> {
    let place = |p: f64| ((p.rem_euclid(TAU) / TAU * PLACES as f64) as usize).min(PLACES - 1);
    let (mut sum, mut count) = (vec![0.0; PLACES], vec![0.0; PLACES]);
    for (p, r) in phi.iter().zip(&residual.radial) {
        sum[place(*p)] += r;
        count[place(*p)] += 1.0;
    }
    let mean: Vec<f64> = sum
        .iter()
        .zip(&count)
        .map(|(s, c): (&f64, &f64)| s / c.max(1.0))
        .collect();
    let Some(lowest) = (0..PLACES).min_by(|a, b| mean[*a].total_cmp(&mean[*b])) else {
        return vec![];
    };
    let mut list = vec![];
    for shift in [-0.5, 0.0, 0.5] {
        for width in WIDTHS {
            let centre = (lowest as f64 + 0.5 + shift) / PLACES as f64 * TAU;
            let shapes = dip(&[centre, width], library);
            list.push(Candidate {
                trials: PLACES as f64 * WIDTHS.len() as f64,
                exact: Some(Exact {
                    make: Rc::new(dip),
                    inner: vec![centre, width],
                    steps: vec![0.02 * width, 0.02 * width],
                    follows: false,
                }),
                sign: Sign::Positive,
                parameters: Rc::new(move |e| {
                    let mut all = each(&["depth"], "1")(e);
                    // For a dip of Gaussian shape.
                    let share = e.error[0] / e.x[0].abs().max(1e-12);
                    let bound = |i: usize| e.inner_error.map_or(e.inner[1] * share, |d| d[i]);
                    all.push(Parameter::measured("place", e.inner[0], bound(0), "rad"));
                    all.push(Parameter::measured("width", e.inner[1], bound(1), "rad"));
                    all
                }),
                evidence: Rc::new(|p| {
                    format!(
                        "the amplitude of both channels dips by {} in every revolution, at {} from the scale period of the first sample",
                        p[0].brief(),
                        p[1].brief()
                    )
                }),
                ..Candidate::new(Cause::Contamination, Domain::Revolution, shapes)
            });
        }
    }
    list
}

#[cfg(test)]
mod tests {
    use super::{TAU, strongest_order};

    /// To and fro over three turns, at places that hardly come again.
    #[test]
    fn every_order_up_to_eight_periods_is_found_and_those_of_the_period_are_not() {
        let phi: Vec<f64> = (0..20_000)
            .map(|k| 1.5 * TAU * (f64::from(k) * 7e-4).sin() - 0.4)
            .collect();
        for (per, order) in [(5, 1), (5, 127), (50, 151), (50, 399), (1000, 7999)] {
            let small = |p: &f64| (f64::from(order) * p + 0.3).cos();
            let large = |p: &f64| 3.0 * (f64::from(2 * per) * p).sin();
            let values: Vec<f64> = phi.iter().map(|p| small(p) + large(p)).collect();
            assert_eq!(strongest_order(per, &phi, &values), Some(order as usize));
        }
    }
}
