//! What repeats with the revolution: run-out, graduation.

use std::f64::consts::TAU;
use std::rc::Rc;

use nonius_quantity::times;

use super::Catalogue;
use crate::causes::candidate::{Candidate, Domain, polar};
use crate::context::Context;
use crate::finding::{Cause, Chip, Parameter};
use crate::numerics::ends::span;
use crate::shapes::block::Block;
use crate::shapes::generic::{BOTH, Modulation, Of, per_channel};
use crate::shapes::library::{Shape, Use};

/// Orders of the revolution that a generic error has.
pub(crate) const ORDERS: usize = 12;

/// Orders of it that the channels' gains by themselves have, and their offsets: dirt over one channel, and a stray field that turns.
const APART: [usize; 2] = [8, 1];
/// Revolutions from which on those are told from what the period does.
const ENOUGH: f64 = 2.0;

/// cos and sin of orders 1 … `top` of the revolution, one after the other.
fn waves(block: &Block, top: usize, out: &mut [f64]) {
    let Some(phi) = block.phi else { return };
    let n = block.len();
    for k in 0..n {
        (out[n + k], out[k]) = phi[k].sin_cos();
    }
    for order in 1..top {
        for k in 0..n {
            let (c, s) = (out[k], out[n + k]);
            let (last_c, last_s) = (out[(2 * order - 2) * n + k], out[(2 * order - 1) * n + k]);
            out[2 * order * n + k] = last_c * c - last_s * s;
            out[(2 * order + 1) * n + k] = last_s * c + last_c * s;
        }
    }
}

/// Revolutions between the ends of the motion.
pub(crate) fn turns(phi: &[f64]) -> f64 {
    span(phi.iter().copied()) / TAU
}

/// Revolutions from which on what comes with them is looked for.
pub(super) const REVOLVING: f64 = 0.9;

/// Angle of the revolution, radians, where the motion goes that far.
pub(crate) fn revolving(context: &Context) -> Option<&Vec<f64>> {
    context.phi.as_ref().filter(|phi| turns(phi) >= REVOLVING)
}

/// Orders of the radius, lowest first.
const RADIAL: std::ops::RangeInclusive<u32> = 1..=3;

pub(crate) fn enter(context: &Context, catalogue: &mut Catalogue) {
    if context.phi.is_none() {
        return;
    }
    let against = context.against_reference.is_some();
    let way = if against { Use::Both } else { Use::Radial };
    let place = catalogue.library.add(
        2 * ORDERS,
        way,
        Rc::new(|block, out| waves(block, ORDERS, out)),
    );
    let all = (0..2 * ORDERS).flat_map(|i| [place.radial(i), place.tangential(i)]);
    catalogue.generic(Domain::Revolution, all.filter(|s| !s.0.is_empty()));
    if revolving(context).is_none() {
        return;
    }
    let list = &mut catalogue.candidates;
    for order in RADIAL {
        let first = 2 * order as usize - 2;
        let shapes: Vec<Shape> = [first, first + 1].map(|i| place.radial(i)).into();
        list.push(Candidate {
            trials: f64::from(*RADIAL.end()),
            parameters: harmonic(order, "depth", "1"),
            evidence: Rc::new(move |p| {
                format!(
                    "the amplitude of both channels varies {} per revolution, by ± {}",
                    times(order as usize),
                    p[1].brief()
                )
            }),
            ..Candidate::new(Cause::Runout, Domain::Revolution, shapes)
        });
    }
    let cogging = super::place::cogging_with_the_period(context, &mut catalogue.library);
    let list = &mut catalogue.candidates;
    list.extend(cogging);
    if against {
        for order in 1..=ORDERS as u32 {
            let first = 2 * order as usize - 2;
            let shapes: Vec<Shape> = [first, first + 1].map(|i| place.tangential(i)).into();
            list.push(Candidate {
                trials: ORDERS as f64,
                // Where a scale period is a revolution, it is two harmonics, which the chip's table takes.
                chip: if context.periods_per_revolution == Some(1) && order >= 3 {
                    Chip::Corrects
                } else {
                    Chip::CannotCorrect
                },
                parameters: harmonic(order, "amplitude", "rad"),
                evidence: Rc::new(move |p| {
                    format!(
                        "the angle error against the reference repeats {} per revolution, with an amplitude of {} of electrical angle",
                        times(order as usize),
                        p[1].brief()
                    )
                }),
                ..Candidate::new(Cause::GraduationError, Domain::Revolution, shapes)
            });
        }
    }
}

/// What the channels have of the revolution each by itself.
pub(crate) fn enter_apart(context: &Context, catalogue: &mut Catalogue) {
    let turning = context.phi.as_ref().is_some_and(|phi| turns(phi) >= ENOUGH);
    if !turning {
        return;
    }
    // The gain of one channel: that of both is there.
    let kinds: [(&[usize], &[Of]); 2] = [(&[0], &[Of::Gain]), (BOTH, &[Of::Offset])];
    for (of, top) in kinds.into_iter().zip(APART) {
        let one: Modulation = Rc::new(move |block, i, out| {
            let order = (i / 2 + 1) as f64;
            for (o, p) in out.iter_mut().zip(block.phi.unwrap_or_default()) {
                let (sin, cos) = (order * p).sin_cos();
                *o = if i % 2 == 0 { cos } else { sin };
            }
        });
        let apart = per_channel(of, 2 * top, one, &mut catalogue.library);
        catalogue.generic(Domain::Revolution, apart);
    }
}

pub(super) fn harmonic(
    order: u32,
    name: &'static str,
    unit: &'static str,
) -> crate::causes::candidate::Reads {
    Rc::new(move |e| {
        let (a, d, p, ep) = polar(e.x, e.error);
        vec![
            Parameter::exact("order", f64::from(order), "1"),
            Parameter::measured(name, a, d, unit),
            Parameter::measured("phase", p, ep, "rad"),
        ]
    })
}
